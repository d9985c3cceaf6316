#include "host/render/light_layers.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "host/error.h"
#include "host/render/media_places.h"

namespace etendue {
namespace {

using Names = std::set<std::string>;

// Bits of a history that count events of these kinds at these objects.
struct Field {
    Names events, objects;
    uint32_t first = 0, bits = 1;
    bool counts(const char* event, const Names& at) const {
        const bool is_there = objects.empty() || std::any_of(at.begin(), at.end(), [&](const std::string& n) {
                                  return objects.contains(n);
                              });
        return is_there && (events.empty() || events.contains(event));
    }
};

struct Fields {
    std::vector<Field> all;

    Field& of(const LayerCondition& c) {
        for (Field& field : all)
            if (field.events == c.events && field.objects == c.objects) return field;
        return all.emplace_back(Field{c.events, c.objects});
    }
    // Sets where the fields stand.
    void place() {
        uint32_t next = 0;
        for (Field& field : all) field.first = std::exchange(next, next + field.bits);
        if (next > 32)
            fail_input(
                "layers: paths carry 32 bits, and the conditions take {}: one for each that differs in "
                "events "
                "or objects, and one for each number up to the largest that they count to",
                next);
    }
    uint32_t history(const char* event, const Names& at) const {
        uint32_t history = 0;
        for (const Field& field : all)
            if (field.counts(event, at)) history |= 1u << field.first;
        return history;
    }
};

// Bits that must be set, and that must not.
glm::uvec2 test_of(const LightLayer& layer, Fields& fields) {
    glm::uvec2 test{0};
    for (const LayerCondition& c : layer.conditions) {
        const uint32_t first = fields.of(c).first;
        if (c.least > 0) test.x |= 1u << (first + c.least - 1);
        if (c.most) test.y |= 1u << (first + *c.most);
    }
    return test;
}

// Nodes without a name are called by their place in the file.
std::string lamp_name(const Scene& scene, size_t light) {
    const std::string& shape = scene.light_shapes[light];
    return shape.empty() || shape.starts_with("/nodes/") ? scene.light_names[light] : shape;
}

void check_names(const Scene& scene, const std::vector<LightLayer>& layers) {
    Names known;
    for (const auto* names :
         {&scene.material_names, &scene.placed_names, &scene.light_names, &scene.light_shapes})
        known.insert(names->begin(), names->end());
    for (const auto& [ref, name] : scene.medium_names) known.insert(name);
    known.erase("");
    for (const LightLayer& layer : layers)
        for (const LayerCondition& c : layer.conditions)
            for (const std::string& name : c.objects)
                if (!known.contains(name))
                    fail_input("layer '{}': the scene has no lamp, node, material or medium '{}'; it has {}",
                               layer.name, name, fmt::join(known, ", "));
}

}  // namespace

std::vector<LightLayer> light_groups(const Scene& scene) {
    std::vector<LightLayer> groups;
    for (size_t i = 0; i < scene.light_names.size(); ++i) {
        const std::string name = lamp_name(scene, i);
        const auto is_it = [&](const LightLayer& group) { return group.name == name; };
        if (std::none_of(groups.begin(), groups.end(), is_it))
            groups.push_back({name, {{{"emitted"}, {name}, 1, {}}}});
    }
    std::sort(groups.begin(), groups.end(),
              [](const LightLayer& a, const LightLayer& b) { return a.name < b.name; });
    return groups;
}

LightLayers::LightLayers(Device& device, const Scene& scene, const std::vector<LightLayer>& layers) {
    if (layers.empty()) return;
    check_names(scene, layers);
    Fields fields;
    for (const LightLayer& layer : layers)
        for (const LayerCondition& c : layer.conditions) {
            Field& field = fields.of(c);
            field.bits = std::max({field.bits, c.least, c.most ? *c.most + 1 : 0});
        }
    fields.place();
    for (const Field& field : fields.all) {
        lowest_bits_ |= 1u << field.first;
        field_bits_ = std::max(field_bits_, field.bits);
    }
    std::vector<glm::uvec2> tests;
    for (const LightLayer& layer : layers) {
        names_.push_back(layer.name);
        tests.push_back(test_of(layer, fields));
    }

    std::vector<uint32_t> lights;
    for (size_t i = 0; i < scene.light_names.size(); ++i)
        lights.push_back(fields.history("emitted", {scene.light_names[i], scene.light_shapes[i]}));
    // Whatever happens to it, bits that are set stay so.
    const bool leaves_none = std::all_of(lights.begin(), lights.end(), [&](uint32_t light) {
        return std::any_of(tests.begin(), tests.end(),
                           [&](const glm::uvec2& test) { return test.y == 0 && (light & test.x) == test.x; });
    });
    if (!leaves_none || lights.empty()) names_.push_back("rest");
    if (names_.size() > most_light_layers)
        fail_input("layers: {} of them; allowed: {}, with the rest", names_.size(), most_light_layers);

    std::vector<glm::uvec3> events = {glm::uvec3(0)};
    for (size_t i = 0; i < scene.placed_names.size(); ++i) {
        const Names at = {scene.placed_names[i], scene.placed_materials[i]};
        events.push_back({fields.history("reflected", at), fields.history("refracted", at),
                          fields.history("straight", at)});
    }
    std::vector<uint32_t> objects;
    for (const uint32_t placed : *scene.placed) objects.push_back(placed + 1);
    const MediaPlaces places(scene);
    std::vector<uint32_t> media(1 + places.count(), 0);
    media[0] = places.stride;
    for (const auto& [ref, name] : scene.medium_names)
        media[1 + places.of(ref)] = fields.history("scattered", {name});

    tests_ = create_buffer(device, tests, "LayerTests");
    lights_ = create_buffer(device, lights, "LayerLights");
    objects_ = create_buffer(device, objects, "LayerObjects");
    events_ = create_buffer(device, events, "LayerEvents");
    media_ = create_buffer(device, media, "LayerMedia");
}

std::string LightLayers::defines() const {
    if (names_.empty()) return "";
    return fmt::format(
        "#define HAS_LIGHT_LAYERS 1\n#define LIGHT_LAYERS {}\n#define HISTORY_BITS {}\n"
        "#define HISTORY_LOWEST_BITS {}u\n",
        names_.size(), field_bits_, field_bits_ > 1 ? lowest_bits_ : 0);
}

BufferTable LightLayers::buffers() const {
    if (names_.empty()) return {};
    return {{"LayerTests", &tests_},
            {"LayerLights", &lights_},
            {"LayerObjects", &objects_},
            {"LayerEvents", &events_},
            {"LayerMedia", &media_}};
}

}  // namespace etendue
