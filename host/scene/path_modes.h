// What the paths of a scene carry, and where their random numbers come from: chosen before anything is
// compiled.
#pragma once

namespace etendue {

// What paths carry.
enum class ColorMode {
    automatic,  // wavelengths where the scene has a spectrum
    rgb,        // three channels
    spectral,   // four wavelengths a pass
};

// Whether they carry Stokes vectors, too.
enum class PolarizationMode {
    automatic,  // where the scene has something that polarizes light on purpose
    on,
    off,
};

// Where the random numbers of paths come from.
enum class SampleSequence {
    sobol,        // Sobol' points, Owen-scrambled: the error falls faster than with independent numbers
    independent,  // hashes
};

}  // namespace etendue
