#include "host/scene/live_scene.h"

#include <algorithm>

#include "host/error.h"
#include "host/scene/live_places.h"

namespace etendue {
namespace {

using nlohmann::json;
using Part = LiveObject::Part;
using Quantity = EmissionDescription::Quantity;

constexpr uint32_t most_priority = 1000000;
constexpr size_t most_places = 1000;  // that are listed

struct QuantityInfo {
    Quantity quantity;
    const char *name, *unit, *text;
};
constexpr QuantityInfo quantities[] = {
    {Quantity::radiance, "radiance", "cd/m²", "Radiance; 1 = 1 cd/m² for white."},
    {Quantity::luminance, "luminance", "cd/m²", "Luminance; the spectrum gives the colour."},
    {Quantity::power, "power", "lm", "Of everything that has the material; the spectrum gives the colour."},
    {Quantity::flux, "flux", "lm", "Of everything that has the material; the spectrum gives the colour."}};

Parameter spectral_parameter(const char* name, const char* unit, const char* text) {
    Parameter p;
    p.member.name = name, p.member.type = "SpectrumRef";
    p.from_scene = true;
    p.lo = 0, p.lo_open = false;
    p.unit = unit, p.text = text;
    return p;
}

LiveObject emission_object(const MaterialDescription& material, uint32_t index) {
    LiveObject object{Part::emission, index, material.name, "", {}};
    const EmissionDescription emission = material.emission.value_or(EmissionDescription{});
    for (const QuantityInfo& q : quantities)
        if (q.quantity == emission.quantity)
            object.parameters.push_back({spectral_parameter(q.name, q.unit, q.text), emission.value});
    object.parameters.push_back(
        {spectral_parameter("spectrum", "", "Multiplies the value."), emission.spectrum});
    return object;
}

// Media by their names: type "medium".
LiveObject boundary_object(const MaterialDescription& material, uint32_t index) {
    LiveObject object{Part::boundary, index, material.name, "", {}};
    const auto add = [&](const char* name, const char* type, const char* text, json value) {
        Parameter p;
        p.member.name = name, p.member.type = type, p.text = text, p.from_scene = true;
        object.parameters.push_back({p, std::move(value)});
    };
    add("inside", "medium", "Medium behind the surface; none = vacuum.", material.inside);
    add("outside", "medium", "Medium before the surface; none = vacuum.", material.outside);
    add("priority", "uint", "Of the body among those that overlap it; 0 = none.", material.priority);
    object.parameters.back().info.lo = 0, object.parameters.back().info.hi = most_priority;
    return object;
}

void set_boundary(MaterialDescription& material, const std::string& name, const json& value) {
    if (name == "priority") {
        const bool whole = value.is_number_integer() && value >= 0 && value <= most_priority;
        if (!value.is_null() && !whole)
            fail_input("priority {}: must be a whole number within [0, {}]", value.dump(), most_priority);
        material.priority = value.is_null() ? 0 : value.get<uint32_t>();
    } else if (name == "inside" || name == "outside") {
        if (!value.is_null() && !value.is_string())
            fail_input("{} {}: must name a medium", name, value.dump());
        (name == "inside" ? material.inside : material.outside) =
            value.is_null() ? "" : value.get<std::string>();
    } else {
        fail_input("there is no {}; allowed: inside, outside, priority", name);
    }
}

void set_emission(EmissionDescription& emission, const std::string& name, const json& value) {
    if (name == "spectrum") {
        emission.spectrum = value;
        return;
    }
    const auto q =
        std::find_if(std::begin(quantities), std::end(quantities), [&](auto& q) { return name == q.name; });
    if (q == std::end(quantities))
        fail_input("emission: there is no {}; allowed: radiance, luminance, power, flux, spectrum", name);
    emission.quantity = q->quantity;
    emission.value = value.is_null() ? json(0.0) : value;
}

LiveObject described(ClassRegistry& registry, Part part, uint32_t index, const std::string& name,
                     const std::string& class_name, const json& parameters) {
    LiveObject object{part, index, name, class_name, {}};
    const ClassInfo* info = registry.find(interface_of(part), class_name);
    for (const Parameter& p : info->parameters)
        if (p.from_scene && p.member.type != "PhaseRef")
            object.parameters.push_back({p, parameters.value(p.member.name, p.default_value)});
    return object;
}

// The parameter of a medium that is a phase function; null = its class has none.
const Parameter* phase_parameter(ClassRegistry& registry, const MediumDescription& medium) {
    for (const Parameter& p : registry.find(Interface::medium, medium.medium.class_name)->parameters)
        if (p.member.type == "PhaseRef") return &p;
    return nullptr;
}

// {"class": name, parameter: value, …} of a medium's phase function.
json phase_value(const MediumDescription& medium, const Parameter& p) {
    return medium.medium.parameters.value(p.member.name, p.default_value);
}

ObjectDescription& edited(SceneObjects& scene, const LiveObject& object) {
    switch (object.part) {
        case Part::surface:
            return scene.materials.at(object.index).surface;
        case Part::medium:
            return scene.media.at(object.index).medium;
        case Part::geometry:
            return scene.shapes.at(object.index).object;
        case Part::light:
            return scene.lights.at(object.index).object;
        case Part::environment:
            return scene.environment.value();
        default:
            fail_input("this object has no such value");
    }
}

bool same_receivers(const SceneObjects& a, const SceneObjects& b) {
    return std::equal(a.receivers.begin(), a.receivers.end(), b.receivers.begin(), b.receivers.end(),
                      [](const PlacedObject& x, const PlacedObject& y) {
                          return x.name == y.name && x.object.class_name == y.object.class_name &&
                                 x.object.parameters == y.object.parameters &&
                                 x.wants_stokes == y.wants_stokes && x.world_from_local == y.world_from_local;
                      });
}

}  // namespace

Interface interface_of(Part part) {
    switch (part) {
        case Part::surface:
            return Interface::surface;
        case Part::medium:
            return Interface::medium;
        case Part::phase:
            return Interface::phase;
        case Part::geometry:
            return Interface::geometry;
        case Part::receiver:
            return Interface::receiver;
        default:
            return Interface::light;
    }
}

LiveScene::LiveScene(Device& device, std::filesystem::path file, SceneOptions options, ImportOptions import)
    : device_(&device), file_(std::move(file)), options_(std::move(options)) {
    compile_file(import, std::make_shared<SceneMemory>());
    accept();
}

std::shared_ptr<Scene> LiveScene::compile_file(const ImportOptions& import,
                                               std::shared_ptr<SceneMemory> memory) {
    candidate_.reset();
    SceneDescription description = import_gltf(file_, import);
    auto next = std::make_shared<Scene>(compile_scene(*device_, description, options_, *memory));
    if (scene_ && same_receivers(description, description_)) keep_receivers(*next, scene_->receivers);
    candidate_ = Candidate{next, {}, std::move(description), import, std::move(memory)};
    return next;
}

std::shared_ptr<Scene> LiveScene::compile(SceneObjects objects) {
    candidate_.reset();
    SceneObjects& current = description_;  // meshes and images are not copied
    std::swap(current, objects);
    std::shared_ptr<Scene> next;
    try {
        next = std::make_shared<Scene>(compile_scene(*device_, description_, options_, *memory_));
    } catch (...) {
        std::swap(current, objects);
        throw;
    }
    std::swap(current, objects);
    keep_receivers(*next, scene_->receivers);
    candidate_ = Candidate{next, std::move(objects), {}, import_, memory_};
    return next;
}

// Where they were moved to.
void LiveScene::keep_receivers(Scene& next, const std::vector<Receiver>& receivers) {
    for (size_t i = 0; i < std::min(receivers.size(), next.receivers.size()); ++i) {
        const Receiver &now = receivers[i], &fresh = next.receivers[i];
        if (now.world_from_local != fresh.world_from_local || now.parameters != fresh.parameters)
            move_receiver(next, i, now.world_from_local, now.parameters);
    }
}

void LiveScene::move_to(const std::function<Device&()>& next_device) {
    const std::vector<Receiver> receivers = scene_->receivers;
    candidate_.reset();
    scene_.reset();
    memory_ = std::make_shared<SceneMemory>();
    device_ = &next_device();
    scene_ = std::make_shared<Scene>(compile_scene(*device_, description_, options_, *memory_));
    keep_receivers(*scene_, receivers);
}

void LiveScene::accept() {
    if (!candidate_) return;
    if (candidate_->description)
        description_ = std::move(*candidate_->description);
    else
        static_cast<SceneObjects&>(description_) = std::move(candidate_->objects);
    import_ = candidate_->import;
    memory_ = std::move(candidate_->memory);
    scene_ = std::move(candidate_->scene);
    candidate_.reset();
}

std::vector<LiveObject> LiveScene::objects() const {
    ClassRegistry& registry = *scene_->registry;
    std::vector<LiveObject> objects;
    const auto add = [&](Part part, size_t index, const std::string& name, const ObjectDescription& object) {
        objects.push_back(
            described(registry, part, uint32_t(index), name, object.class_name, object.parameters));
    };
    for (size_t i = 0; i < description_.materials.size(); ++i) {
        const MaterialDescription& m = description_.materials[i];
        add(Part::surface, i, m.name, m.surface);
        objects.push_back(boundary_object(m, uint32_t(i)));
        if (m.priority == 0) objects.push_back(emission_object(m, uint32_t(i)));
    }
    for (size_t i = 0; i < description_.media.size(); ++i) {
        const MediumDescription& m = description_.media[i];
        add(Part::medium, i, m.name, m.medium);
        if (const Parameter* p = phase_parameter(registry, m)) {
            json value = phase_value(m, *p);
            const std::string class_name = value.at("class");
            value.erase("class");
            add(Part::phase, i, m.name, {class_name, value, ""});
        }
    }
    for (size_t i = 0; i < description_.shapes.size(); ++i)
        add(Part::geometry, i, description_.shapes[i].name, description_.shapes[i].object);
    for (size_t i = 0; i < description_.lights.size(); ++i)
        add(Part::light, i, description_.lights[i].name, description_.lights[i].object);
    for (size_t i = 0; i < std::min(place_count(description_), most_places); ++i)
        objects.push_back(described_place(description_, uint32_t(i)));
    if (description_.environment && options_.environment.empty())
        add(Part::environment, 0, "", *description_.environment);
    for (size_t i = 0; i < scene_->receivers.size(); ++i) {
        const Receiver& r = scene_->receivers[i];
        add(Part::receiver, i, r.name, {r.info->name, r.parameters, ""});
    }
    return objects;
}

std::shared_ptr<Scene> LiveScene::set_parameter(const LiveObject& object, const std::string& name,
                                                const json& value) {
    const auto set = [&](json& parameters) {
        if (value.is_null())
            parameters.erase(name);
        else
            parameters[name] = value;
    };
    if (object.part == Part::receiver) {
        Receiver& receiver = scene_->receivers.at(object.index);
        json parameters = receiver.parameters;
        set(parameters);
        move_receiver(*scene_, object.index, receiver.world_from_local, parameters);
        return scene_;
    }
    SceneObjects next = description_;
    if (object.part == Part::emission) {
        std::optional<EmissionDescription>& emission = next.materials.at(object.index).emission;
        if (!emission) emission.emplace();
        set_emission(*emission, name, value);
    } else if (object.part == Part::boundary) {
        set_boundary(next.materials.at(object.index), name, value);
    } else if (object.part == Part::place) {
        edit_place(next, object.index, name, value);
    } else if (object.part == Part::phase) {
        MediumDescription& medium = next.media.at(object.index);
        const Parameter& p = *phase_parameter(*scene_->registry, medium);
        json phase = phase_value(medium, p);
        set(phase);
        medium.medium.parameters[p.member.name] = phase;
    } else {
        set(edited(next, object).parameters);
    }
    if (object.part == Part::emission || object.part == Part::boundary)
        if (const char* wrong = priority_error(next.materials[object.index])) fail_input("{}", wrong);
    const bool is_body =
        object.part == Part::place && object.index < next.instances.size() + next.shapes.size();
    if (object.part == Part::geometry || is_body) options_.varying.insert("places");
    // A value that is changed once will be changed again: it costs one compilation, not one for each of the
    // values that kernels would otherwise take as constants.
    if (!object.class_name.empty())
        if (const ClassInfo* info = scene_->registry->find(interface_of(object.part), object.class_name))
            options_.varying.insert(member_path(*info, name));
    return compile(std::move(next));
}

std::shared_ptr<Scene> LiveScene::set_class(const LiveObject& object, const std::string& class_name,
                                            const json& parameters) {
    SceneObjects next = description_;
    if (object.part == Part::phase) {
        MediumDescription& medium = next.media.at(object.index);
        json phase = parameters;
        phase["class"] = class_name;
        medium.medium.parameters[phase_parameter(*scene_->registry, medium)->member.name] = phase;
    } else {
        ObjectDescription& description = edited(next, object);
        description.class_name = class_name;
        description.parameters = parameters;
    }
    return compile(std::move(next));
}

std::shared_ptr<Scene> LiveScene::place(const LiveObject& object, const glm::dmat4& world_from_local) {
    if (object.part == Part::receiver) {
        move_receiver(*scene_, object.index, world_from_local, scene_->receivers.at(object.index).parameters);
        return scene_;
    }
    SceneObjects next = description_;
    if (object.part == Part::geometry)
        next.shapes.at(object.index).world_from_local = world_from_local;
    else if (object.part == Part::light)
        next.lights.at(object.index).world_from_local = world_from_local;
    else
        fail_input("only geometries, lights and receivers have a place");
    if (object.part == Part::geometry) options_.varying.insert("places");
    return compile(std::move(next));
}

std::shared_ptr<Scene> LiveScene::reload() { return reload(import_); }

std::shared_ptr<Scene> LiveScene::reload(const ImportOptions& import) {
    if (import != import_) options_.varying.insert("places");  // what moves once will move again
    auto memory = std::make_shared<SceneMemory>();
    memory->registry = memory_->registry;
    memory->registry_key = memory_->registry_key;
    return compile_file(import, std::move(memory));
}

}  // namespace etendue
