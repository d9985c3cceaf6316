#include "host/render/forward_rays.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace etendue {
namespace {

constexpr double short_edge_pixels = 32.0;  // so much shorter than the image that longer edges connect well
constexpr uint32_t vertices_a_path = 16;    // for which room is kept, if there is as much
// At least: of the longest path. Between surfaces Russian roulette lets one live for 1024 with probability
// 1e-21; in media that scatter and hardly absorb only MAX_DEPTH of shaders/lib/path.glsl ends them.
constexpr uint64_t least_vertices = 1024, least_vertices_in_media = 65536;

}  // namespace

double merge_radius_factor(uint64_t pass) {
    constexpr double alpha = 2.0 / 3.0;
    const double i = double(pass) + 1;
    return std::exp(0.5 * (std::lgamma(i + alpha) - std::lgamma(1 + alpha) - std::lgamma(i + 1)));
}

uint32_t forward_paths_a_pass(const RenderSettings& settings) {
    return uint32_t(
        std::clamp(settings.forward_paths * double(pixel_count(all_views(settings))), 1.0, double(1 << 24)));
}

ForwardPass describe_pass(const Scene& scene, const RenderSettings& settings, uint64_t pass, uint32_t count,
                          uint32_t seed) {
    ForwardPass values{};
    values.pass = uint32_t(pass);
    values.seed = seed + count * 0x9E3779B9u;  // other counts take other sequences
    values.count = count;
    values.merge_scale = float(settings.merge_radius * merge_radius_factor(pass));
    values.short_scale = float(short_edge_pixels);
    values.path_flux = float(scene.power / count);
    values.inverse_power = float(1 / scene.power);
    values.splat_unit = float(scene.power / (4 * std::pow(std::numbers::pi * scene.radius, 2)));
    return values;
}

ForwardRays::ForwardRays(Device& device, Scene& scene, const RenderSettings& settings,
                         const Techniques& techniques, const BufferTable& film)
    : scene_(scene),
      settings_(settings),
      techniques_(techniques),
      all_(forward_paths_a_pass(settings)),
      count_(all_),
      pass_(device, sizeof(ForwardPass), "ForwardPassTable"),
      splats_(device, splat_bytes(), "Splats") {
    splats_.fill(0);
    if (techniques.ray_record) ray_record_.emplace(device, scene, all_views(settings), count_);
    if (techniques.connect || techniques.merge) {
        const VertexMap::Shaders shaders = {
            [&](const std::string& file, const BufferTable& table) {
                return make_kernel(device, scene, file, table, techniques.layer_defines);
            },
            [&](const std::string& file, const std::string& buffer) {
                return element_bytes(device, scene, file, techniques.layer_defines, buffer);
            }};
        const uint64_t least = scene.features.scattering ? least_vertices_in_media : least_vertices;
        const uint64_t most = std::max(least, uint64_t(count_) * vertices_a_path);
        const uint64_t room = settings.vertex_bytes / VertexMap::bytes_a_vertex(shaders);
        vertices_.emplace(device, uint32_t(std::clamp<uint64_t>(room, least, most)), shaders);
        path_ends_ = Buffer(device, uint64_t(count_) * 8, "PathEnds");
    }
    BufferTable table = buffers();
    table.insert(film.begin(), film.end());
    if (settings.schedule != Schedule::fused) {
        wavefront_.emplace(device, scene, Wavefront::Direction::forward, techniques,
                           std::min(count_, Wavefront::wanted_paths(device)),
                           settings.schedule == Schedule::by_class, table);
        return;
    }
    trace_forward_paths_ =
        make_kernel(device, scene, "kernels/trace_forward_paths.comp", table, techniques.forward_defines());
    const bool refills =
        device.description.type == "CPU" && device.description.max_loop_turns == 0;  // as backward paths
    const uint32_t a_group = trace_forward_paths_.group_size() * (refills ? 8 : 1);
    groups_ = std::clamp((count_ + a_group - 1) / a_group, 1u, max_groups);
}

uint64_t ForwardRays::splat_bytes() const {
    return pixel_count(all_views(settings_)) * (scene_.features.spectral ? 48 : 36) *
           (settings_.stokes ? 4 : std::max<uint64_t>(1, techniques_.light_layers));
}

BufferTable ForwardRays::buffers() const {
    BufferTable table = {{"ForwardPassTable", &pass_}, {"Splats", &splats_}};
    if (vertices_) table.merge(vertices_->buffers());
    if (ray_record_) table.merge(ray_record_->buffers());
    table["PathEnds"] = &path_ends_;
    return table;
}

void ForwardRays::trace(CommandList& commands, uint64_t pass, uint32_t seed, KernelTimings& timings) {
    count_ = fitting_.value_or(all_);
    trace_fitting(commands, pass, seed, timings);
    if (ray_record_) ray_record_->end_pass(pass, seed);
    if (pass == 0) fitting_ = count_;
    if (vertices_ && techniques_.merge && expected_vertices_ > 0)
        vertices_->build(commands, expected_vertices_);
}

bool ForwardRays::find_fitting(CommandList& commands, uint64_t first, SpectralPasses& spectra, uint32_t seed,
                               KernelTimings& timings) {
    if (first == 0 || fitting_ || !vertices_) return false;
    spectra.write(0, 1, seed);
    count_ = all_;
    trace_fitting(commands, 0, seed, timings);
    fitting_ = count_;
    splats_.fill(0, splat_bytes());
    paths_ = splits_ = 0;
    return true;
}

void ForwardRays::trace_fitting(CommandList& commands, uint64_t pass, uint32_t seed, KernelTimings& timings) {
    while (true) {
        const ForwardPass values = describe_pass(scene_, settings_, pass, count_, seed);
        pass_.write(&values, sizeof values);
        if (vertices_) vertices_->clear(commands);
        if (ray_record_) ray_record_->begin_pass();
        trace_paths(commands, timings);
        paths_ += count_;
        if (ray_record_ && !ray_record_->fits()) {
            splats_.fill(0, splat_bytes());
            continue;
        }
        if (!vertices_) return;
        const VertexMap::Counts counts = vertices_->counts();
        expected_vertices_ = counts.stored;
        if (counts.wanted == counts.stored || count_ == 1) return;
        count_ = std::max(1u, uint32_t(0.9 * count_ * counts.stored / counts.wanted));
        splats_.fill(0, splat_bytes());
        splits_++;
    }
}

void ForwardRays::trace_paths(CommandList& commands, KernelTimings& timings) {
    if (wavefront_) {
        for (uint32_t first = 0; first < count_; first += wavefront_->slots())
            wavefront_->trace(commands, std::min(wavefront_->slots(), count_ - first),
                              {{"first_path", first}}, timings);
        return;
    }
    commands.dispatch(trace_forward_paths_, groups_);
    commands.run(&timings);
}

void ForwardRays::restart(const RenderSettings& settings) {
    settings_ = settings;
    all_ = forward_paths_a_pass(settings_);
    fitting_.reset();
    splats_.fill(0, splat_bytes());
}

CrossingSample ForwardRays::take_crossings(size_t view) {
    return ray_record_ ? ray_record_->take(view) : CrossingSample{};
}

void ForwardRays::warm_up(CommandList& commands) {
    const ForwardPass nothing{};
    pass_.write(&nothing, sizeof nothing);
    if (vertices_) vertices_->clear(commands);
    if (wavefront_)
        wavefront_->warm_up(commands);
    else
        commands.dispatch(trace_forward_paths_, 1);
    if (vertices_) vertices_->build(commands, 1);
    commands.run();
}

}  // namespace etendue
