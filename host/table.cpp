#include "host/table.h"

#include <fmt/format.h>

#include <algorithm>

#include "host/html.h"

namespace etendue {
namespace {

// Columns of UTF-8 text whose characters are one column wide each.
size_t columns_of(const std::string& text) {
    return size_t(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

}  // namespace

std::string as_text(const Table& table) {
    std::vector<size_t> widths(table.front().size(), 0);
    for (const auto& row : table)
        for (size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], columns_of(row[c]));
    std::string text;
    for (const auto& row : table) {
        for (size_t c = 0; c < row.size(); ++c) {
            const std::string space(widths[c] - columns_of(row[c]), ' ');
            text += c == 0 ? row[c] + space : "  " + space + row[c];
        }
        text += "\n";
    }
    return text;
}

std::string as_html(const Table& table) {
    std::string html = "<table>\n";
    for (size_t r = 0; r < table.size(); ++r) {
        html += "<tr>";
        const char* cell = r == 0 ? "th" : "td";
        for (const std::string& text : table[r]) html += fmt::format("<{0}>{1}</{0}>", cell, escaped(text));
        html += "</tr>\n";
    }
    return html + "</table>\n";
}

std::string as_csv(const Table& table) {
    std::string text;
    for (const auto& row : table) {
        for (size_t c = 0; c < row.size(); ++c) {
            std::string cell = row[c];
            if (cell.find_first_of(",\"\r\n") != std::string::npos) {
                for (size_t at = 0; (at = cell.find('"', at)) != std::string::npos; at += 2)
                    cell.insert(at, 1, '"');
                cell = '"' + cell + '"';
            }
            text += (c ? "," : "") + cell;
        }
        text += "\n";
    }
    return text;
}

}  // namespace etendue
