// How a render can be done: what the command line and the renderer both name.
#pragma once

namespace etendue {

// Which paths carry the light.
enum class Algorithm {
    automatic,      // by the scene
    backward,       // paths from the receiver: path tracing with light sampling (Kajiya 1986)
    forward,        // paths from the lights, each vertex connected to the receiver: light tracing
    bidirectional,  // both, connected in all ways
};
const char* algorithm_name(Algorithm algorithm);

// How a pass is divided into kernels; the image does not depend on it.
enum class Schedule {
    automatic,  // by the scene
    fused,      // whole paths in one kernel
    wavefront,  // a kernel a stage, paths in memory between them
    by_class,   // the same, with a queue and a scattering kernel for each class of surfaces
};
const char* schedule_name(Schedule schedule);

}  // namespace etendue
