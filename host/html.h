// What pages of HTML need.
#pragma once
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

namespace etendue {

std::string escaped(const std::string& text);  // for contents and quoted attributes
// The SVG element of a file, without what may only stand at the head of a file; empty where there is none.
std::string inline_svg(const std::filesystem::path& path);
std::string base64(std::span<const std::byte> bytes);  // RFC 4648, for data URIs

}  // namespace etendue
