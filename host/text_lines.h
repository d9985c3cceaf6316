// Files of text as lines, for readers that name the line of an error.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "host/error.h"

namespace etendue {

struct TextLines {
    std::string file;                // for messages
    std::vector<std::string> lines;  // without line ends and what is blank around

    // `line` counts from 0.
    template <class... Args>
    [[noreturn]] void fail(size_t line, fmt::format_string<Args...> format, Args&&... args) const {
        fail_input("{}: line {}: {}", file, line + 1, fmt::format(format, std::forward<Args>(args)...));
    }
    // What stands in that line for `what`, where it is allowed; else they fail.
    double number(size_t line, std::string_view word, const std::string& what) const;
    size_t count(size_t line, double value, const std::string& what, size_t least, size_t most) const;
};

// Lines end as on any system; a mark of UTF-8 at the start is left out.
TextLines text_lines(const std::string& file, std::string bytes);

std::string_view trimmed(std::string_view text);

// A finite number of at most 1e15, all of `text`. False where it is none.
bool parse_number(std::string_view text, double& value);

}  // namespace etendue
