// Animations at one moment: what they say of translation, rotation, scale and morph weights of nodes
// (glTF 2.0, section 3.11 and appendix C).
#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "host/gltf/import.h"

namespace etendue {
namespace {

using glm::dquat;
using glm::dvec3;

enum class Interpolation { step, linear, cubic };

// Where a moment lies among the keys: between `key` and the next one, `part` of the way; before the first and
// behind the last key the keys themselves.
struct KeyPosition {
    size_t key = 0;
    double part = 0, seconds = 1;  // seconds: from the key to the next
};

std::vector<float> key_times(GltfImport& import, const JsonAt& input) {
    const Accessor& accessor = accessor_at(import, input);
    if (accessor.type != "SCALAR" || accessor.component != Component::f32)
        fail_at(input, "must be an accessor of type SCALAR with floats (5126): seconds");
    std::vector<float> times(accessor.count);
    read_floats(accessor, 0, times.size(), times.data(), 1);
    for (size_t i = 0; i < times.size(); ++i)
        if (!(std::fabs(times[i]) <= 1e9f) || (i > 0 && !(times[i] > times[i - 1])))
            fail_at(input, "has the time {} at position {}; must be finite and rise", times[i], i);
    return times;
}

KeyPosition position_of(const std::vector<float>& times, double seconds) {
    const size_t after = size_t(std::upper_bound(times.begin(), times.end(), float(seconds)) - times.begin());
    if (after == 0) return {};
    if (after == times.size()) return {times.size() - 1, 0, 1};
    const double span = double(times[after]) - times[after - 1];
    return {after - 1, std::clamp((seconds - times[after - 1]) / span, 0.0, 1.0), span};
}

Interpolation interpolation_of(const JsonAt& sampler) {
    const std::string name = text(sampler, "interpolation", "LINEAR");
    if (name == "LINEAR") return Interpolation::linear;
    if (name == "STEP") return Interpolation::step;
    if (name == "CUBICSPLINE") return Interpolation::cubic;
    fail_at(member(sampler, "interpolation"), "is '{}'; must be LINEAR, STEP or CUBICSPLINE", name);
}

// The keys' values around a moment: `size` numbers each; tangents of splines are per second.
struct Keys {
    std::vector<float> from, to, out_tangent, in_tangent;
    Interpolation interpolation = Interpolation::linear;
    KeyPosition at;
};

// `size`: numbers of a key. Weights are scalars, several a key.
Keys read_keys(GltfImport& import, const JsonAt& sampler, const char* type, size_t size, double seconds) {
    Keys keys;
    keys.interpolation = interpolation_of(sampler);
    const std::vector<float> times = key_times(import, member(sampler, "input"));
    keys.at = position_of(times, seconds);
    JsonAt output = member(sampler, "output");
    const Accessor& accessor = accessor_at(import, output);
    const bool is_float = accessor.component == Component::f32;
    if (accessor.type != type || !(is_float || accessor.normalized))
        fail_at(output, "must be an accessor of type {} with floats or normalised integers", type);
    const size_t parts = keys.interpolation == Interpolation::cubic ? 3 : 1;
    const size_t elements = size / accessor.components;  // of a key
    if (accessor.count != times.size() * parts * elements)
        fail_at(output, "has {} elements; its {} keys take {}", accessor.count, times.size(),
                times.size() * parts * elements);
    const auto read = [&](size_t key, size_t part) {
        std::vector<float> values(size);
        read_floats(accessor, (key * parts + part) * elements, elements, values.data(), accessor.components);
        for (const float v : values)
            if (!(std::fabs(v) <= max_coordinate))
                fail_at(output, "has a value that is not finite, or beyond {:g}", max_coordinate);
        return values;
    };
    const size_t next = std::min(keys.at.key + 1, times.size() - 1);
    keys.from = read(keys.at.key, parts / 2), keys.to = read(next, parts / 2);
    if (parts == 3) keys.out_tangent = read(keys.at.key, 2), keys.in_tangent = read(next, 0);
    return keys;
}

std::vector<double> value_of(const Keys& keys) {
    const double t = keys.interpolation == Interpolation::step ? 0 : keys.at.part;
    std::vector<double> value(keys.from.size());
    for (size_t i = 0; i < value.size(); ++i) {
        value[i] = (1 - t) * keys.from[i] + t * keys.to[i];
        if (keys.interpolation != Interpolation::cubic) continue;
        // Hermite's spline: appendix C.4.
        const double t2 = t * t, t3 = t2 * t;
        value[i] = (2 * t3 - 3 * t2 + 1) * keys.from[i] +
                   keys.at.seconds * (t3 - 2 * t2 + t) * keys.out_tangent[i] +
                   (3 * t2 - 2 * t3) * keys.to[i] + keys.at.seconds * (t3 - t2) * keys.in_tangent[i];
    }
    return value;
}

dquat quaternion(const std::vector<float>& v) { return dquat(v[3], v[0], v[1], v[2]); }

dquat rotation_of(const JsonAt& sampler, const Keys& keys) {
    dquat q;
    if (keys.interpolation == Interpolation::cubic) {
        const std::vector<double> v = value_of(keys);
        q = dquat(v[3], v[0], v[1], v[2]);
    } else {
        const dquat from = quaternion(keys.from), to = quaternion(keys.to);
        if (!(glm::length(from) > 1e-6 && glm::length(to) > 1e-6))
            fail_at(member(sampler, "output"), "has a quaternion of zero length; must have length 1");
        const double t = keys.interpolation == Interpolation::step ? 0 : keys.at.part;
        q = glm::slerp(glm::normalize(from), glm::normalize(to), t);  // the shorter way: appendix C.5
    }
    if (!(glm::length(q) > 1e-6))
        fail_at(member(sampler, "output"), "turns by a quaternion of zero length there; must have length 1");
    return glm::normalize(q);
}

void apply_channel(GltfImport& import, const JsonAt& sampler, const std::string& path, uint32_t n,
                   NodePose& pose) {
    const double seconds = *import.options.seconds;
    if (path == "rotation") {
        pose.rotation = rotation_of(sampler, read_keys(import, sampler, "VEC4", 4, seconds));
    } else if (path == "weights") {
        const size_t targets = morph_targets(import, document_element(import, "nodes", n));
        if (targets == 0) return;
        pose.weights = value_of(read_keys(import, sampler, "SCALAR", targets, seconds));
    } else {
        const std::vector<double> v = value_of(read_keys(import, sampler, "VEC3", 3, seconds));
        (path == "scale" ? pose.scale : pose.translation) = dvec3(v[0], v[1], v[2]);
    }
}

bool is_set(const NodePose& pose, const std::string& path) {
    return path == "rotation"  ? pose.rotation.has_value()
           : path == "weights" ? pose.weights.has_value()
           : path == "scale"   ? pose.scale.has_value()
                               : pose.translation.has_value();
}

// Of two animations that move the same thing the first in the file counts.
void apply_animation(GltfImport& import, const JsonAt& animation) {
    std::vector<std::pair<uint32_t, std::string>> moved;  // by this animation
    std::vector<NodePose> next = import.poses;
    JsonAt channels = member(animation, "channels"), samplers = member(animation, "samplers");
    require_array(channels), require_array(samplers);
    for (size_t i = 0; i < channels->size(); ++i) {
        JsonAt channel = element(channels, i), target = member(channel, "target");
        JsonAt path_at = member(target, "path");
        const std::string& path = text_value(path_at);
        std::optional<uint32_t> node = index(target, "node", import.poses.size(), "/nodes");
        if (path == "pointer" || !node) continue;  // KHR_animation_pointer is read past
        if (path != "translation" && path != "rotation" && path != "scale" && path != "weights")
            fail_at(path_at, "is '{}'; must be translation, rotation, scale or weights", path);
        const uint32_t sampler = index_value(member(channel, "sampler"), samplers->size(), "its samplers");
        if (is_set(import.poses[*node], path)) {
            warn_once(import, "animations", channel,
                      "moves what an animation before it moves: the first of them counts");
            continue;
        }
        apply_channel(import, element(samplers, sampler), path, *node, next[*node]);
    }
    import.poses = std::move(next);
}

// The last key of an animation; 0 where it has none that can be read.
double end_of(const GltfImport& import, const JsonAt& animation) {
    double end = 0;
    for (size_t i = 0; i < array_size(animation, "samplers"); ++i) {
        JsonAt sampler = element(member(animation, "samplers"), i);
        const std::optional<JsonAt> input = find(sampler, "input");
        if (!input) continue;
        const Accessor& accessor = accessor_at(import, *input);
        if (accessor.type != "SCALAR" || accessor.component != Component::f32) continue;
        float last = 0;
        read_floats(accessor, accessor.count - 1, 1, &last, 1);
        if (last > 0 && last <= 1e9f) end = std::max(end, double(last));
    }
    return end;
}

}  // namespace

void pose_nodes(GltfImport& import) {
    import.poses.resize(array_size(import.root, "nodes"));
    for (size_t i = 0; i < array_size(import.root, "animations"); ++i) {
        JsonAt animation = document_element(import, "animations", i);
        import.scene.animation_seconds = std::max(import.scene.animation_seconds, end_of(import, animation));
        if (import.options.seconds) apply_animation(import, animation);
    }
}

}  // namespace etendue
