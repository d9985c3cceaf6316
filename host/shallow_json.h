// JSON of files that others made. What is nested deeper than it can mean anything is refused before anybody
// walks through it: each level takes some of the stack.
#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

namespace etendue {

// Nothing where the text is no JSON, or is nested deeper than that.
inline std::optional<nlohmann::json> parse_shallow_json(std::string_view text, int most_levels) {
    bool is_deep = false;
    const auto look = [&](int depth, nlohmann::json::parse_event_t, nlohmann::json&) {
        is_deep |= depth > most_levels;
        return !is_deep;
    };
    nlohmann::json value = nlohmann::json::parse(text.begin(), text.end(), look, false);
    if (value.is_discarded() || is_deep) return std::nullopt;
    return value;
}

}  // namespace etendue
