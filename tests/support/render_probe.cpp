#include "tests/support/render_probe.h"

#include <utility>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "host/gpu/shader_compiler.h"
#include "host/image/compare.h"
#include "host/gltf/gltf.h"
#include "tests/support/source_path.h"
#include "tests/support/statistics.h"

namespace etendue {
namespace {

using nlohmann::json;
constexpr double half_turn = 0.70710678118654752;

std::string base64(const uint8_t* bytes, size_t size) {
    const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (size_t i = 0; i < size; i += 3) {
        uint32_t word = uint32_t(bytes[i]) << 16;
        if (i + 1 < size) word |= uint32_t(bytes[i + 1]) << 8;
        if (i + 2 < size) word |= bytes[i + 2];
        for (int k = 0; k < 4; ++k) text += i + size_t(k) > size ? '=' : digits[word >> (18 - 6 * k) & 63];
    }
    return text;
}

struct Clipped {
    uint32_t x0, y0, x1, y1;
};
Clipped clipped(const Window& w, uint32_t width, uint32_t height) {
    return {w.x, w.y, std::min<uint32_t>(width, w.width == UINT32_MAX ? width : w.x + w.width),
            std::min<uint32_t>(height, w.height == UINT32_MAX ? height : w.y + w.height)};
}

}  // namespace

Place facing_down(double x, double y, double z) { return {{x, y, z}, {1, 0, 0, 0}}; }
Place facing_x(double x, double y, double z) { return {{x, y, z}, {0, half_turn, 0, half_turn}}; }

SceneBuilder::SceneBuilder() {
    document = {{"asset", {{"version", "2.0"}}},
                {"extensionsUsed", {"ETD_optics", "KHR_lights_punctual"}},
                {"scene", 0},
                {"scenes", {{{"nodes", {0}}}}},
                {"nodes", {{{"name", "root"}, {"children", json::array()}}}}};
}

json& SceneBuilder::optics() { return document["extensions"]["ETD_optics"]; }

json& SceneBuilder::node(json node, const Place& place) {
    node["translation"] = {place.position.x, place.position.y, place.position.z};
    node["rotation"] = place.rotation;
    document["nodes"].push_back(std::move(node));
    document["nodes"][0]["children"].push_back(document["nodes"].size() - 1);
    return document["nodes"].back();
}

int SceneBuilder::material(json optics, json more) {
    more["extensions"]["ETD_optics"] = std::move(optics);
    document["materials"].push_back(std::move(more));
    return int(document["materials"].size()) - 1;
}

int SceneBuilder::black_emitter(json radiance) {
    return material(
        {{"surface", {{"class", "absorber"}}}, {"emission", {{"radiance", std::move(radiance)}}}});
}

void SceneBuilder::shape(json geometry, int material, const Place& place) {
    geometry["material"] = material;
    placed("geometry", std::move(geometry), place);
}

void SceneBuilder::placed(const std::string& kind, json object, const Place& place) {
    node({{"extensions", {{"ETD_optics", {{kind, std::move(object)}}}}}}, place);
}

void SceneBuilder::sphere(double radius, int material, const Place& place) {
    shape({{"class", "sphere"}, {"radius", radius}}, material, place);
}

void SceneBuilder::rectangle(double width, double height, int material, const Place& place) {
    shape({{"class", "rectangle"}, {"size", {width, height}}}, material, place);
}

void SceneBuilder::light(json punctual, const Place& place) {
    json& lights = document["extensions"]["KHR_lights_punctual"]["lights"];
    lights.push_back(std::move(punctual));
    node({{"extensions", {{"KHR_lights_punctual", {{"light", lights.size() - 1}}}}}}, place);
}

int SceneBuilder::accessor(const void* data, size_t size, int component_type, size_t count,
                           const char* type) {
    json& buffers = document["buffers"];
    buffers.push_back(
        {{"byteLength", size},
         {"uri", "data:application/octet-stream;base64," + base64(static_cast<const uint8_t*>(data), size)}});
    document["bufferViews"].push_back({{"buffer", buffers.size() - 1}, {"byteLength", size}});
    document["accessors"].push_back({{"bufferView", document["bufferViews"].size() - 1},
                                     {"componentType", component_type},
                                     {"count", count},
                                     {"type", type}});
    return int(document["accessors"].size()) - 1;
}

void SceneBuilder::mesh(const std::vector<glm::vec3>& positions, const std::vector<uint32_t>& indices,
                        int material, const Place& place, const std::vector<glm::vec3>& normals,
                        const std::vector<glm::vec2>& uvs) {
    glm::vec3 lo(INFINITY), hi(-INFINITY);
    for (const glm::vec3& p : positions) lo = glm::min(lo, p), hi = glm::max(hi, p);
    const int position = accessor(positions.data(), positions.size() * 12, 5126, positions.size(), "VEC3");
    document["accessors"].back()["min"] = {lo.x, lo.y, lo.z};
    document["accessors"].back()["max"] = {hi.x, hi.y, hi.z};
    const int index = accessor(indices.data(), indices.size() * 4, 5125, indices.size(), "SCALAR");
    json attributes = {{"POSITION", position}};
    if (!normals.empty())
        attributes["NORMAL"] = accessor(normals.data(), normals.size() * 12, 5126, normals.size(), "VEC3");
    if (!uvs.empty())
        attributes["TEXCOORD_0"] = accessor(uvs.data(), uvs.size() * 8, 5126, uvs.size(), "VEC2");
    document["meshes"].push_back(
        {{"primitives", {{{"attributes", attributes}, {"indices", index}, {"material", material}}}}});
    mesh_copy(place);
}

void SceneBuilder::mesh_copy(const Place& place) { node({{"mesh", document["meshes"].size() - 1}}, place); }

void SceneBuilder::orthographic(double ymag, const Place& place, const std::string& name) {
    document["cameras"].push_back(
        {{"type", "orthographic"},
         {"orthographic", {{"xmag", ymag}, {"ymag", ymag}, {"znear", 0.0}, {"zfar", 100.0}}}});
    node({{"camera", document["cameras"].size() - 1}, {"name", name}}, place);
}

void SceneBuilder::perspective(double yfov, const Place& place, const std::string& name) {
    document["cameras"].push_back(
        {{"type", "perspective"}, {"perspective", {{"yfov", yfov}, {"znear", 0.001}}}});
    node({{"camera", document["cameras"].size() - 1}, {"name", name}}, place);
}

void SceneBuilder::environment(json radiance) {
    optics()["environment"] = {{"class", "constant"}, {"radiance", std::move(radiance)}};
}

void SceneBuilder::medium(const std::string& name, json parameters) {
    parameters["name"] = name;
    if (!parameters.contains("class")) parameters["class"] = "homogeneous";
    optics()["media"].push_back(std::move(parameters));
}

void SceneBuilder::transform(const glm::dvec3& translation, double scale) {
    document["nodes"][0]["translation"] = {translation.x, translation.y, translation.z};
    document["nodes"][0]["scale"] = {scale, scale, scale};
}

void SceneBuilder::scale_last(const glm::dvec3& scale) {
    document["nodes"].back()["scale"] = {scale.x, scale.y, scale.z};
}

int SceneBuilder::scene(const std::function<void()>& fill) {
    json outer = std::exchange(document["nodes"][0]["children"], json::array());
    fill();
    json inner = std::exchange(document["nodes"][0]["children"], std::move(outer));
    document["scenes"].push_back({{"nodes", std::move(inner)}});
    return int(document["scenes"].size()) - 1;
}

SceneDescription SceneBuilder::import(const std::filesystem::path& file) const {
    const std::string text = document.dump();
    return import_gltf(std::span(reinterpret_cast<const uint8_t*>(text.data()), text.size()), file);
}

void add_box(SceneBuilder& scene, const glm::vec3& size, int material, bool inward, const Place& place) {
    std::vector<glm::vec3> corners;
    for (int i = 0; i < 8; ++i)
        corners.push_back(size * (glm::vec3(float(i & 1), float(i >> 1 & 1), float(i >> 2)) - 0.5f));
    const uint32_t quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                  {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    std::vector<uint32_t> indices;
    for (const auto& q : quads)
        for (const int k : {0, 1, 2, 0, 2, 3}) indices.push_back(q[inward ? 3 - k : k]);
    scene.mesh(corners, indices, material, place);
}

SceneOptions test_options() {
    SceneOptions options;
    options.shaders = source_path("shaders");
    options.cache_folder = default_cache_folder();
    options.allow_class_files = true;
    return options;
}

Scene compile_test_scene(const SceneDescription& description, const SceneOptions& options) {
    return compile_scene(test_device(), description, options);
}

namespace {

RenderSettings settings_of(const Scene& scene, const RenderPlan& plan) {
    RenderSettings settings;
    settings.width = plan.width, settings.height = plan.height;
    settings.schedule = plan.schedule;
    settings.seed = plan.first_seed;
    settings.algorithm = plan.algorithm;
    settings.connect = plan.connect;
    settings.forward_paths = plan.forward_paths;
    settings.merge_radius = plan.merge_radius;
    if (plan.vertex_bytes) settings.vertex_bytes = plan.vertex_bytes;
    settings.stokes = plan.stokes;
    settings.layers = plan.layers;
    for (const Receiver& receiver : scene.receivers)
        if (settings.receiver == no_record && (plan.receiver.empty() || receiver.name == plan.receiver))
            settings.receiver = receiver.ref;
    REQUIRE_MESSAGE(settings.receiver != no_record, "no receiver ", plan.receiver);
    return settings;
}

// By way of their list of names and values.
void add_counters(RenderCounters& sum, const RenderCounters& counters) {
    json total = to_json(sum);
    const json added = to_json(counters);
    for (const auto& [name, value] : added.items()) {
        if (value.is_object()) continue;
        if (value.is_number_float())
            total[name] = total[name].get<double>() + value.get<double>();
        else
            total[name] = total[name].get<uint64_t>() + value.get<uint64_t>();
    }
    sum = counters_from_json(total);
}

}  // namespace

Estimates render_estimates(Scene& scene, const RenderPlan& plan) {
    Renderer renderer(test_device(), scene, settings_of(scene, plan));
    Estimates result;
    std::vector<std::string> layers = {""};
    if (plan.stokes) layers = {"", "S1.", "S2.", "S3."};
    for (const std::string& name : renderer.film_shape().light_layers) layers.push_back(name + ".");
    result.width = plan.width, result.height = plan.height * uint32_t(layers.size()),
    result.seeds = plan.seeds;
    result.mean.assign(3 * size_t(result.width) * result.height, 0.0);
    for (uint32_t s = 0; s < plan.seeds; ++s) {
        if (s > 0) renderer.restart(plan.first_seed + s);
        for (uint32_t done = 0; done < plan.passes;) {
            const uint32_t count = std::min({plan.passes - done, 64u, std::max(1u, renderer.passes_in(0.5))});
            renderer.render_passes(count);
            done += count;
        }
        const Image image = renderer.develop();
        std::vector<float>& pixels = result.images.emplace_back();
        for (const std::string& layer : layers) {
            std::array<std::span<const float>, 3> planes;
            for (size_t c = 0; c < 3; ++c)
                planes[c] = plane(image, size_t(find_channel(image, layer + "RGB"[c])));
            for (size_t i = 0; i < pixel_count(image); ++i)
                for (const auto& values : planes) pixels.push_back(values[i]);
        }
        for (size_t i = 0; i < pixels.size(); ++i) result.mean[i] += double(pixels[i]) / plan.seeds;
        add_counters(result.counters, renderer.counters());
    }
    CHECK_MESSAGE(result.counters.non_finite + result.counters.forward_non_finite == 0,
                  "samples were not finite");
    return result;
}

Estimates render_estimates(const SceneDescription& description, const RenderPlan& plan) {
    Scene scene = compile_test_scene(description);
    return render_estimates(scene, plan);
}

FilmState render_film(Scene& scene, const RenderPlan& plan, Schedule schedule,
                      const std::vector<uint32_t>& batches) {
    RenderPlan with = plan;
    with.schedule = schedule;
    Renderer renderer(test_device(), scene, settings_of(scene, with));
    for (const uint32_t count : batches) renderer.render_passes(count);
    return renderer.state();
}

Agreement agreement(const Estimates& e, const std::vector<double>& expected, uint32_t tile,
                    const std::vector<double>& expected_sd, const Window& window) {
    REQUIRE(expected.size() == e.mean.size());
    const Clipped area = clipped(window, e.width, e.height);
    const uint32_t columns = (area.x1 - area.x0) / tile, rows = (area.y1 - area.y0) / tile;
    struct Cell {
        double mean = 0, variance = 0, expected = 0, expected_variance = 0;
    };
    std::vector<Cell> cells(size_t(columns) * rows * 3);
    std::vector<double> neighbourhood(cells.size());
    const auto cell_at = [&](uint32_t column, uint32_t row, int c) {
        return 3 * (size_t(row) * columns + column) + size_t(c);
    };
    for (uint32_t row = 0; row < rows; ++row)
        for (uint32_t column = 0; column < columns; ++column)
            for (int c = 0; c < 3; ++c) {
                Cell& cell = cells[cell_at(column, row, c)];
                std::vector<double> means(e.seeds, 0.0);
                for (uint32_t y = 0; y < tile; ++y)
                    for (uint32_t x = 0; x < tile; ++x) {
                        const size_t i =
                            3 * (size_t(area.y0 + row * tile + y) * e.width + area.x0 + column * tile + x) +
                            size_t(c);
                        for (uint32_t s = 0; s < e.seeds; ++s)
                            means[s] += e.images[s][i] / double(tile * tile);
                        cell.expected += expected[i] / (tile * tile);
                        if (!expected_sd.empty())
                            cell.expected_variance += expected_sd[i] * expected_sd[i] / std::pow(tile, 4);
                    }
                Moments moments;
                for (const double m : means) moments.add(m);
                cell.mean = moments.mean;
                cell.variance = moments.standard_error() * moments.standard_error();
            }
    // A few seeds alone tell a pixel's variance badly, worst where a rare bright path is missing from all of
    // them: it is at least half the mean variance of the pixels around.
    const int reach = 2;
    for (int row = 0; row < int(rows); ++row)
        for (int column = 0; column < int(columns); ++column)
            for (int c = 0; c < 3; ++c) {
                double sum = 0, count = 0;
                for (int y = std::max(0, row - reach); y <= std::min(int(rows) - 1, row + reach); ++y)
                    for (int x = std::max(0, column - reach); x <= std::min(int(columns) - 1, column + reach);
                         ++x)
                        sum += cells[cell_at(uint32_t(x), uint32_t(y), c)].variance, ++count;
                neighbourhood[cell_at(uint32_t(column), uint32_t(row), c)] = sum / count;
            }
    Agreement result;
    result.tests = cells.size();
    result.p_limit = sidak_level(0.001, result.tests);
    double squares = 0;
    for (uint32_t row = 0; row < rows; ++row)
        for (uint32_t column = 0; column < columns; ++column)
            for (int c = 0; c < 3; ++c) {
                const size_t i = cell_at(column, row, c);
                const Cell& cell = cells[i];
                // Sums of float32 samples are exact to about this.
                const double rounding = 1e-6 * std::fabs(cell.expected);
                const double variance = std::max(cell.variance, 0.5 * neighbourhood[i]) +
                                        cell.expected_variance + rounding * rounding;
                const double difference = cell.mean - cell.expected;
                const double z = difference == 0 ? 0 : variance > 0 ? difference / std::sqrt(variance) : 1e30;
                const double p = student_two_sided(std::fabs(z), e.seeds - 1);
                squares += std::min(z * z, 1e12);
                if (p < result.least_p || (std::fabs(z) > std::fabs(result.worst_z) && p <= result.least_p)) {
                    result.least_p = p, result.worst_z = z;
                    result.x = area.x0 + column * tile, result.y = area.y0 + row * tile;
                }
            }
    result.rms_z = std::sqrt(squares / double(result.tests));
    result.holds = result.least_p >= result.p_limit;
    return result;
}

Agreement agreement(const Estimates& a, const Estimates& b, uint32_t tile, const Window& window) {
    REQUIRE(a.mean.size() == b.mean.size());
    REQUIRE(a.seeds == b.seeds);
    // Seed by seed: the differences, about the mean of b.
    Estimates difference = a;
    for (uint32_t s = 0; s < a.seeds; ++s)
        for (size_t i = 0; i < a.mean.size(); ++i)
            difference.images[s][i] = float(double(a.images[s][i]) - b.images[s][i] + b.mean[i]);
    return agreement(difference, b.mean, tile, {}, window);
}

std::string describe(const Agreement& a) {
    return fmt::format("least p {:.3g} (limit {:.3g}, {} tests), z {:.2f} at ({}, {}), rms z {:.3f}",
                       a.least_p, a.p_limit, a.tests, a.worst_z, a.x, a.y, a.rms_z);
}

double window_mean(const std::vector<double>& values, uint32_t width, const Window& window, int channel) {
    const Clipped area = clipped(window, width, uint32_t(values.size() / 3 / width));
    double sum = 0, count = 0;
    for (uint32_t y = area.y0; y < area.y1; ++y)
        for (uint32_t x = area.x0; x < area.x1; ++x)
            for (int c = 0; c < 3; ++c)
                if (channel < 0 || c == channel)
                    sum += values[3 * (size_t(y) * width + x) + size_t(c)], ++count;
    return sum / count;
}

WindowMean window_mean(const Estimates& e, const Window& window, int channel) {
    Moments moments;
    for (const auto& image : e.images)
        moments.add(window_mean(std::vector<double>(image.begin(), image.end()), e.width, window, channel));
    return {moments.mean, e.seeds > 1 ? moments.standard_error() : 0.0};
}

std::optional<std::filesystem::path> shared_file(const std::string& name) {
    const char* given = std::getenv("ETENDUE_SHARED");
    const std::filesystem::path folder = given ? given : source_path("../shared");
    if (std::filesystem::exists(folder / name)) return folder / name;
    if (std::getenv("ETENDUE_ALLOW_MISSING_SHARED"))
        MESSAGE("left out: there is no ", name);
    else
        FAIL_CHECK((folder / name).string(),
                   " is missing; ETENDUE_SHARED names the folder of reference scenes");
    return std::nullopt;
}

}  // namespace etendue
