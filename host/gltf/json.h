// Reading JSON values with their place: each read checks type and range, and a fault names file and JSON
// pointer.
#pragma once
#include <cfloat>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "host/error.h"

namespace etendue {

// A value of the document and its JSON pointer. Lives no longer than the document.
struct JsonAt {
    const nlohmann::json* value = nullptr;
    std::string pointer;
    const std::string* file = nullptr;  // name of the scene file, for messages

    const nlohmann::json& operator*() const { return *value; }
    const nlohmann::json* operator->() const { return value; }
};

// "FILE: /json/pointer: message"
std::string message_at(const JsonAt& at, const std::string& message);

template <class... Args>
[[noreturn]] void fail_at(const JsonAt& at, fmt::format_string<Args...> format, Args&&... args) {
    fail_input("{}", message_at(at, fmt::format(format, std::forward<Args>(args)...)));
}

JsonAt element(const JsonAt& array, size_t index);
JsonAt member(const JsonAt& object, const std::string& key);  // must exist

// Members that may be absent; what is there must have the type.
std::optional<JsonAt> find(const JsonAt& object, const std::string& key);
std::optional<JsonAt> find_object(const JsonAt& object, const std::string& key);
std::optional<JsonAt> find_array(const JsonAt& object, const std::string& key);
std::optional<JsonAt> find_extension(const JsonAt& object, const std::string& name);
size_t array_size(const JsonAt& object, const std::string& key);  // 0 where absent

void require_object(const JsonAt& at);
void require_array(const JsonAt& at);

// Values by themselves.
double number_value(const JsonAt& at, double low = -DBL_MAX, double high = DBL_MAX);
uint64_t integer_value(const JsonAt& at, uint64_t low = 0, uint64_t high = UINT32_MAX);
const std::string& text_value(const JsonAt& at);
std::vector<double> number_array(const JsonAt& at, size_t size, double low = -DBL_MAX, double high = DBL_MAX);
// An index into an array of the document, "/meshes" say, that has `size` elements.
uint32_t index_value(const JsonAt& at, size_t size, const char* array);

// Members with a default.
double number(const JsonAt& object, const std::string& key, double fallback, double low = -DBL_MAX,
              double high = DBL_MAX);
uint64_t integer(const JsonAt& object, const std::string& key, uint64_t fallback, uint64_t low = 0,
                 uint64_t high = UINT32_MAX);
bool boolean(const JsonAt& object, const std::string& key, bool fallback);
std::string text(const JsonAt& object, const std::string& key, const std::string& fallback = "");
std::vector<double> numbers(const JsonAt& object, const std::string& key, const std::vector<double>& fallback,
                            double low = -DBL_MAX, double high = DBL_MAX);
std::optional<uint32_t> index(const JsonAt& object, const std::string& key, size_t size, const char* array);

// Fails at a member whose name is not among the allowed ones ("a, b and c", for the message).
void only_members(const JsonAt& object, std::initializer_list<const char*> allowed);

}  // namespace etendue
