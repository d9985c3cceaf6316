// What a window asks of the renderer and is told by it.
#pragma once
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "host/preview/camera_control.h"
#include "host/render/renderer.h"
#include "host/scene/live_scene.h"

namespace etendue {

// What of the film is shown.
enum class Layer { radiance, error, albedo, normal, depth, linear, angle, circular };
constexpr int layer_count = 8;
const char* layer_name(Layer layer);

struct PreviewRequest {
    uint32_t width = 0, height = 0;       // of the window, pixels; none = nothing to do
    uint32_t receiver = 0;                // index into PreviewStatus::receivers
    std::optional<glm::dmat4> placement;  // none = as the scene has it
    bool moving = false;                  // quick pictures are better than fine ones
    bool paused = false;
    bool wants_errors = false, wants_depth = false;
    Algorithm algorithm = Algorithm::automatic;
    uint32_t seed = 0;
    Layer layer = Layer::radiance;

    bool operator==(const PreviewRequest&) const = default;
    // Whether a film of one may go on for the other.
    bool shows_the_same(const PreviewRequest& other) const;
    // Whether a pass for it is to be broken off once `next` is asked for. Of a view that moves pictures are
    // coarse enough to come quickly; broken off at every step of the mouse none would ever come.
    bool is_overtaken_by(const PreviewRequest& next) const;
};

struct PreviewPicture {
    uint32_t width = 0, height = 0;
    uint32_t step = 1;                // pixels of the window for each of its own, along both sides
    std::vector<glm::vec3> radiance;  // rows from the top
    Layer layer = Layer::radiance;
    std::vector<glm::vec3> shown;   // of another layer: relative error, or colours to show as they are
    std::vector<glm::vec4> stokes;  // S0 to S3, luminances; empty where no receiver asks for them
    std::vector<glm::vec3> errors;  // of the radiance, in its unit; empty until they were asked for
    std::vector<float> depth;       // m along the ray, 0 = nothing is there; empty until it was asked for
    uint64_t passes = 0;
    Algorithm algorithm = Algorithm::backward;  // that made it
    PreviewRequest request;                     // that it answers
};

struct PreviewReceiver {
    std::string name, class_name;
    std::string unit;  // of a meter's pixels; empty: a camera
    float aspect_ratio = 0;
    glm::dmat4 placement{1.0};  // as the scene has it
    CameraLens lens;
};

// Where the renderer stands.
struct PreviewStatus {
    uint64_t scene = 0;  // counts the scenes that were loaded; 0 = none yet
    std::vector<PreviewReceiver> receivers;
    uint32_t first_receiver = 0;  // to begin with
    glm::dvec3 scene_center{0};
    float scene_radius = 0;
    uint64_t triangles = 0, shapes = 0, instances = 0, lights = 0, materials = 0;
    std::vector<KernelReport> kernels;
    std::vector<std::string> variants;                       // of its materials
    ImportOptions import;                                    // the variant and the moment at hand
    double animation_seconds = 0;                            // how long its animations last; 0 = it has none
    std::shared_ptr<const std::vector<LiveObject>> objects;  // null = none yet
    std::map<Interface, std::vector<std::string>> class_names;
    std::vector<std::string> placed_names;  // of shapes and nodes, in order, the first thousand

    std::string device, message;  // message: an error, or what takes long; empty = none
    bool is_error = false;
    std::string question;  // whether the scene's class files may run: waits for PreviewSession::answer
    uint64_t passes = 0;
    uint32_t step = 1;
    bool at_rest = false;  // all passes that were asked for are done
    AlgorithmChoice choice;
    Schedule schedule = Schedule::automatic;
    double rays_per_second = 0, seconds = 0;  // of rendering
    std::optional<RelativeError> error;
    KernelTimings timings;
    uint64_t device_bytes = 0;
    uint32_t devices_lost = 0;  // and replaced
};

// What a task works on, between two slices of work.
struct PreviewScene {
    Device& device;
    LiveScene& live;
    Scene& scene;
    Renderer& renderer;
    const PreviewRequest& request;
    uint32_t receiver;            // RecordRef
    uint32_t step;                // of the film at hand
    std::shared_ptr<Scene> next;  // what a task's edit has made: the film begins anew with it
};

}  // namespace etendue
