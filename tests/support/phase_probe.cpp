#include "tests/support/phase_probe.h"

#include "host/scene/records.h"
#include "host/spectra/wavelengths.h"

namespace etendue {
namespace {

using nlohmann::json;

constexpr uint32_t max_count = 1 << 18, max_queries = 1 << 12;

uint32_t groups(size_t count) { return uint32_t((count + 63) / 64); }

}  // namespace

std::vector<json> phase_configurations(const std::string& name) {
    if (name == "isotropic" || name == "rayleigh") return {json::object()};
    if (name == "henyey_greenstein") {
        std::vector<json> result;
        for (const double g : {0.0, 1e-4, 0.5, -0.5, 0.9, 0.99, -0.99, 0.999}) result.push_back({{"g", g}});
        return result;
    }
    if (name == "mie")
        return {{{"radius", 1e-8}, {"variance", 0}},
                {{"radius", 4e-7}, {"variance", 0}, {"ior", 1.6}},
                {{"radius", 1e-6}, {"variance", 0.1}},
                {{"radius", 1e-6}, {"variance", 0.02}, {"ior", 1.5}, {"absorption_index", 0.3}},
                {{"radius", 5e-6}, {"variance", 0.05}}};
    return {};
}

MieParameters mie_parameters(const json& r) {
    return {r.at("radius"), r.at("variance"), constant_spectrum(r.value("ior", 1.33)),
            constant_spectrum(r.value("absorption_index", 0.0)), constant_spectrum(1)};
}

PhaseProbe::PhaseProbe(ClassRegistry& registry, const std::string& class_name,
                       const std::vector<json>& parameters, std::optional<glm::vec4> nm)
    : lanes_(nm ? 4 : 3) {
    const ClassInfo* info = registry.find(Interface::phase, class_name);
    REQUIRE(info);
    const SceneDescription scene;
    RecordResolver resolver{scene, {}, {}, {}};
    std::vector<glm::vec4> values(1);
    std::vector<float> sums(1);
    json current;
    resolver.mie = [&](const ClassInfo&, const std::vector<std::byte>&, const std::string&) {
        const MieTable table = make_mie_table(mie_parameters(current), 2);
        const MieRef ref{uint32_t(values.size()), table.cells};
        values.insert(values.end(), table.values.begin(), table.values.end());
        sums.insert(sums.end(), table.sums.begin(), table.sums.end());
        return ref;
    };
    RecordBuffer records;
    for (const json& p : parameters) {
        current = p;
        records.add(*info, fill_record(*info, {class_name, p, "/phase"}, {}, resolver));
    }
    records.layout();
    for (uint32_t i = 0; i < parameters.size(); ++i) refs_.push_back(records.ref(*info, i));
    Device& device = test_device();
    Wavelengths pass{};
    pass.nm = nm.value_or(glm::vec4(0));
    records_ = create_buffer(device, records.bytes(), "PhaseRecords");
    mie_values_ = create_buffer(device, values, "MieValues");
    mie_sums_ = create_buffer(device, sums, "MieSums");
    wavelengths_ = create_buffer(device, std::vector<Wavelengths>{pass}, "WavelengthTable");
    cosines_ = Buffer(device, max_count * 4, "Cosines");
    samples_ = Buffer(device, max_count * 4, "Samples");
    values_ = Buffer(device, max_count * 4 * uint32_t(lanes_), "Values");
    queries_ = Buffer(device, max_queries * sizeof(MuellerQuery), "Mueller queries");
    muellers_ = Buffer(device, max_queries * sizeof(MuellerAnswer), "Mueller matrices");
    const BufferTable table{{"PhaseRecords", &records_}, {"MieValues", &mie_values_},
                            {"MieSums", &mie_sums_},     {"WavelengthTable", &wavelengths_},
                            {"Cosines", &cosines_},      {"Samples", &samples_},
                            {"Values", &values_},        {"Queries", &queries_},
                            {"Muellers", &muellers_}};
    const std::map<std::string, std::string> generated{
        {"generated/phase_classes.glsl", class_header(interface_info(Interface::phase), {info})}};
    const std::string defines =
        nm ? "#define SPECTRAL 1\n#define SPECTRUM_COUNT 1\n#define COLOR_LATTICE 2\n" : "";
    sample_ = make_test_kernel("sample_phase.comp", defines + test_kernel_text("sample_phase.comp"), table,
                               generated);
    if (!nm)
        polarize_ = make_test_kernel("polarize_phase.comp", test_kernel_text("polarize_phase.comp"), table,
                                     generated);
}

std::vector<float> PhaseProbe::draw(size_t record, uint32_t count, uint32_t seed) {
    CommandList commands(test_device());
    commands.dispatch(sample_, groups(count),
                      {{"count", count}, {"asked", 0u}, {"seed", seed}, {"phase", refs_[record]}});
    commands.run();
    return samples_.read_array<float>(count);
}

std::vector<std::vector<float>> PhaseProbe::values(size_t record, std::span<const float> cosines) {
    REQUIRE(cosines.size() <= max_count);
    cosines_.write(cosines.data(), cosines.size_bytes());
    CommandList commands(test_device());
    commands.dispatch(
        sample_, groups(cosines.size()),
        {{"count", 0u}, {"asked", uint32_t(cosines.size())}, {"seed", 0u}, {"phase", refs_[record]}});
    commands.run();
    const auto flat = values_.read_array<float>(cosines.size() * size_t(lanes_));
    std::vector<std::vector<float>> result;
    for (size_t i = 0; i < flat.size(); i += size_t(lanes_))
        result.emplace_back(flat.begin() + ptrdiff_t(i), flat.begin() + ptrdiff_t(i) + lanes_);
    return result;
}

std::vector<MuellerAnswer> PhaseProbe::polarize(size_t record, std::span<const MuellerQuery> queries) {
    REQUIRE(queries.size() <= max_queries);
    queries_.write(queries.data(), queries.size_bytes());
    CommandList commands(test_device());
    commands.dispatch(polarize_, groups(queries.size()),
                      {{"asked", uint32_t(queries.size())}, {"phase", refs_[record]}});
    commands.run();
    return muellers_.read_array<MuellerAnswer>(queries.size());
}

}  // namespace etendue
