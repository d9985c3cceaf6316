// Tables of text, for terminals, pages and spreadsheets.
#pragma once
#include <string>
#include <vector>

namespace etendue {

using Table = std::vector<std::vector<std::string>>;  // rows of cells; the first names the columns

std::string as_text(const Table& table);  // columns aligned
std::string as_html(const Table& table);
std::string as_csv(const Table& table);  // RFC 4180, but lines end in \n

}  // namespace etendue
