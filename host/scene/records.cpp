#include "host/scene/records.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "host/error.h"
#include "host/measured/mueller_matrix.h"
#include "host/scene/sky_record.h"

namespace etendue {
namespace {

using nlohmann::json;

template <class T>
void store(std::vector<std::byte>& record, uint32_t offset, const T& value) {
    std::memcpy(record.data() + offset, &value, sizeof(T));
}

std::string allowed(const Parameter& p) {
    const std::string range = p.range();
    return range.empty() ? "" : " in " + range + (p.unit.empty() ? "" : " " + p.unit);
}

float checked_number(const json& value, const Parameter& p, const std::string& place) {
    if (!value.is_number()) fail_input("{}: not a number; allowed: a number{}", place, allowed(p));
    const double number = value.get<double>();
    if (!std::isfinite(number) || std::abs(number) > 3e38 || !p.in_range(number))
        fail_input("{}: {} is out of range; allowed: a number{}", place, number, allowed(p));
    return float(number);
}

glm::dvec3 checked_vector(const json& value, const Parameter& p, const std::string& place) {
    if (!value.is_array() || value.size() != 3)
        fail_input("{}: allowed: an array of 3 numbers{}", place, allowed(p));
    for (size_t i = 0; i < 3; ++i) checked_number(value[i], p, fmt::format("{}/{}", place, i));
    return {value[0].get<double>(), value[1].get<double>(), value[2].get<double>()};
}

int vector_length(const std::string& type) {
    return type == "vec2" ? 2 : type == "vec3" ? 3 : type == "vec4" ? 4 : 0;
}

// Lights carry radiance or a colour of it; a unit "ior" marks refractive indices.
SpectralKind spectral_kind(const Parameter& p, Interface interface) {
    if (interface == Interface::light) return SpectralKind::radiance;
    return p.unit == "ior" ? SpectralKind::index : SpectralKind::factor;
}

// One parameter, from its JSON value, into the record.
void fill_parameter(const ClassInfo& info, const Parameter& p, const json& value, const std::string& where,
                    const RecordResolver& resolver, std::vector<std::byte>& record) {
    const Interface interface = info.interface;
    const std::string& type = p.member.type;
    const uint32_t at = p.member.offset;
    const std::string place = message_place(resolver.scene, where);
    if (!p.choices.empty()) {
        const auto chosen =
            std::find(p.choices.begin(), p.choices.end(), value.is_string() ? value.get<std::string>() : "");
        if (chosen == p.choices.end())
            fail_input("{}: {} is not allowed; allowed: {}", place, value.dump(), p.range());
        store(record, at, uint32_t(chosen - p.choices.begin()));
    } else if (type == "float") {
        store(record, at, checked_number(value, p, place));
    } else if (const int length = vector_length(type)) {
        if (!value.is_array() || int(value.size()) != length)
            fail_input("{}: allowed: an array of {} numbers{}", place, length, allowed(p));
        for (int i = 0; i < length; ++i)
            store(record, at + 4 * i, checked_number(value[i], p, fmt::format("{}/{}", place, i)));
    } else if (type == "WorldPoint" || type == "Direction") {
        const glm::dvec3 v = checked_vector(value, p, place);
        if (type == "WorldPoint") {
            store(record, at, resolver.world_point(v));
        } else {
            if (!(glm::length(v) > 0)) fail_input("{}: has no length; allowed: a direction", place);
            store(record, at, glm::vec3(glm::normalize(v)));
        }
    } else if (type == "SunDirection") {
        store(record, at, read_sun(value, place));
    } else if (type == "uint" || type == "int") {
        // A bool of GLSL is a uint in a buffer; its default tells them apart.
        if (p.default_value.is_boolean()) {
            if (!value.is_boolean()) fail_input("{}: allowed: true or false", place);
            store(record, at, uint32_t(value.get<bool>()));
        } else {
            if (!value.is_number_integer()) fail_input("{}: allowed: a whole number{}", place, allowed(p));
            checked_number(value, p, place);
            if (type == "uint" && value.get<int64_t>() < 0)
                fail_input("{}: allowed: a whole number >= 0", place);
            store(record, at, uint32_t(value.get<int64_t>()));
        }
    } else if (type == "SpectrumRef") {
        const SpectralKind kind = spectral_kind(p, interface);
        SpectralValue spectrum{glm::vec3(-1), {}};
        if (!value.is_null()) spectrum = spectral_value(value, resolver.scene, where, kind);
        for (const float x : {spectrum.least(), spectrum.greatest()})
            if (!value.is_null() && !p.in_range(x))
                fail_input("{}: {} is out of range; allowed:{}", place, x, allowed(p));
        store(record, at, SpectrumRef{spectrum.rgb, resolver.spectrum(spectrum, kind)});
    } else if (type == "AsphereCoefficients") {
        if (!value.is_array() || value.size() > 8)
            fail_input("{}: allowed: an array of at most 8 numbers, the coefficients of r^4, r^6, …", place);
        for (size_t i = 0; i < value.size(); ++i)
            store(record, at + 4 * uint32_t(i), checked_number(value[i], p, fmt::format("{}/{}", place, i)));
    } else if (type == "BezierPiece") {
        const auto only = [&] {
            return cut_bezier_patches(read_bezier_patches(value, place), place).front();
        };
        store(record, at, resolver.piece ? *resolver.piece : only());
    } else if (type == "MuellerMatrix") {
        if (!value.is_array() || value.size() != 16)
            fail_input("{}: allowed: an array of 16 numbers, row by row", place);
        MuellerMatrix m;
        for (size_t i = 0; i < 16; ++i) {
            m[i] = checked_number(value[i], p, fmt::format("{}/{}", place, i));
            store(record, at + 4 * uint32_t(i), float(m[i]));
        }
        if (const std::string flaw = flaw_of(m); !flaw.empty())
            fail_input("{}: {}; allowed: a physical Mueller matrix", place, flaw);
    } else if (type == "TextureRef") {
        store(record, at, value.is_null() ? no_record : resolver.texture(value, p.unit != "data", where));
    } else if (type == "MediumRef") {
        uint32_t ref = no_record;
        if (!value.is_null()) {
            const auto found =
                value.is_string() ? resolver.media.find(value.get<std::string>()) : resolver.media.end();
            if (found == resolver.media.end())
                fail_input("{}: {} is not the name of a medium", place, value.dump());
            ref = found->second;
        }
        store(record, at, ref);
    } else if (type == "PhaseRef") {
        store(record, at, resolver.phase(where));
    } else if (type == "GridRef") {
        store(record, at, resolver.grid(value, where));
    } else if (type == "EnvironmentMapRef") {
        if (!value.is_string()) fail_input("{}: allowed: the name of an image file", place);
        store(record, at, resolver.environment_map(value.get<std::string>(), where));
    } else if (type == "MeasuredRef") {
        if (!value.is_string()) fail_input("{}: allowed: the name of a .json or .bsdf file", place);
        store(record, at, resolver.measured(value.get<std::string>()));
    } else if (type == "PhotometryRef") {
        if (!value.is_string()) fail_input("{}: allowed: the name of an .ies or .ldt file", place);
        store(record, at, resolver.photometry(value.get<std::string>()));
    } else if (type == "OwnShape") {
        if (!value.is_boolean()) fail_input("{}: allowed: true, false", place);
        store(record, at, value.get<bool>() ? resolver.own_shape(where) : no_record);
    } else if (type == "RayFileRef") {
        if (!value.is_string()) fail_input("{}: allowed: the name of a ray file", place);
        store(record, at, resolver.rays(value.get<std::string>(), info, record, where));
    } else if (type == "WatchedSurface") {
        if (!value.is_string() && !value.is_null())
            fail_input("{}: allowed: the name of a node or of a mesh", place);
        store(record, at, resolver.watched(value.is_null() ? "" : value.get<std::string>(), where));
    } else if (type == "MuellerTableRef") {
        if (!value.is_string()) fail_input("{}: allowed: the name of a .pbsdf file", place);
        store(record, at, resolver.mueller_table(value.get<std::string>()));
    } else if (type == "MicroPlaces") {
        if (!value.is_string() && !value.is_null())
            fail_input("{}: allowed: the name of a file of places", place);
        store(record, at,
              value.is_null() ? MicroPlaces{} : resolver.places(value.get<std::string>(), info, record));
    } else if (type == "CellMesh") {  // the importer has read the scene
        const auto number = value.is_number_unsigned() ? value.get<uint64_t>() : resolver.scene.cells.size();
        if (!value.is_null() && number >= resolver.scene.cells.size())
            fail_input("{}: allowed: the index of a scene, in a scene file", place);
        store(record, at, value.is_null() ? CellMesh{} : resolver.cell(uint32_t(number)));
    } else if (type == "GratingOrders") {
        store(record, at, value.is_null() ? GratingOrders{} : resolver.grating(value, where));
    } else if (type == "GratingTable") {
        store(record, at, value.is_null() ? GratingTable{} : resolver.grating_table(value, where));
    } else {
        fail_input("{}: the class's member {} has type {}, which no parameter can fill", place, p.member.name,
                   type);
    }
}

}  // namespace

std::string member_path(const ClassInfo& info, const std::string& member) {
    return fmt::format("{}/{}/{}", interface_info(info.interface).name, info.name, member);
}

std::vector<std::byte> fill_record(const ClassInfo& info, const ObjectDescription& object,
                                   const std::optional<glm::dmat4>& placement,
                                   const RecordResolver& resolver) {
    std::vector<std::byte> record(info.stride);
    for (const auto& [name, value] : object.parameters.items()) {
        const auto known = std::any_of(
            info.parameters.begin(), info.parameters.end(),
            [&, &name = name](const Parameter& p) { return p.from_scene && p.member.name == name; });
        if (known) continue;
        std::string names;
        for (const Parameter& p : info.parameters)
            if (p.from_scene) names += (names.empty() ? "" : ", ") + p.member.name;
        fail_input("{}: unknown parameter of {} {}; allowed: {}",
                   message_place(resolver.scene, object.where + "/" + name),
                   interface_info(info.interface).name, info.name, names.empty() ? "none" : names);
    }
    for (const Parameter& p : info.parameters) {
        if (p.member.type == "Placement") {
            const glm::dmat4 m = placement.value_or(glm::dmat4(1.0));
            for (int column = 0; column < 4; ++column)
                store(record, p.member.offset + 12 * column, glm::vec3(m[column]));
        } else if (p.member.type == "MieRef") {  // stands behind what it is made from
            store(record, p.member.offset, resolver.mie(info, record, object.where));
        } else if (p.member.type == "SkyRef") {
            store(record, p.member.offset, resolver.sky(info, record, object.where));
        } else if (p.from_scene) {
            const bool given = object.parameters.contains(p.member.name);
            if (!given && p.required)
                fail_input("{}: {} {} needs the parameter {}; {}",
                           message_place(resolver.scene, object.where), interface_info(info.interface).name,
                           info.name, p.member.name, p.text);
            fill_parameter(info, p, given ? object.parameters[p.member.name] : p.default_value,
                           object.where + "/" + p.member.name, resolver, record);
        }
    }
    return record;
}

void RecordBuffer::add(const ClassInfo& info, std::vector<std::byte> record) {
    Region& region = regions_.try_emplace(info.name, Region{info.tag, info.stride}).first->second;
    region.records.insert(region.records.end(), record.begin(), record.end());
}

uint32_t RecordBuffer::count(const ClassInfo& info) const {
    const auto found = regions_.find(info.name);
    return found == regions_.end() ? 0 : uint32_t(found->second.records.size() / info.stride);
}

void RecordBuffer::layout() {
    bytes_.clear();
    for (auto& [name, region] : regions_) {
        const size_t start = (bytes_.size() + region.stride - 1) / region.stride * region.stride;
        region.first = uint32_t(start / region.stride);
        if (region.first + region.records.size() / region.stride > 0xFFFFFF)
            fail_input("too many objects of class {}: at most 16 million", name);
        bytes_.resize(start);
        bytes_.insert(bytes_.end(), region.records.begin(), region.records.end());
    }
}

namespace {

// Only the kinds of measurements that there are need code.
void add_measured_kinds(const std::vector<std::byte>& records, uint32_t stride, const MemberLayout& member,
                        ClassConstants& constants) {
    uint32_t first = 0;
    bool equal = true, anisotropic = false;
    for (size_t at = 0; at < records.size(); at += stride) {
        uint32_t kind;
        static_assert(offsetof(MeasuredRef, kind) == 0);
        std::memcpy(&kind, &records[at + member.offset], sizeof(kind));
        if (at == 0) first = kind;
        equal = equal && kind == first;
        anisotropic = anisotropic || (kind & measured_anisotropic);
    }
    if (equal) constants.statements += fmt::format("r.{}.kind = {}u; ", member.name, first);
    constants.macros += fmt::format("#define MEASURED_SLICES {}\n", anisotropic ? 4 : 2);
}

void add_absence_of_tables(const std::vector<std::byte>& records, uint32_t stride, const MemberLayout& member,
                           ClassConstants& constants) {
    for (size_t at = 0; at < records.size(); at += stride) {
        GratingTable table;
        std::memcpy(&table, &records[at + member.offset], sizeof(table));
        if (table.first != no_record) return;
    }
    constants.statements += fmt::format("r.{}.first = NO_RECORD; ", member.name);
}

}  // namespace

// Its first number, of each record.
static std::vector<uint32_t> first_numbers(const std::vector<std::byte>& records, uint32_t stride,
                                           const MemberLayout& member) {
    std::vector<uint32_t> numbers(records.size() / stride);
    for (size_t i = 0; i < numbers.size(); ++i)
        std::memcpy(&numbers[i], &records[i * stride + member.offset], sizeof(uint32_t));
    return numbers;
}

ClassConstants RecordBuffer::constant_members(const ClassInfo& info,
                                              const std::set<std::string>& varying) const {
    const auto region = regions_.find(info.name);
    if (region == regions_.end() || region->second.records.empty()) return {};
    const std::vector<std::byte>& records = region->second.records;
    ClassConstants constants;
    for (const Parameter& p : info.parameters) {
        const std::string &type = p.member.type, &name = p.member.name;
        if (type == "MeasuredRef") add_measured_kinds(records, info.stride, p.member, constants);
        static_assert(offsetof(CellMesh, nodes) == 0);
        if (type == "CellMesh" &&
            std::ranges::none_of(first_numbers(records, info.stride, p.member), std::identity{}))
            constants.statements += fmt::format("r.{}.nodes = 0u; ", name);
        if (type == "GratingTable") add_absence_of_tables(records, info.stride, p.member, constants);
        const int length = vector_length(type);
        if (!p.from_scene || (p.member.size != 4 && !length)) continue;
        if (varying.count(member_path(info, name))) continue;
        bool equal = true;
        for (size_t at = info.stride; at < records.size(); at += info.stride)
            equal = equal &&
                    !std::memcmp(&records[at + p.member.offset], &records[p.member.offset], p.member.size);
        if (!equal) continue;
        uint32_t bits[4];
        std::memcpy(bits, &records[p.member.offset], p.member.size);
        constexpr uint32_t one = 0x3F800000u;
        if (type == "TextureRef" && *bits == no_record) {
            constants.statements += fmt::format("r.{}.index = NO_RECORD; ", name);
        } else if (type == "OwnShape") {
            if (*bits == no_record) constants.statements += fmt::format("r.{}.primitive = NO_RECORD; ", name);
        } else if (type == "MuellerTableRef") {
            constants.statements += fmt::format("r.{}.index = {}u; ", name, *bits);
        } else if (p.default_value.is_boolean()) {
            constants.statements += fmt::format("r.{} = {}; ", name, *bits ? "true" : "false");
        } else if (type == "uint" || type == "int") {
            constants.statements += fmt::format("r.{} = {}({}u); ", name, type, *bits);
        } else if (type == "float" && (*bits == 0 || *bits == one)) {
            constants.statements += fmt::format("r.{} = {}; ", name, *bits ? "1.0" : "0.0");
            if (*bits == 0) constants.macros += fmt::format("#define ABSENT_{}_{}\n", info.prefix, name);
        } else if (std::all_of(bits, bits + length, [](uint32_t b) { return b == 0 || b == one; })) {
            std::string values;
            for (int i = 0; i < length; ++i) values += bits[i] ? ", 1.0" : ", 0.0";
            if (length) constants.statements += fmt::format("r.{} = {}({}); ", name, type, values.substr(2));
        }
    }
    return constants;
}

uint32_t RecordBuffer::ref(const ClassInfo& info, uint32_t nth) const {
    return record_ref(info.tag, regions_.at(info.name).first + nth);
}

}  // namespace etendue
