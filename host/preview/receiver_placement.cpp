#include "host/preview/receiver_placement.h"

#include <cmath>
#include <numbers>

namespace etendue {
namespace {

bool is_parallel(const Receiver& receiver) { return receiver.info->name == "orthographic"; }
double ymag_of(const Receiver& receiver) { return receiver.parameters.value("ymag", 1.0); }
double yfov_of(const Receiver& receiver) { return receiver.parameters.value("yfov", std::numbers::pi / 4); }

}  // namespace

CameraLens lens_of(const Receiver& receiver) {
    if (is_parallel(receiver)) return {true, 2 * ymag_of(receiver)};
    return {false, 2 * std::tan(yfov_of(receiver) / 2)};
}

nlohmann::json camera_as_gltf(const Receiver& receiver, double aspect_ratio) {
    // A camera's node has no scale in glTF; what it does to parallel rays goes into their height.
    glm::dmat4 placement = receiver.world_from_local;
    const double scale = glm::length(placement[1]);
    for (int c = 0; c < 3; ++c) placement[c] = glm::normalize(placement[c]);
    nlohmann::json camera;
    if (is_parallel(receiver)) {
        const double ymag = scale * ymag_of(receiver);
        camera = {
            {"type", "orthographic"},
            {"orthographic", {{"xmag", ymag * aspect_ratio}, {"ymag", ymag}, {"znear", 0.0}, {"zfar", 1e6}}}};
    } else {
        camera = {
            {"type", "perspective"},
            {"perspective", {{"aspectRatio", aspect_ratio}, {"yfov", yfov_of(receiver)}, {"znear", 0.01}}}};
    }
    nlohmann::json matrix = nlohmann::json::array();
    for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r) matrix.push_back(placement[c][r]);
    return {{"cameras", {camera}}, {"nodes", {{{"name", receiver.name}, {"camera", 0}, {"matrix", matrix}}}}};
}

}  // namespace etendue
