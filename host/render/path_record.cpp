#include "host/render/path_record.h"

#include <algorithm>
#include <cmath>

#include "host/error.h"
#include "host/render/forward_rays.h"
#include "host/render/start_media.h"
#include "host/spectra/color.h"
#include "host/spectra/wavelengths.h"

namespace etendue {

// Twin of the struct in shaders/kernels/record_paths.comp.
struct DeviceVertex {
    glm::vec3 position;
    uint32_t event;
    uint32_t material, light, medium, primitive, element;
    float arriving, leaving;
    glm::vec3 rgb;
    glm::vec4 throughput;
    glm::vec3 stokes, axis;
};
static_assert(sizeof(DeviceVertex) == 96);

namespace {

// EVENT_… of shaders/interfaces/surface_optics.glsl and RECORDED_… of record_paths.comp.
enum EventBits : uint32_t {
    reflect = 1,
    transmit = 2,
    delta = 4,
    straight = 8,
    emission = 16,
    escape = 32,
    roulette = 64,
    bend = 128,
    enter = 1024,
    leave = 2048
};

constexpr uint32_t most_paths = 4096;  // of a dispatch

PathEvent event_of(const DeviceVertex& v) {
    if (v.event & emission) return PathEvent::emitted;
    if (v.event & escape) return PathEvent::escaped;
    if (v.event & bend) return PathEvent::bent;
    if (v.event & enter) return PathEvent::entered;
    if (v.event & leave) return PathEvent::left;
    if ((v.event & (reflect | transmit | straight)) == 0) return PathEvent::absorbed;
    if (v.event & straight) return PathEvent::straight;
    if (v.material == no_record) return PathEvent::scattered;
    return v.event & transmit ? PathEvent::refracted : PathEvent::reflected;
}

}  // namespace

const char* event_name(PathEvent event) {
    switch (event) {
        case PathEvent::emitted:
            return "emitted";
        case PathEvent::reflected:
            return "reflected";
        case PathEvent::refracted:
            return "refracted";
        case PathEvent::straight:
            return "straight";
        case PathEvent::scattered:
            return "scattered";
        case PathEvent::entered:
            return "entered";
        case PathEvent::left:
            return "left";
        case PathEvent::bent:
            return "bent";
        case PathEvent::absorbed:
            return "absorbed";
        default:
            return "escaped";
    }
}

double wavelength_at(const RecordedPath& path, const PathVertex& vertex) {
    double nm = 0;
    int left = 0;  // lanes
    for (int lane = 0; lane < 4; ++lane)
        if (vertex.throughput[lane] != 0) nm = double(path.wavelengths[lane]), ++left;
    return left == 1 ? nm : 0.0;
}

glm::vec3 line_color(const RecordedPath& path, const PathVertex& vertex) {
    glm::dvec3 rgb = vertex.color;
    if (const double nm = wavelength_at(path, vertex); nm > 0)
        rgb = rgb_weights()[size_t(std::clamp(std::lround(nm) - first_nm, 0L, spectrum_samples - 1L))];
    rgb = glm::max(rgb, glm::dvec3(0));  // of the spectral colours most lie outside of Rec.709
    const double greatest = std::max({rgb.x, rgb.y, rgb.z});
    return greatest > 0 ? glm::vec3(rgb / greatest) : glm::vec3(0);
}

bool PathFilter::keeps(const RecordedPath& path) const {
    const auto is_at = [](const PathVertex& v, const std::set<std::string>& names) {
        return names.count(v.object) > 0 || names.count(v.shape) > 0;
    };
    const auto any = [&](const auto& is_so) {
        return std::any_of(path.vertices.begin(), path.vertices.end(), is_so);
    };
    return any([&](const PathVertex& v) {
               return (events.empty() || events.count(v.event)) && (objects.empty() || is_at(v, objects));
           }) &&
           !any([&](const PathVertex& v) { return is_at(v, without); });
}

PathRecorder::PathRecorder(Device& device, Scene& scene, const RenderSettings& settings, bool forward,
                           uint32_t most_vertices, bool inside)
    : device_(device),
      scene_(scene),
      settings_(settings),
      forward_(forward),
      inside_(inside),
      room_(std::max(2u, most_vertices) * (scene.features.bending ? 4 : 1)),
      paths_(settings.width * settings.height),
      spectra_(device, scene),
      views_(device, scene, {{settings.receiver, settings.width, settings.height}}),
      start_media_(std::make_unique<StartMedia>(device, scene, views_, forward)),
      commands_(device) {
    if (forward && !(scene.power > 0)) fail_input("the scene has no light: there are no forward paths");
    if (forward) paths_ = forward_paths_a_pass(settings);
    batch_ = std::min(paths_, most_paths);
    forward_pass_ = Buffer(device, sizeof(ForwardPass), "ForwardPassTable");
    indices_ = Buffer(device, uint64_t(batch_) * 4, "PathIndices");
    vertices_ = Buffer(device, uint64_t(batch_) * room_ * sizeof(DeviceVertex), "PathVertices");
    counts_ = Buffer(device, uint64_t(batch_) * 4, "PathCounts");
    Techniques techniques;
    techniques.forward = forward;
    BufferTable table = {{"ForwardPassTable", &forward_pass_},
                         {"PathIndices", &indices_},
                         {"PathVertices", &vertices_},
                         {"PathCounts", &counts_},
                         {"StartMedia", &start_media_->buffer()}};
    table.merge(spectra_.buffers());
    table.merge(views_.buffers());
    kernel_ = make_kernel(device, scene, "kernels/record_paths.comp", table,
                          forward ? techniques.forward_defines() : techniques.backward_defines());
    start_media_->find();
}

PathRecorder::~PathRecorder() = default;

// Within elements nothing is shown but what starts there, unless somebody asks.
bool PathRecorder::shows(const DeviceVertex& v) const {
    if (inside_ || v.element == 0 || (v.event & emission)) return true;
    return (v.event & (enter | leave)) && scene_.elements[v.element - 1].parent == 0;
}

PathVertex PathRecorder::vertex_of(const DeviceVertex& v, double unit) const {
    PathVertex vertex;
    vertex.event = event_of(v);
    vertex.smooth = vertex.event != PathEvent::scattered && (v.event & delta);
    vertex.roulette = v.event & roulette;
    vertex.position = glm::dvec3(v.position) + scene_.center;
    if (vertex.event == PathEvent::entered || vertex.event == PathEvent::left) {
        vertex.object = scene_.elements[v.element - 1].name;
    } else if (vertex.event == PathEvent::scattered || vertex.event == PathEvent::bent) {
        const auto medium = scene_.medium_names.find(v.medium);
        if (medium != scene_.medium_names.end()) vertex.object = medium->second;
    } else if (v.material < scene_.material_names.size()) {
        vertex.object = scene_.material_names[v.material];
        if (v.primitive < scene_.placed->size())
            vertex.shape = scene_.placed_names[scene_.placed->at(v.primitive)];
    } else if (v.light < scene_.light_names.size()) {
        vertex.object = scene_.light_names[v.light];
        vertex.shape = scene_.light_shapes[v.light];
    }
    vertex.arriving = unit * v.arriving, vertex.leaving = unit * v.leaving;
    vertex.throughput = v.throughput;
    vertex.color = float(unit) * v.rgb;
    if (scene_.features.polarization && vertex.leaving > 0)
        vertex.polarization = PathPolarization{v.stokes, v.axis};
    return vertex;
}

std::vector<RecordedPath> PathRecorder::record(uint64_t pass, std::span<const uint32_t> indices) {
    double unit = 1;
    if (forward_) {
        const ForwardPass values = describe_pass(scene_, settings_, pass, paths_, settings_.seed);
        forward_pass_.write(&values, sizeof values);
        unit = values.path_flux;
    } else {
        start_media_->find_of_receivers();
    }
    spectra_.write(pass, 1, settings_.seed);
    const glm::vec4 nm =
        scene_.features.spectral ? choose_wavelengths(pass, settings_.seed).nm : glm::vec4(0);
    std::vector<RecordedPath> paths;
    for (size_t first = 0; first < indices.size(); first += batch_) {
        const uint32_t count = uint32_t(std::min<size_t>(batch_, indices.size() - first));
        for (const uint32_t i : indices.subspan(first, count))
            if (i >= paths_) fail_input("path {}: a pass has {} of them", i, paths_);
        indices_.write(&indices[first], uint64_t(count) * 4);
        commands_.dispatch(
            kernel_, (count + kernel_.group_size() - 1) / kernel_.group_size(),
            {{"count", count}, {"room", room_}, {"pass", uint32_t(pass)}, {"seed", settings_.seed}});
        commands_.run();
        const auto counts = counts_.read_array<uint32_t>(count);
        for (uint32_t i = 0; i < count; ++i) {
            RecordedPath path{forward_, pass, indices[first + i], nm, {}, false};
            for (const DeviceVertex& v : vertices_.read_array<DeviceVertex>(counts[i], uint64_t(i) * room_))
                if (shows(v)) path.vertices.push_back(vertex_of(v, unit));
            const PathVertex& last = path.vertices.back();
            path.is_cut = !last.roulette && last.event != PathEvent::escaped &&
                          last.event != PathEvent::absorbed && last.leaving > 0;
            paths.push_back(std::move(path));
        }
    }
    return paths;
}

}  // namespace etendue
