// Phase functions of media, and the tables that some are made of.
#include <algorithm>

#include "host/error.h"
#include "host/scene/scene_compiler.h"

namespace etendue {

// A medium of a class that has no parameter "ior" is as vacuum; so is one whose index its own record will
// refuse.
SpectralValue SceneCompiler::index_of(const MediumDescription& medium) {
    for (const Parameter& p : find_class(Interface::medium, medium.medium).parameters)
        if (p.member.name == "ior" && p.member.type == "SpectrumRef") {
            const SpectralValue ior = spectral_value(medium.medium.parameters.value("ior", p.default_value),
                                                     in_, medium.medium.where + "/ior", SpectralKind::index);
            if (p.in_range(ior.least()) && p.in_range(ior.greatest())) return ior;
        }
    return {glm::vec3(1), {}};
}

MieRef SceneCompiler::add_mie(const ClassInfo& info, const std::vector<std::byte>& record,
                              const std::string& where) {
    const auto spectrum = [&](const char* name, SpectralKind kind) {
        return spectra_[record_member<SpectrumRef>(info, record, name).table].first.as_table(kind);
    };
    const MieParameters p{
        record_member<float>(info, record, "radius"), record_member<float>(info, record, "variance"),
        spectrum("ior", SpectralKind::index), spectrum("absorption_index", SpectralKind::factor),
        surrounding_.as_table(SpectralKind::index)};
    const double size = largest_mie_size(p);
    if (!(size <= most_mie_size))
        fail_input(
            "{}/radius: {:.4g} m; the largest of these spheres have the size parameter {:.0f}; allowed: at "
            "most "
            "{}, "
            "a radius of {:.3g} m",
            message_place(in_, where), p.radius, size, most_mie_size, p.radius * most_mie_size / size);
    uint32_t first = 0;
    for (const auto& table : mie_tables_) {
        if (table->parameters == p) return {first, table->cells};
        first += uint32_t(table->values.size());
    }
    const auto known = std::find_if(memory_.mie_tables.begin(), memory_.mie_tables.end(),
                                    [&](const auto& table) { return table->parameters == p; });
    mie_tables_.push_back(known != memory_.mie_tables.end()
                              ? *known
                              : std::make_shared<const MieTable>(make_mie_table(p, threads_)));
    return {first, mie_tables_.back()->cells};
}

void SceneCompiler::upload_mie() {
    if (mie_tables_ != memory_.mie_tables)
        memory_.buffers.erase("MieValues"), memory_.buffers.erase("MieSums");
    memory_.mie_tables = mie_tables_;
    if (mie_tables_.empty()) return;
    std::vector<glm::vec4> values;
    std::vector<float> sums;
    for (const auto& table : mie_tables_) {
        values.insert(values.end(), table->values.begin(), table->values.end());
        sums.insert(sums.end(), table->sums.begin(), table->sums.end());
    }
    share("MieValues", values);
    share("MieSums", sums);
}

// A parameter of type PhaseRef is itself an object of a class.
void SceneCompiler::add_phases() {
    std::vector<Added> added;
    std::vector<std::string> places;
    for (const MediumDescription& medium : in_.media)
        for (const Parameter& p : find_class(Interface::medium, medium.medium).parameters) {
            if (p.member.type != "PhaseRef") continue;
            const nlohmann::json& given = medium.medium.parameters;
            nlohmann::json value = given.contains(p.member.name) ? given[p.member.name] : p.default_value;
            const std::string where = medium.medium.where + "/" + p.member.name;
            if (!value.is_object() || !value.contains("class") || !value["class"].is_string())
                fail_input("{}: allowed: {{\"class\": name of a phase function, …}}",
                           message_place(in_, where));
            const std::string name = value["class"];
            value.erase("class");
            surrounding_ = index_of(medium);
            added.push_back(add_record(Interface::phase, {name, value, where}));
            places.push_back(where);
        }
    const auto refs = references(Interface::phase, added);
    for (size_t i = 0; i < refs.size(); ++i) phases_[places[i]] = refs[i];
    upload_mie();
    resolver_.phase = [this](const std::string& where) { return phases_.at(where); };
}

}  // namespace etendue
