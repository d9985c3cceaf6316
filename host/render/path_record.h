// Paths of light to be looked at: where they go, what befalls them, what they carry. They are traced by the
// stages and the random numbers of the renderer.
#pragma once
#include <array>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "host/render/renderer.h"

namespace etendue {

enum class PathEvent {
    emitted,    // at a light, or at the receiver
    reflected,  // at a surface
    refracted,  // through a surface, bent or scattered
    straight,   // through a surface as if it were not there
    scattered,  // in a medium
    entered,    // an optical element
    left,       // … again
    bent,       // a point of the way through a medium that bends rays, at every 0.05 rad
    absorbed,   // the path ends; it carries nothing on
    escaped,    // the path leaves the scene: a point at the scene's radius from where it did so
};
const char* event_name(PathEvent event);

// S1 to S3 over S0, the mean of the wavelengths as the eye weighs them: of the light that a forward path
// carries, of the row of an intensity that a backward path is (shaders/features/polarization.glsl).
struct PathPolarization {
    glm::vec3 stokes{0}, axis{1, 0, 0};  // axis: x of their frame, z being the way the light travels
};

struct PathVertex {
    PathEvent event = PathEvent::emitted;
    bool smooth = false;     // reflected or refracted in one direction only
    bool roulette = false;   // Russian roulette or the depth limit ended the path here
    glm::dvec3 position{0};  // m, in the coordinates of the scene file
    std::string object;  // name of the material, of the medium where it scattered, of the light it came from,
                         // of the element
    std::string shape;  // name of the shape or of the mesh's node; empty where there is none
    // What the path carries when it arrives and when it goes on. Forward: lm. Backward: the share of a
    // radiance along the ray that reaches the pixel.
    double arriving = 0, leaving = 0;
    glm::vec4 throughput{
        0};  // … when it goes on, of each wavelength, or of linear R, G, B; in units of its own
    std::optional<PathPolarization> polarization;  // … where paths carry any
    glm::vec3 color{0};                            // … as linear Rec.709 of the same sum as `leaving`
};

struct RecordedPath {
    bool forward = false;
    uint64_t pass = 0;
    uint32_t index = 0;                // of the pixel, row by row, or of the forward path
    glm::vec4 wavelengths{0};          // nm; 0 in colours. Where they have parted only the first is left.
    std::vector<PathVertex> vertices;  // the first one was emitted
    bool is_cut = false;               // there were more than there is room for
};

// nm, of the only wavelength that is left at the vertex; 0 where there are several, or colours.
double wavelength_at(const RecordedPath& path, const PathVertex& vertex);
// For a line behind the vertex: linear Rec.709 within [0, 1], the greatest channel 1: that of the wavelength
// that is left, by the CIE observer, else of what the path carries. Black where it carries nothing.
glm::vec3 line_color(const RecordedPath& path, const PathVertex& vertex);

// Keeps paths that have a vertex of one of the events at one of the objects, empty = any, and none at those
// that they are to be without. Objects are materials, media, lights, shapes and nodes, by name.
struct PathFilter {
    std::set<PathEvent> events;
    std::set<std::string> objects, without;
    bool keeps(const RecordedPath& path) const;
};

class StartMedia;
struct DeviceVertex;

class PathRecorder {
  public:
    // Of the image that the settings describe: its receiver, size and seed; with forward paths as many a
    // pixel as they say. Compiles a kernel unless the device has it. `most_vertices`: of a path, at least 2;
    // where rays are bent, so many times 4. `inside`: also what happens within optical elements.
    PathRecorder(Device& device, Scene& scene, const RenderSettings& settings, bool forward,
                 uint32_t most_vertices = 64, bool inside = false);
    ~PathRecorder();

    uint32_t paths_a_pass() const { return paths_; }  // pixels, or forward paths
    // Those paths of a pass, by their indices, all less than paths_a_pass(). Receivers are where they are
    // now.
    std::vector<RecordedPath> record(uint64_t pass, std::span<const uint32_t> indices);

  private:
    bool shows(const DeviceVertex& v) const;
    PathVertex vertex_of(const DeviceVertex& v, double unit) const;
    Device& device_;
    Scene& scene_;
    RenderSettings settings_;
    bool forward_, inside_;
    uint32_t room_, paths_, batch_;
    SpectralPasses spectra_;
    Views views_;
    std::unique_ptr<StartMedia> start_media_;
    Buffer forward_pass_, indices_, vertices_, counts_;
    Kernel kernel_;
    CommandList commands_;
};

}  // namespace etendue
