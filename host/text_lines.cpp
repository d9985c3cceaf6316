#include "host/text_lines.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace etendue {

std::string_view trimmed(std::string_view text) {
    const char* const blanks = " \t\r\n\f\v\x1a";  // and the end of a file of DOS
    const size_t first = text.find_first_not_of(blanks);
    if (first == text.npos) return {};
    return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

double TextLines::number(size_t line, std::string_view word, const std::string& what) const {
    double value;
    if (!parse_number(word, value))
        fail(line, "'{}' stands for {}; must be a number", word.substr(0, 40), what);
    return value;
}

size_t TextLines::count(size_t line, double value, const std::string& what, size_t least, size_t most) const {
    if (value != std::floor(value) || value < double(least) || value > double(most))
        fail(line, "{} is {}; must be a whole number from {} to {}", what, value, least, most);
    return size_t(value);
}

TextLines text_lines(const std::string& file, std::string bytes) {
    TextLines text{file, {}};
    if (bytes.starts_with("\xEF\xBB\xBF")) bytes.erase(0, 3);
    for (size_t at = 0; at < bytes.size();) {
        const size_t end = std::min(bytes.find_first_of("\r\n", at), bytes.size());
        text.lines.emplace_back(trimmed(std::string_view(bytes).substr(at, end - at)));
        at = end + (bytes.compare(end, 2, "\r\n") == 0 ? 2 : 1);
    }
    return text;
}

bool parse_number(std::string_view text, double& value) {
    if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size() && std::abs(value) <= 1e15;
}

}  // namespace etendue
