#include "host/html.h"

#include <algorithm>
#include <cstdint>

#include "host/image/atomic_file.h"

namespace etendue {

std::string escaped(const std::string& text) {
    std::string html;
    for (char c : text) {
        if (c == '&')
            html += "&amp;";
        else if (c == '<')
            html += "&lt;";
        else if (c == '>')
            html += "&gt;";
        else if (c == '"')
            html += "&quot;";
        else
            html += c;
    }
    return html;
}

std::string inline_svg(const std::filesystem::path& path) {
    if (!std::filesystem::exists(path)) return "";
    const auto bytes = read_whole_file(path);
    const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const size_t begin = text.find("<svg");
    return begin == std::string::npos ? "" : text.substr(begin);
}

std::string base64(std::span<const std::byte> bytes) {  // RFC 4648
    const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (size_t i = 0; i < bytes.size(); i += 3) {
        uint32_t group = 0;
        const size_t count = std::min<size_t>(3, bytes.size() - i);
        for (size_t k = 0; k < count; ++k) group |= uint32_t(bytes[i + k]) << (16 - 8 * k);
        for (size_t k = 0; k < 4; ++k) text += k <= count ? digits[group >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

}  // namespace etendue
