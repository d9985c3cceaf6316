// What pages of HTML need.
#pragma once
#include <cstddef>
#include <span>
#include <string>

namespace etendue {

std::string escaped(const std::string& text);          // for contents and quoted attributes
std::string base64(std::span<const std::byte> bytes);  // RFC 4648, for data URIs

}  // namespace etendue
