// URIs of buffers and images: data URIs (RFC 2397), and paths relative to the scene file.
#include <tiny_gltf.h>

#include "host/gltf/import.h"

namespace etendue {
namespace {

int hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

std::string percent_decoded(const JsonAt& at) {
    const std::string& uri = text_value(at);
    std::string result;
    for (size_t i = 0; i < uri.size(); ++i) {
        if (uri[i] != '%') {
            result += uri[i];
            continue;
        }
        int high = i + 2 < uri.size() ? hex_digit(uri[i + 1]) : -1;
        int low = i + 2 < uri.size() ? hex_digit(uri[i + 2]) : -1;
        if (high < 0 || low < 0) fail_at(at, "has a '%' that two hexadecimal digits do not follow");
        result += char(high * 16 + low);
        i += 2;
    }
    if (result.find('\0') != std::string::npos) fail_at(at, "has a zero byte");
    return result;
}

bool has_scheme(const std::string& uri) {
    size_t colon = uri.find("://");
    return colon != std::string::npos && uri.find('/') > colon;
}

}  // namespace

bool is_data_uri(const std::string& uri) { return uri.starts_with("data:"); }

Bytes decode_data_uri(const JsonAt& at) {
    const std::string& uri = text_value(at);
    const std::string marker = ";base64,";
    size_t comma = uri.find(',');
    if (comma == std::string::npos || comma + 1 < marker.size() ||
        uri.compare(comma + 1 - marker.size(), marker.size(), marker) != 0)
        fail_at(at, "is a data URI of an unknown form; must be data:MEDIA-TYPE;base64,DATA");
    size_t first_bad =
        uri.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/=", comma + 1);
    if (first_bad != std::string::npos)
        fail_at(at, "has a character that base64 does not know, at position {}", first_bad);
    if (comma + 1 == uri.size()) return {};

    // The decoder knows a few media types only; the type does not matter here.
    Bytes bytes;
    std::string media_type;
    if (!tinygltf::DecodeDataURI(&bytes, media_type,
                                 "data:application/octet-stream" + uri.substr(comma + 1 - marker.size()), 0,
                                 false))
        fail_at(at, "holds no base64 data");
    return bytes;
}

std::filesystem::path resolve_uri(const GltfImport& import, const JsonAt& at) {
    if (text_value(at).empty()) fail_at(at, "is empty; must be a relative path or a data URI");
    if (has_scheme(text_value(at)))
        fail_at(at, "is '{}'; must be a path relative to the scene file, or a data URI", text_value(at));
    std::filesystem::path relative = percent_decoded(at);
    if (relative.is_absolute())
        fail_at(at, "is '{}'; must be a path relative to the scene file, or a data URI", relative.string());
    std::filesystem::path path = import.scene.folder / relative;
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) fail_at(at, "there is no file {}", path.string());
    return path;
}

}  // namespace etendue
