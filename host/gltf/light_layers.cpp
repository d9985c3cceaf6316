#include "host/gltf/light_layers.h"

#include <algorithm>

namespace etendue {
namespace {

using nlohmann::json;

const std::initializer_list<const char*> kinds = {"emitted", "reflected", "refracted", "straight",
                                                  "scattered"};
// Channels of images that are called otherwise.
const std::set<std::string> taken_names = {"rest", "error", "albedo", "normal", "depth", "S0",
                                           "S1",   "S2",    "S3",     "R",      "G",     "B"};

std::set<std::string> names(const JsonAt& object, const char* key) {
    std::set<std::string> set;
    for (size_t i = 0; i < array_size(object, key); ++i)
        set.insert(text_value(element(member(object, key), i)));
    return set;
}

bool is_condition(const JsonAt& at) {
    return std::any_of(at->begin(), at->end(), [&](const json& value) {
        const auto is = [&](const char* key) { return at->contains(key) && &(*at)[key] == &value; };
        return is("events") || is("objects") || is("times") || is("least") || is("most");
    });
}

LayerCondition read_condition(const JsonAt& at) {
    LayerCondition condition;
    condition.events = names(at, "events"), condition.objects = names(at, "objects");
    for (const std::string& event : condition.events)
        if (std::find(kinds.begin(), kinds.end(), event) == kinds.end())
            fail_at(member(at, "events"), "has '{}'; allowed: {}", event, fmt::join(kinds, ", "));
    const auto count = [&](const char* key) -> std::optional<uint32_t> {
        const std::optional<JsonAt> value = find(at, key);
        if (!value) return {};
        return uint32_t(integer_value(*value, 0, most_counted_events));
    };
    const auto times = count("times"), least = count("least"), most = count("most");
    if (times && (least || most)) fail_at(at, "has times and least or most; times stands for both");
    condition.most = times ? times : most;
    condition.least = times ? *times : least.value_or(most ? 0 : 1);
    if (condition.most && *condition.most < condition.least)
        fail_at(at, "wants at least {} events and at most {}", condition.least, *condition.most);
    return condition;
}

void check_name(const JsonAt& at, const std::string& name, const std::vector<LightLayer>& others) {
    if (name.empty() || name.size() > 64 ||
        std::any_of(name.begin(), name.end(), [](unsigned char c) { return c < ' ' || c == 127; }))
        fail_at(at, "must be 1 to 64 bytes without control characters");
    if (taken_names.contains(name.substr(0, name.find('.'))))
        fail_at(at, "is '{}', which images call something else", name);
    for (const LightLayer& other : others)
        if (other.name == name) fail_at(at, "is '{}', as another layer's", name);
}

}  // namespace

std::vector<LightLayer> read_layers(const JsonAt& at) {
    require_array(at);
    std::vector<LightLayer> layers;
    for (size_t i = 0; i < at->size(); ++i) {
        const JsonAt layer = element(at, i);
        only_members(layer, {"name", "events", "objects", "times", "least", "most", "all", "without"});
        LightLayer read{text_value(member(layer, "name")), {}};
        check_name(member(layer, "name"), read.name, layers);
        if (is_condition(layer)) read.conditions.push_back(read_condition(layer));
        for (size_t k = 0; k < array_size(layer, "all"); ++k) {
            const JsonAt condition = element(member(layer, "all"), k);
            only_members(condition, {"events", "objects", "times", "least", "most"});
            read.conditions.push_back(read_condition(condition));
        }
        if (const auto without = names(layer, "without"); !without.empty())
            read.conditions.push_back({{}, without, 0, 0});
        if (read.conditions.empty())
            fail_at(layer, "says nothing of its light: allowed are events, objects, times, all, without");
        layers.push_back(std::move(read));
    }
    return layers;
}

json to_json(const std::vector<LightLayer>& layers) {
    json list = json::array();
    for (const LightLayer& layer : layers) {
        json all = json::array();
        for (const LayerCondition& c : layer.conditions) {
            all.push_back({{"events", c.events}, {"objects", c.objects}, {"least", c.least}});
            if (c.most) all.back()["most"] = *c.most;
        }
        list.push_back({{"name", layer.name}, {"all", all}});
    }
    return list;
}

}  // namespace etendue
