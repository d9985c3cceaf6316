// The extension ETD_optics: what glTF cannot say. Classes and their parameters pass through as they stand;
// names and indices that refer to other things of the scene are checked here.
#include <algorithm>

#include "host/gltf/import.h"
#include "host/gltf/light_layers.h"
#include "host/gltf/splines.h"

namespace etendue {
namespace {

using nlohmann::json;

// {"class": NAME, parameter: value, …}; `names` are members that are not parameters. A parameter that is an
// object with an "index" is a textureInfo.
ObjectDescription object_description(GltfImport& import, const JsonAt& at,
                                     std::initializer_list<const char*> names) {
    require_object(at);
    ObjectDescription result;
    result.class_name = text_value(member(at, "class"));
    if (result.class_name.empty()) fail_at(member(at, "class"), "is empty; must name a class");
    result.where = at.pointer;
    for (auto i = at->begin(); i != at->end(); ++i) {
        const std::string& key = i.key();
        if (key == "class" || key == "extras") continue;
        if (std::any_of(names.begin(), names.end(), [&](const char* name) { return key == name; })) continue;
        bool is_texture = i->is_object() && i->contains("index");
        result.parameters[key] = is_texture ? read_texture_info(import, member(at, key)) : *i;
    }
    return result;
}

// What a receiver of class `surface` lies on: `mesh` or `node`, by name or, as glTF has it, by index. One
// word for all of these: a name, or the pointer of the object.
void name_watched(const JsonAt& at, ObjectDescription& receiver) {
    json& parameters = receiver.parameters;
    if (parameters.contains("node") && parameters.contains("mesh"))
        fail_at(at, "has a mesh and a node; allowed: one of the two");
    for (const auto& [key, array] : {std::pair("mesh", "/meshes/"), {"node", "/nodes/"}}) {
        if (!parameters.contains(key)) continue;
        json value = parameters[key];
        parameters.erase(key);
        parameters["mesh"] = value.is_number_unsigned() ? json(array + value.dump()) : value;
    }
}

void load_spectra(GltfImport& import, const JsonAt& optics) {
    for (size_t i = 0; i < array_size(optics, "spectra"); ++i) {
        JsonAt at = element(member(optics, "spectra"), i);
        std::string name = text_value(member(at, "name"));
        json value = *at;
        value.erase("name");
        value.erase("extras");
        if (value.contains("value")) {
            if (value.size() > 1) fail_at(at, "has a \"value\" and other members; must have one of the two");
            json inner = value["value"];
            value = std::move(inner);
        }
        if (value.is_object() && value.empty()) fail_at(at, "has no value");
        if (!import.scene.spectra.emplace(name, std::move(value)).second)
            fail_at(at, "has the name '{}', which another spectrum has", name);
    }
}

void load_media(GltfImport& import, const JsonAt& optics) {
    for (size_t i = 0; i < array_size(optics, "media"); ++i) {
        JsonAt at = element(member(optics, "media"), i);
        std::string name = text_value(member(at, "name"));
        if (name.empty()) fail_at(member(at, "name"), "is empty; a medium needs a name");
        for (const MediumDescription& other : import.scene.media)
            if (other.name == name) fail_at(at, "has the name '{}', which another medium has", name);
        import.scene.media.push_back({name, object_description(import, at, {"name"})});
    }
}

void load_class_files(GltfImport& import, const JsonAt& optics) {
    for (size_t i = 0; i < array_size(optics, "class_files"); ++i) {
        JsonAt at = element(member(optics, "class_files"), i);
        only_members(at, {"interface", "file"});
        JsonAt interface_at = member(at, "interface"), file = member(at, "file");
        const std::string& interface = text_value(interface_at);
        const auto known = {"surface", "geometry", "light", "receiver", "medium", "phase"};
        if (std::none_of(known.begin(), known.end(), [&](const char* name) { return interface == name; }))
            fail_at(interface_at, "is '{}'; must be {}", interface, fmt::join(known, ", "));
        import.scene.class_files.push_back({interface, resolve_uri(import, file), at.pointer});
    }
}

struct QuantityName {
    const char* name;
    EmissionDescription::Quantity quantity;
};
const QuantityName quantity_names[] = {{"radiance", EmissionDescription::Quantity::radiance},
                                       {"luminance", EmissionDescription::Quantity::luminance},
                                       {"power", EmissionDescription::Quantity::power},
                                       {"flux", EmissionDescription::Quantity::flux}};

// "stokes" of light: [1, S1, S2, S3]. Returns S1 to S3.
glm::dvec3 stokes_value(const JsonAt& object) {
    const std::optional<JsonAt> at = find(object, "stokes");
    if (!at) return glm::dvec3(0);
    const std::vector<double> s = number_array(*at, 4, -1, 1);
    const glm::dvec3 polarized(s[1], s[2], s[3]);
    if (s[0] != 1 || glm::length(polarized) > 1 + 1e-6)
        fail_at(*at, "must be [1, S1, S2, S3] with S1² + S2² + S3² at most 1");
    return polarized;
}

EmissionDescription read_emission(const JsonAt& at) {
    only_members(at, {"radiance", "luminance", "power", "flux", "spectrum", "stokes"});
    EmissionDescription emission;
    emission.where = at.pointer;
    size_t count = 0;
    for (const QuantityName& q : quantity_names)
        if (std::optional<JsonAt> value = find(at, q.name)) {
            emission.quantity = q.quantity;
            emission.value = **value;
            ++count;
        }
    if (count != 1)
        fail_at(at, "names {} quantities; must name one of radiance, luminance, power, flux", count);
    if (std::optional<JsonAt> spectrum = find(at, "spectrum")) emission.spectrum = **spectrum;
    emission.stokes = stokes_value(at);
    return emission;
}

// A thin film says what is below it by its own parameters, or by a "base", a surface: a conductor gives eta
// and k, a dielectric the medium inside; principled covers the rest (diffuse, woven, clear), by its
// iridescence.
void put_film_on_base(GltfImport& import, const JsonAt& at, MaterialDescription& material) {
    const ObjectDescription base = object_description(import, at, {});
    json& film = material.surface.parameters;
    json below = base.parameters;
    if (base.class_name == "principled") {
        const json ior = film.value("ior", json(1.33));
        if (!ior.is_number()) fail_at(at, "needs a film whose ior is a number");
        below["iridescence"] = 1;
        below["iridescence_ior"] = ior;
        below["iridescence_thickness_minimum"] = 0;
        below["iridescence_thickness_maximum"] = film.value("thickness", json(300));
        if (film.contains("thickness_texture"))
            below["iridescence_thickness_texture"] = film["thickness_texture"];
        for (const char* name : {"ior", "thickness", "thickness_texture"}) film.erase(name);
        material.surface.class_name = "principled";
    } else if (base.class_name == "conductor") {
        if (!below.contains("eta")) below["eta"] = 0;
        if (!below.contains("k")) below["k"] = 1;
    } else if (base.class_name == "dielectric") {
        take_medium_from_ior(import, material, at, below);
        if (below.contains("ior")) fail_at(member(at, "ior"), "is that of the medium named");
    } else {
        fail_at(member(at, "class"), "is '{}'; must be conductor, dielectric or principled", base.class_name);
    }
    for (auto i = below.begin(); i != below.end(); ++i)
        if (!film.emplace(i.key(), i.value()).second)
            fail_at(at, "has a \"{}\", and so has the film; must be named once", i.key());
}

}  // namespace

void load_root_optics(GltfImport& import) {
    std::optional<JsonAt> optics = find_extension(import.root, "ETD_optics");
    if (!optics) return;
    only_members(*optics, {"spectra", "media", "environment", "class_files", "layers"});
    load_class_files(import, *optics);
    load_spectra(import, *optics);
    load_media(import, *optics);
    if (std::optional<JsonAt> layers = find_array(*optics, "layers"))
        import.scene.layers = read_layers(*layers);
    if (std::optional<JsonAt> environment = find_object(*optics, "environment"))
        import.scene.environment = object_description(import, *environment, {});
}

// A Mueller surface has one matrix, and how it stands, or a file of them.
void choose_mueller_form(const JsonAt& at, ObjectDescription& surface) {
    const bool has_file = surface.parameters.contains("file");
    if (has_file == surface.parameters.contains("matrix"))
        fail_at(at, "has {} matrix {} file; allowed: one of them", has_file ? "both" : "neither",
                has_file ? "and" : "nor");
    if (has_file && surface.parameters.size() > 1) fail_at(at, "has a file; allowed beside it: nothing else");
    if (has_file) surface.class_name = "mueller_table";
}

void check_grating_form(const JsonAt& at, const ObjectDescription& surface) {
    const bool has_table = surface.parameters.contains("efficiencies");
    if (has_table == surface.parameters.contains("orders"))
        fail_at(at, "has {} orders {} efficiencies; allowed: one of them", has_table ? "both" : "neither",
                has_table ? "and" : "nor");
}

void read_material_optics(GltfImport& import, const JsonAt& optics, MaterialDescription& material) {
    only_members(optics, {"surface", "inside", "outside", "priority", "emission"});
    material.inside = text(optics, "inside");
    material.outside = text(optics, "outside");
    if (std::optional<JsonAt> surface = find_object(optics, "surface")) {
        const bool is_film = text(*surface, "class") == "thin_film";
        material.surface = is_film ? object_description(import, *surface, {"base"})
                                   : object_description(import, *surface, {});
        if (std::optional<JsonAt> base = is_film ? find_object(*surface, "base") : std::nullopt)
            put_film_on_base(import, *base, material);
        if (material.surface.class_name == "mueller") choose_mueller_form(*surface, material.surface);
        if (material.surface.class_name == "grating") check_grating_form(*surface, material.surface);
    }
    if (std::optional<JsonAt> priority = find(optics, "priority"))
        material.priority = uint32_t(integer_value(*priority, 1));
    if (std::optional<JsonAt> emission = find_object(optics, "emission"))
        material.emission = read_emission(*emission);
}

void check_media_names(const GltfImport& import) {
    std::set<std::string> names;
    for (const MediumDescription& medium : import.scene.media) names.insert(medium.name);
    for (size_t i = 0; i < array_size(import.root, "materials"); ++i) {
        std::optional<JsonAt> optics = find_extension(document_element(import, "materials", i), "ETD_optics");
        if (!optics) continue;
        for (const char* side : {"inside", "outside"})
            if (std::optional<JsonAt> at = find(*optics, side); at && !names.contains(text_value(*at)))
                fail_at(*at, "there is no medium '{}'; /extensions/ETD_optics/media defines media",
                        text_value(*at));
    }
}

void read_node_optics(GltfImport& import, const JsonAt& node, const glm::dmat4& world_from_local) {
    std::optional<JsonAt> optics = find_extension(node, "ETD_optics");
    if (!optics) return;
    only_members(*optics, {"geometry", "light", "receiver", "element"});
    if ((*optics)->empty()) return;
    if (!is_invertible(world_from_local)) {
        warn(import, node, "has a transform that squashes space flat: its objects are left out");
        return;
    }
    auto place = [&](const char* key, std::vector<PlacedObject>& objects) {
        std::optional<JsonAt> at = find_object(*optics, key);
        if (!at) return;
        const bool is_geometry = &objects == &import.scene.shapes,
                   is_receiver = &objects == &import.scene.receivers,
                   is_light = &objects == &import.scene.lights;
        const bool has_stokes = is_receiver || is_light;
        const auto read_stokes = [&](PlacedObject& object) {
            if (is_receiver) object.wants_stokes = boolean(*at, "stokes", false);
            if (is_light) object.stokes = stokes_value(*at);
        };
        // A camera or lamp of glTF has been placed already: what is said here is said of that.
        const bool is_placed = (is_receiver && node->contains("camera")) ||
                               (is_light && (find_extension(node, "KHR_lights_punctual") ||
                                             find_extension(node, "EXT_lights_ies")));
        if (is_placed && !(*at)->contains("class")) {
            only_members(*at, {"stokes"});
            read_stokes(objects.back());
            return;
        }
        std::string name = text(node, "name", node.pointer);
        PlacedObject object{name,
                            is_geometry  ? object_description(import, *at, {"material"})
                            : has_stokes ? object_description(import, *at, {"stokes"})
                                         : object_description(import, *at, {}),
                            world_from_local};
        read_stokes(object);
        if (is_geometry && object.object.class_name == "microstructure")
            name_parts(import, *at, object.object.parameters);
        if (is_geometry && object.object.class_name == "nurbs_patch") {
            object.object.class_name = "bezier_patch";
            object.object.parameters = {{"control_points", patches_of_spline(*at)}};
        }
        if (is_receiver && object.object.class_name == "surface") name_watched(*at, object.object);
        if (is_light && (*optics)->contains("geometry"))
            object.shape = uint32_t(import.scene.shapes.size() - 1);
        if (is_geometry) {
            auto material = index(*at, "material", array_size(import.root, "materials"), "/materials");
            object.material = material ? *material : default_material(import);
        }
        objects.push_back(std::move(object));
    };
    place("geometry", import.scene.shapes);
    place("light", import.scene.lights);
    place("receiver", import.scene.receivers);
    if (std::optional<JsonAt> at = find_object(*optics, "element"))
        read_element(import, *at, text(node, "name", node.pointer), world_from_local);
}

}  // namespace etendue
