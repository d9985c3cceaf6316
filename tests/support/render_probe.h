// Whole scenes, written in code or read from the reference folder, rendered as the library renders them and
// compared with what they must show.
#pragma once
#include <functional>
#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <optional>

#include "host/image/image.h"
#include "host/render/renderer.h"
#include "tests/support/device_fixture.h"

namespace etendue {

// Where a node stands. Objects in the xy plane face +z; cameras look along -z.
struct Place {
    glm::dvec3 position{0};
    nlohmann::json rotation = {0, 0, 0, 1};  // quaternion x, y, z, w
};
inline Place at(double x, double y, double z) { return {{x, y, z}}; }
Place facing_down(double x, double y, double z);
Place facing_x(double x, double y, double z);  // +z becomes +x, y stays

// A glTF document that grows object by object. All nodes hang on one root node, which may be moved and
// scaled.
class SceneBuilder {
  public:
    nlohmann::json document;
    SceneBuilder();
    // `optics`: the material's ETD_optics; `more`: other members of the glTF material. Returns its index.
    int material(nlohmann::json optics, nlohmann::json more = nlohmann::json::object());
    int lambertian(nlohmann::json reflectance) {
        return surface({{"class", "lambertian"}, {"reflectance", reflectance}});
    }
    int surface(nlohmann::json surface) { return material({{"surface", std::move(surface)}}); }
    int black_emitter(nlohmann::json radiance);  // reflects nothing
    void shape(nlohmann::json geometry, int material, const Place& place);
    void sphere(double radius, int material, const Place& place);
    void rectangle(double width, double height, int material, const Place& place);
    void light(nlohmann::json punctual, const Place& place);  // of KHR_lights_punctual
    // `kind`: light, receiver, …: a member of the node's ETD_optics.
    void placed(const std::string& kind, nlohmann::json object, const Place& place);
    void mesh(const std::vector<glm::vec3>& positions, const std::vector<uint32_t>& indices, int material,
              const Place& place, const std::vector<glm::vec3>& normals = {},
              const std::vector<glm::vec2>& uvs = {});
    void mesh_copy(const Place& place);  // of the mesh that was added last
    void orthographic(double ymag, const Place& place, const std::string& name = "camera");
    void perspective(double yfov, const Place& place, const std::string& name = "camera");
    // What `fill` adds stands in another scene of the file, whose index is returned: for optical elements.
    int scene(const std::function<void()>& fill);
    void environment(nlohmann::json radiance);
    void medium(const std::string& name, nlohmann::json parameters);
    void transform(const glm::dvec3& translation, double scale);
    void scale_last(const glm::dvec3& scale);  // the node that was added last, along its own axes
    nlohmann::json& optics();                  // ETD_optics of the root
    SceneDescription import(const std::filesystem::path& file = "scene.gltf") const;

  private:
    nlohmann::json& node(nlohmann::json node, const Place& place);
    int accessor(const void* data, size_t size, int component_type, size_t count, const char* type);
};

// Eight corners and twelve triangles of a box around the origin, normals outward or inward.
void add_box(SceneBuilder& scene, const glm::vec3& size, int material, bool inward, const Place& place);

struct RenderPlan {
    uint32_t width = 64, height = 64, passes = 64, seeds = 8;
    std::string receiver = "";  // name; empty = the first
    Schedule schedule = Schedule::automatic;
    uint32_t first_seed = 1;
    Algorithm algorithm = Algorithm::backward;
    bool connect = true;                  // as in RenderSettings
    double forward_paths = 1;             // a pixel and pass
    float merge_radius = 1;               // as in RenderSettings
    uint64_t vertex_bytes = 0;            // 0 = as in RenderSettings
    bool stokes = false;                  // images of S0 to S3, one below the other
    std::vector<LightLayer> layers = {};  // images of all light and of these, one below the other
};

// Means and their standard errors from images of independent seeds. Three values a pixel: R, G, B.
struct Estimates {
    uint32_t width = 0, height = 0, seeds = 0;  // height: of all images of a Stokes vector together
    std::vector<std::vector<float>> images;     // one a seed
    std::vector<double> mean;
    RenderCounters counters;  // of all seeds
    double at(uint32_t x, uint32_t y, int channel) const {
        return mean[3 * (size_t(y) * width + x) + channel];
    }
};

SceneOptions test_options();  // with the shaders of the source tree; compiled ones go to the cache
Scene compile_test_scene(const SceneDescription& description, const SceneOptions& options = test_options());
Estimates render_estimates(Scene& scene, const RenderPlan& plan);
Estimates render_estimates(const SceneDescription& description, const RenderPlan& plan);

// The film of one seed, bit by bit.
FilmState render_film(Scene& scene, const RenderPlan& plan, Schedule schedule,
                      const std::vector<uint32_t>& batches);

// Pixels that a comparison looks at; all by default.
struct Window {
    uint32_t x = 0, y = 0, width = UINT32_MAX, height = UINT32_MAX;
};

// How the estimates differ from what is expected, by tiles of tile * tile pixels (1: single pixels) in units
// of their standard error. `expected_sd`: noise of the expected values themselves, empty = none; it is
// independent between pixels.
struct Agreement {
    size_t tests = 0;
    double least_p = 1, p_limit = 0, rms_z = 0, worst_z = 0;
    uint32_t x = 0, y = 0;  // of the least probable value
    bool holds = true;      // least_p >= p_limit: a false alarm in 1000 runs (Šidák)
};
Agreement agreement(const Estimates& estimates, const std::vector<double>& expected, uint32_t tile,
                    const std::vector<double>& expected_sd = {}, const Window& window = {});
// The same of two estimates with as many independent seeds each, neither of which is without noise.
Agreement agreement(const Estimates& a, const Estimates& b, uint32_t tile, const Window& window = {});
std::string describe(const Agreement& agreement);

struct WindowMean {
    double mean = 0, standard_error = 0;
};
WindowMean window_mean(const Estimates& estimates, const Window& window = {},
                       int channel = -1);  // -1: all three
double window_mean(const std::vector<double>& values, uint32_t width, const Window& window, int channel = -1);

// A file of the reference scenes. Nothing where it is missing, which fails the test unless the environment
// says ETENDUE_ALLOW_MISSING_SHARED.
std::optional<std::filesystem::path> shared_file(const std::string& name);

}  // namespace etendue
