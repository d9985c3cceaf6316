#include "host/gltf/json.h"

#include <algorithm>
#include <cmath>

namespace etendue {
namespace {

// As a JSON pointer writes a member's name (RFC 6901, section 3).
std::string escaped(const std::string& key) {
    std::string result;
    for (char c : key) {
        if (c == '~')
            result += "~0";
        else if (c == '/')
            result += "~1";
        else
            result += c;
    }
    return result;
}

[[noreturn]] void fail_type(const JsonAt& at, const char* wanted) {
    fail_at(at, "is {} {}; must be {}", at->is_array() || at->is_object() ? "an" : "a", at->type_name(),
            wanted);
}

std::string range_text(double low, double high) {
    if (low == -DBL_MAX && high == DBL_MAX) return "a finite number";
    if (high == DBL_MAX) return fmt::format("at least {}", low);
    if (low == -DBL_MAX) return fmt::format("at most {}", high);
    return fmt::format("from {} to {}", low, high);
}

}  // namespace

std::string message_at(const JsonAt& at, const std::string& message) {
    return printable(
        fmt::format("{}: {}{}{}", *at.file, at.pointer, at.pointer.empty() ? "" : ": ", message));
}

JsonAt element(const JsonAt& array, size_t index) {
    return {&(*array)[index], array.pointer + "/" + std::to_string(index), array.file};
}

JsonAt member(const JsonAt& object, const std::string& key) {
    std::optional<JsonAt> found = find(object, key);
    if (!found) fail_at(object, "has no \"{}\", which is required", key);
    return *found;
}

std::optional<JsonAt> find(const JsonAt& object, const std::string& key) {
    require_object(object);
    auto found = object->find(key);
    if (found == object->end()) return std::nullopt;
    return JsonAt{&*found, object.pointer + "/" + escaped(key), object.file};
}

std::optional<JsonAt> find_object(const JsonAt& object, const std::string& key) {
    std::optional<JsonAt> found = find(object, key);
    if (found) require_object(*found);
    return found;
}

std::optional<JsonAt> find_array(const JsonAt& object, const std::string& key) {
    std::optional<JsonAt> found = find(object, key);
    if (found) require_array(*found);
    return found;
}

std::optional<JsonAt> find_extension(const JsonAt& object, const std::string& name) {
    std::optional<JsonAt> extensions = find_object(object, "extensions");
    return extensions ? find_object(*extensions, name) : std::nullopt;
}

size_t array_size(const JsonAt& object, const std::string& key) {
    std::optional<JsonAt> array = find_array(object, key);
    return array ? (*array)->size() : 0;
}

void require_object(const JsonAt& at) {
    if (!at->is_object()) fail_type(at, "an object");
}

void require_array(const JsonAt& at) {
    if (!at->is_array()) fail_type(at, "an array");
}

double number_value(const JsonAt& at, double low, double high) {
    if (!at->is_number()) fail_type(at, "a number");
    double value = at->get<double>();
    if (!(value >= low && value <= high)) fail_at(at, "is {}; must be {}", value, range_text(low, high));
    return value;
}

uint64_t integer_value(const JsonAt& at, uint64_t low, uint64_t high) {
    if (!at->is_number()) fail_type(at, "an integer");
    double value = at->get<double>();  // integers of JSON may be written as 1.0
    if (value != std::floor(value)) fail_at(at, "is {}; must be an integer", value);
    if (!(value >= double(low) && value <= double(high)))
        fail_at(at, "is {}; must be an integer from {} to {}", value, low, high);
    return uint64_t(value);
}

const std::string& text_value(const JsonAt& at) {
    if (!at->is_string()) fail_type(at, "a string");
    return at->get_ref<const std::string&>();
}

std::vector<double> number_array(const JsonAt& at, size_t size, double low, double high) {
    require_array(at);
    if (at->size() != size) fail_at(at, "has {} elements; must be {} numbers", at->size(), size);
    std::vector<double> values(size);
    for (size_t i = 0; i < size; ++i) values[i] = number_value(element(at, i), low, high);
    return values;
}

uint32_t index_value(const JsonAt& at, size_t size, const char* array) {
    if (!at->is_number()) fail_type(at, "an index, an integer");
    double value = at->get<double>();
    if (value != std::floor(value) || value < 0)
        fail_at(at, "is {}; must be an index, an integer from 0", value);
    if (size == 0) fail_at(at, "is {}, but {} has no elements", value, array);
    if (value >= double(size)) fail_at(at, "is {}; {} has elements 0 to {}", value, array, size - 1);
    return uint32_t(value);
}

double number(const JsonAt& object, const std::string& key, double fallback, double low, double high) {
    std::optional<JsonAt> found = find(object, key);
    return found ? number_value(*found, low, high) : fallback;
}

uint64_t integer(const JsonAt& object, const std::string& key, uint64_t fallback, uint64_t low,
                 uint64_t high) {
    std::optional<JsonAt> found = find(object, key);
    return found ? integer_value(*found, low, high) : fallback;
}

bool boolean(const JsonAt& object, const std::string& key, bool fallback) {
    std::optional<JsonAt> found = find(object, key);
    if (!found) return fallback;
    if (!(*found)->is_boolean()) fail_type(*found, "true or false");
    return (*found)->get<bool>();
}

std::string text(const JsonAt& object, const std::string& key, const std::string& fallback) {
    std::optional<JsonAt> found = find(object, key);
    return found ? text_value(*found) : fallback;
}

std::vector<double> numbers(const JsonAt& object, const std::string& key, const std::vector<double>& fallback,
                            double low, double high) {
    std::optional<JsonAt> found = find(object, key);
    return found ? number_array(*found, fallback.size(), low, high) : fallback;
}

std::optional<uint32_t> index(const JsonAt& object, const std::string& key, size_t size, const char* array) {
    std::optional<JsonAt> found = find(object, key);
    if (!found) return std::nullopt;
    return index_value(*found, size, array);
}

void only_members(const JsonAt& object, std::initializer_list<const char*> allowed) {
    require_object(object);
    for (auto i = object->begin(); i != object->end(); ++i) {
        if (i.key() == "extras") continue;
        bool known =
            std::any_of(allowed.begin(), allowed.end(), [&](const char* name) { return i.key() == name; });
        if (!known)
            fail_at(member(object, i.key()), "is not known; allowed are {}", fmt::join(allowed, ", "));
    }
}

}  // namespace etendue
