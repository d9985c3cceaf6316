#include "tests/support/light_probe.h"

#include "host/lights/environment_map.h"
#include "host/scene/records.h"
#include "host/scene/sky_record.h"
#include "tests/support/source_path.h"

namespace etendue {
namespace {

const char* const sample_kernel = R"(
    #include "interfaces/light_source.glsl"
    #include "lib/sampler.glsl"
    layout(local_size_x = 64) in;
    layout(scalar, set = 0) readonly buffer Lights { uint lights[]; };
    layout(scalar, set = 0) readonly buffer Points { vec3 points[]; };
    struct Result { vec3 direction; float distance; vec3 radiance; float pdf; vec3 radiance_towards; float pdf_towards; uint is_delta; };
    layout(scalar, set = 0) writeonly buffer Results { Result results[]; };
    layout(push_constant) uniform Push { uint count, point_count, seed; };
    void main() {
        uint i = gl_GlobalInvocationID.x;
        if (i >= count) return;
        uvec3 h = hash_3d(hash_3d(uvec3(i, seed, 1u)));
        vec3 point = points[i % point_count];
        LightSample l = light_sample_towards(lights[0], point, vec2(h.xy >> 8) / 16777216.0);
        LightHit hit = LightHit(point + l.direction * l.distance, vec3(0), vec2(0), vec2(0));
        results[i] = Result(l.direction, l.distance, l.radiance, l.pdf, light_radiance(lights[0], l.direction, hit),
                            light_pdf_towards(lights[0], point, l.direction, hit), uint(l.is_delta));
    }
)";

const char* const evaluate_kernel = R"(
    #include "interfaces/light_source.glsl"
    layout(local_size_x = 64) in;
    layout(scalar, set = 0) readonly buffer Lights { uint lights[]; };
    layout(scalar, set = 0) readonly buffer Points { vec3 points[]; };
    layout(scalar, set = 0) readonly buffer Directions { vec3 directions[]; };
    layout(scalar, set = 0) writeonly buffer Results { vec4 results[]; };
    layout(push_constant) uniform Push { uint count; };
    void main() {
        uint i = gl_GlobalInvocationID.x;
        if (i >= count) return;
        LightHit hit = LightHit(vec3(0), vec3(0), vec2(0), vec2(0));
        results[i] = vec4(light_radiance(lights[0], directions[i], hit), light_pdf_towards(lights[0], points[0], directions[i], hit));
    }
)";

}  // namespace

ShaderSources test_sources() {
    ShaderSources sources;
    sources.folder = source_path("shaders");
    return sources;
}

LightProbe::LightProbe(const std::string& class_name, const nlohmann::json& parameters,
                       const glm::dmat4& placement, const ImageDescription& image) {
    ClassRegistry registry(test_sources());
    const ClassInfo* info = registry.find(Interface::light, class_name);
    REQUIRE(info);
    std::vector<glm::uvec4> texels(1);
    SceneDescription scene;
    std::vector<float> photometric(1);
    RecordResolver resolver{scene, {}, {}, [&](const std::filesystem::path&, const std::string&) {
                                EnvironmentMap map = build_environment_map(image);
                                texels = map.texels;
                                texels.insert(texels.begin(),
                                              glm::uvec4(0));  // `first` is not always 0
                                map.ref.first = 1;
                                return map.ref;
                            }};
    resolver.photometry = [&](const std::filesystem::path& file) {
        return append_photometric_table(photometric, read_photometric_file(file));
    };
    resolver.sky = [&](const ClassInfo& sky_class, const std::vector<std::byte>& record, const std::string&) {
        Sky sky = build_sky(sky_parameters(sky_class, record, "/light"));
        sky.ref.map.first = uint32_t(texels.size());
        texels.insert(texels.end(), sky.map.texels.begin(), sky.map.texels.end());
        return sky.ref;
    };
    std::vector<uint32_t> ray_words(1);
    std::vector<SpectrumRef> ray_colors(1);
    resolver.rays = [&](const std::filesystem::path& file, const ClassInfo&, const std::vector<std::byte>&,
                        const std::string&) {
        RaySet set = append_ray_set(ray_words, read_ray_file(file));
        set.ref.first_color = 1;
        for (const SpectralValue& color : set.colors) ray_colors.push_back({color.rgb, 0});
        return set.ref;
    };
    RecordBuffer records;
    records.add(*info, fill_record(*info, {class_name, parameters, "/light"}, placement, resolver));
    records.layout();
    records_ = create_buffer(test_device(), records.bytes(), "light records");
    texels_ = create_buffer(test_device(), texels, "environment texels");
    photometric_ = create_buffer(test_device(), photometric, "photometric values");
    ray_words_ = create_buffer(test_device(), ray_words, "ray words");
    ray_colors_ = create_buffer(test_device(), ray_colors, "ray colors");
    lights_ = create_buffer(test_device(), std::vector<uint32_t>{records.ref(*info, 0)}, "lights");
    sources_ = test_sources();
    sources_.generated["generated/light_classes.glsl"] =
        class_header(interface_info(Interface::light), {info});
    sources_.generated["generated/geometry_classes.glsl"] =
        class_header(interface_info(Interface::geometry), {});
    features_.light_count = 1;
    features_.scene_radius = 1;
}

