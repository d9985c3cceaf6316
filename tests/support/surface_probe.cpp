#include "tests/support/surface_probe.h"

#include <fmt/format.h>

#include <fstream>
#include <sstream>

#include "host/measured/mueller_table.h"
#include "host/scene/features.h"
#include "host/scene/grating_table.h"
#include "host/scene/records.h"
#include "tests/support/source_path.h"

namespace etendue {
namespace {

constexpr uint32_t max_count = 1 << 17;  // samples or pairs of one dispatch
constexpr uint32_t max_queries = 1 << 12;

Kernel probe_kernel(ShaderSources sources, const std::string& name, const BufferTable& buffers) {
    sources.generated[name] = test_kernel_text(name);
    CompileOptions options;
    Features features;
    features.general_mueller = features.body_mueller = true;
    options.defines = features.defines();
    return Kernel(test_device(), compile_shader(sources, name, options), buffers);
}

uint32_t groups(size_t count) { return uint32_t((count + 63) / 64); }

std::vector<PushValue> push_values(uint32_t count, uint32_t surface, const SurfaceSurroundings& at) {
    return {{"count", count},
            {"surface", surface},
            {"ior_above", at.ior_above},
            {"ior_below", at.ior_below},
            {"importance", uint32_t(at.importance)},
            {"color_r", at.color.x},
            {"color_g", at.color.y},
            {"color_b", at.color.z},
            {"color_a", at.color.w}};
}

}  // namespace

std::string test_kernel_text(const std::string& name) {
    std::ifstream file(source_path("tests/kernels/" + name));
    REQUIRE_MESSAGE(file, "tests/kernels/", name);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

SurfaceProbe::SurfaceProbe(ClassRegistry& registry, const std::string& class_name,
                           const std::vector<nlohmann::json>& parameters) {
    const ClassInfo* info = registry.find(Interface::surface, class_name);
    REQUIRE(info);
    ShaderSources sources = registry.sources();
    sources.generated["generated/surface_classes.glsl"] =
        class_header(interface_info(Interface::surface), {info});

    // Textures of one value, in place of images.
    std::vector<glm::vec4> textures;
    const SceneDescription scene;
    const auto add_texture = [&](const nlohmann::json& value, bool, const std::string&) {
        const nlohmann::json& v = value["value"];
        textures.push_back({v[0].get<float>(), v[1].get<float>(), v[2].get<float>(), v[3].get<float>()});
        return uint32_t(textures.size() - 1);
    };
    RecordResolver resolver{scene, {}, add_texture, {}};
    MeasuredBsdf measured;
    resolver.measured = [&](const std::filesystem::path& file) {
        return append(measured, read_measured_bsdf(file));
    };
    MuellerTables matrices;
    std::vector<MuellerTable> tables;
    resolver.mueller_table = [&](const std::filesystem::path& file) {
        const MuellerFile read = read_mueller_file(file, 2, matrices);
        tables.push_back(read.table);
        tables.back().place_rgb = read.place.rgb;
        return uint32_t(tables.size() - 1);
    };
    std::vector<GratingOrder> orders;
    resolver.grating = [&](const nlohmann::json& value, const std::string& where) {
        return append(orders, read_grating_orders(value, scene, where, resolver.spectrum));
    };
    std::vector<float> numbers;
    resolver.grating_table = [&](const nlohmann::json& value, const std::string& where) {
        return append(orders, numbers, read_grating_table(value, scene, where));
    };
    RecordBuffer records;
    for (const nlohmann::json& p : parameters)
        records.add(*info, fill_record(*info, {class_name, p, "/surface"}, std::nullopt, resolver));
    records.layout();
    for (uint32_t i = 0; i < parameters.size(); ++i) refs_.push_back(records.ref(*info, i));
    std::string texture_text = "vec4 texture_value(TextureRef ref, vec2 uv0, vec2 uv1) {\n";
    for (size_t i = 0; i < textures.size(); ++i)
        texture_text += fmt::format("if (ref.index == {}u) return vec4({}, {}, {}, {});\n", i, textures[i].x,
                                    textures[i].y, textures[i].z, textures[i].w);
    sources.generated["features/textures.glsl"] = texture_text + "return vec4(1);\n}\n";

    Device& device = test_device();
    records_ = create_buffer(device, records.bytes(), "surface records");
    measured_points_ = create_buffer(device, measured.points, "measured points");
    measured_colors_ = create_buffer(device, measured.colors, "measured colors");
    mueller_tables_ = create_buffer(device, tables, "Mueller tables");
    mueller_numbers_ = create_buffer(device, matrices.numbers, "Mueller numbers");
    mueller_intensities_ = create_buffer(device, matrices.intensities, "Mueller intensities");
    mueller_ratios_ = create_buffer(device, matrices.ratios, "Mueller ratios");
    grating_orders_ = create_buffer(device, orders, "grating orders");
    grating_numbers_ = create_buffer(device, numbers, "grating numbers");
    samples_ = Buffer(device, max_count * sizeof(SurfaceSample), "surface samples");
    answers_ = Buffer(device, sizeof(glm::vec4), "surface answers");
    pairs_ = Buffer(device, max_count * sizeof(DirectionPair), "direction pairs");
    values_ = Buffer(device, max_count * sizeof(SurfaceValue), "surface values");
    const std::string block = std::string(interface_info(Interface::surface).buffer) + "__" + class_name;
    queries_ = Buffer(device, max_queries * sizeof(MuellerQuery), "Mueller queries");
    muellers_ = Buffer(device, max_queries * sizeof(MuellerAnswer), "Mueller matrices");
    BufferTable table{{block, &records_},
                      {interface_info(Interface::surface).buffer, &records_},
                      {"Samples", &samples_},
                      {"Answers", &answers_},
                      {"Pairs", &pairs_},
                      {"Values", &values_},
                      {"Queries", &queries_},
                      {"Muellers", &muellers_},
                      {"MeasuredPoints", &measured_points_},
                      {"MeasuredColors", &measured_colors_},
                      {"MuellerTables", &mueller_tables_},
                      {"MuellerNumbers", &mueller_numbers_},
                      {"MuellerIntensities", &mueller_intensities_},
                      {"MuellerRatios", &mueller_ratios_},
                      {"GratingOrderRows", &grating_orders_},
                      {"GratingNumbers", &grating_numbers_}};
    sample_ = probe_kernel(sources, "sample_surface.comp", table);
    evaluate_ = probe_kernel(sources, "evaluate_surface.comp", table);
    polarize_ = probe_kernel(sources, "polarize_surface.comp", table);
}

SurfaceSamples SurfaceProbe::sample(size_t record, const SurfaceSurroundings& at, glm::vec3 wo,
                                    uint32_t count, uint32_t seed) {
    REQUIRE(count <= max_count);
    std::vector<PushValue> values = push_values(count, refs_.at(record), at);
    for (const PushValue& value : {PushValue{"seed", seed}, {"wo_x", wo.x}, {"wo_y", wo.y}, {"wo_z", wo.z}})
        values.push_back(value);
    CommandList list(test_device());
    list.dispatch(sample_, groups(count), values);
    list.run();
    const glm::vec4 answer = answers_.read_array<glm::vec4>(1)[0];
    return {samples_.read_array<SurfaceSample>(count), glm::vec3(answer), (int(answer.w) & 1) != 0,
            (int(answer.w) & 2) != 0};
}

std::vector<SurfaceValue> SurfaceProbe::evaluate(size_t record, const SurfaceSurroundings& at,
                                                 std::span<const DirectionPair> pairs) {
    std::vector<SurfaceValue> result;
    while (!pairs.empty()) {
        const auto part = pairs.first(std::min<size_t>(pairs.size(), max_count));
        pairs_.write(part.data(), part.size_bytes());
        CommandList list(test_device());
        list.dispatch(evaluate_, groups(part.size()),
                      push_values(uint32_t(part.size()), refs_.at(record), at));
        list.run();
        const auto values = values_.read_array<SurfaceValue>(part.size());
        result.insert(result.end(), values.begin(), values.end());
        pairs = pairs.subspan(part.size());
    }
    return result;
}

std::vector<MuellerAnswer> SurfaceProbe::polarize(size_t record, const SurfaceSurroundings& at,
                                                  std::span<const MuellerQuery> queries) {
    REQUIRE(queries.size() <= max_queries);
    queries_.write(queries.data(), queries.size_bytes());
    CommandList list(test_device());
    list.dispatch(polarize_, groups(queries.size()),
                  push_values(uint32_t(queries.size()), refs_.at(record), at));
    list.run();
    return muellers_.read_array<MuellerAnswer>(queries.size());
}

}  // namespace etendue
