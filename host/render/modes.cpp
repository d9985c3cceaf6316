#include "host/render/modes.h"

namespace etendue {

const char* algorithm_name(Algorithm algorithm) {
    switch (algorithm) {
        case Algorithm::backward:
            return "backward";
        case Algorithm::forward:
            return "forward";
        case Algorithm::bidirectional:
            return "bidirectional";
        default:
            return "auto";
    }
}

const char* schedule_name(Schedule schedule) {
    switch (schedule) {
        case Schedule::fused:
            return "fused";
        case Schedule::wavefront:
            return "wavefront";
        case Schedule::by_class:
            return "by-class";
        default:
            return "automatic";
    }
}

}  // namespace etendue