Kernel LightProbe::kernel(const std::string& name, const std::string& text, BufferTable buffers) {
    ShaderSources sources = sources_;
    if (!text.empty()) sources.generated[name] = text;
    CompileOptions options;
    options.defines = features_.defines();
    buffers["LightRecords"] = &records_;
    buffers["EnvironmentTexels"] = &texels_;
    buffers["PhotometricValues"] = &photometric_;
    buffers["RayWords"] = &ray_words_;
    buffers["RayColors"] = &ray_colors_;
    buffers["Lights"] = &lights_;
    // No surfaces, so the opening of no lamp.
    for (const char* name : {"Primitives", "Transforms", "GeometryRecords"}) buffers[name] = &lights_;
    return Kernel(test_device(), compile_shader(sources, name, options), buffers);
}

static std::vector<ProbeSample> run_samples(const Kernel& kernel, Buffer& out, uint32_t count,
                                            uint32_t points, uint32_t seed) {
    CommandList list(test_device());
    list.dispatch(kernel, (count + 63) / 64, {{"count", count}, {"point_count", points}, {"seed", seed}});
    list.run();
    return out.read_array<ProbeSample>(count);
}

std::vector<ProbeSample> LightProbe::sample(glm::vec3 point, uint32_t count, uint32_t seed) {
    Buffer points = create_buffer(test_device(), std::vector<glm::vec3>{point}, "points");
    Buffer out(test_device(), uint64_t(count) * sizeof(ProbeSample), "results");
    return run_samples(kernel("sample_light", sample_kernel, {{"Points", &points}, {"Results", &out}}), out,
                       count, 1, seed);
}

std::vector<ProbeSample> LightProbe::sample_at(const std::vector<glm::vec3>& at) {
    const uint32_t count = uint32_t(at.size());
    Buffer points = create_buffer(test_device(), at, "points");
    Buffer out(test_device(), uint64_t(count) * sizeof(ProbeSample), "results");
    return run_samples(kernel("sample_light", sample_kernel, {{"Points", &points}, {"Results", &out}}), out,
                       count, count, 0);
}

std::vector<ProbeValue> LightProbe::evaluate(glm::vec3 point, const std::vector<glm::vec3>& directions) {
    const uint32_t count = uint32_t(directions.size());
    Buffer points = create_buffer(test_device(), std::vector<glm::vec3>{point}, "points");
    Buffer along = create_buffer(test_device(), directions, "directions");
    Buffer out(test_device(), uint64_t(count) * sizeof(ProbeValue), "results");
    const Kernel evaluate = kernel("evaluate_light", evaluate_kernel,
                                   {{"Points", &points}, {"Directions", &along}, {"Results", &out}});
    CommandList list(test_device());
    list.dispatch(evaluate, (count + 63) / 64, {{"count", count}});
    list.run();
    return out.read_array<ProbeValue>(count);
}

LightBounds LightProbe::measure(float scene_radius) {
    features_.scene_radius = scene_radius;
    Buffer out(test_device(), sizeof(LightBounds), "light bounds");
    const Kernel measure = kernel("kernels/measure_lights.comp", "", {{"LightBoundsTable", &out}});
    CommandList list(test_device());
    list.dispatch(measure, 1, {{"light_count", 1u}});
    list.run();
    return out.read_array<LightBounds>(1)[0];
}

}  // namespace etendue
