#include "host/error.h"

#include <algorithm>

namespace etendue {
namespace {

// Bytes of the UTF-8 character that begins there (RFC 3629, section 4), and which it is; 0 = there is none.
struct Character {
    size_t bytes = 0;
    uint32_t code = 0;
};

Character character_at(const std::string& text, size_t at) {
    const auto byte = [&](size_t i) { return uint32_t(static_cast<unsigned char>(text[i])); };
    const uint32_t first = byte(at);
    if (first < 0x80) return {1, first};
    const size_t bytes = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
    if (first < 0xC2 || first > 0xF4 || at + bytes > text.size()) return {};
    uint32_t code = first & (0x7Fu >> bytes);
    for (size_t i = at + 1; i < at + bytes; ++i) {
        if ((byte(i) & 0xC0) != 0x80) return {};
        code = code << 6 | (byte(i) & 0x3F);
    }
    const uint32_t least[] = {0x80, 0x800, 0x10000};
    const bool surrogate = code >= 0xD800 && code <= 0xDFFF;
    if (code < least[bytes - 2] || code > 0x10FFFF || surrogate) return {};
    return {bytes, code};
}

// C0 and C1 controls, separators of lines, and what turns the direction of text.
bool is_control(uint32_t code) {
    return code < 0x20 || (code >= 0x7F && code < 0xA0) || code == 0x200E || code == 0x200F ||
           (code >= 0x2028 && code <= 0x202E) || (code >= 0x2066 && code <= 0x2069);
}

}  // namespace

std::string printable(const std::string& text) {
    std::string result;
    for (size_t at = 0; at < text.size();) {
        const Character character = character_at(text, at);
        const size_t bytes = std::max<size_t>(character.bytes, 1);
        if (text[at] == '\n')
            result += ' ';
        else if (character.bytes > 0 && !is_control(character.code))
            result.append(text, at, bytes);
        else
            for (size_t i = at; i < at + bytes; ++i)
                result += fmt::format("\\x{:02x}", static_cast<unsigned char>(text[i]));
        at += bytes;
    }
    return result;
}

}  // namespace etendue
