#include "host/scene/micro_places.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <optional>
#include <string_view>

#include "host/error.h"
#include "host/parallel_for.h"

namespace etendue {
namespace {

static_assert(std::endian::native == std::endian::little);
constexpr char magic[8] = {'E', 'T', 'D', 'P', 'L', 'A', 'C', 'E'};
constexpr uint64_t most = UINT32_MAX - 1;   // elements of a scene, and cells
constexpr double most_cells_a_side = 8192;  // beyond one for each element
struct Header {
    char magic[8];
    uint32_t version, columns, rows, places;
};
static_assert(sizeof(Header) == 24);

struct Element {
    glm::dvec2 center{0};  // m
    float size = 1, angle = 0;
};

// Half of what the foot takes along x and y, m.
glm::dvec2 half_extent(const MicroSheet& sheet, const Element& e) {
    const double r = e.size * sheet.radius, a = sheet.turn + e.angle;
    if (sheet.foot == MicroSheet::strip) return {r, 0};
    return glm::dvec2(sheet.foot == MicroSheet::disk ? r
                                                     : r * (std::abs(std::cos(a)) + std::abs(std::sin(a))));
}

std::string beyond_sheet(const MicroSheet& sheet, const Element& e, double slack) {
    const glm::dvec2 half = half_extent(sheet, e), end = glm::abs(e.center) + half;
    if (end.x <= 0.5 * sheet.size.x + slack && end.y <= 0.5 * sheet.size.y + slack) return {};
    return fmt::format("the element at ({:g}, {:g}), {:g} m wide, is not within the sheet of {:g} x {:g} m",
                       e.center.x, e.center.y, 2 * half.x, sheet.size.x, sheet.size.y);
}

// What a thread reads of a text.
struct Piece {
    std::string_view text;
    std::vector<Element> elements;
    size_t lines = 0;
    std::string flaw;  // of the last of its lines
};

std::string read_line(std::string_view line, const MicroSheet& sheet, std::vector<Element>& elements) {
    static const char* const names[] = {"x", "y", "size", "angle"};
    double v[4] = {0, 0, 1, 0};
    size_t count = 0;
    for (const char *at = line.data(), *end = at + std::min(line.find('#'), line.size());;) {
        while (at < end && (*at == ' ' || *at == '\t' || *at == '\r')) ++at;
        if (at == end) break;
        const char* word_end =
            std::find_if(at, end, [](char c) { return c == ' ' || c == '\t' || c == '\r'; });
        const std::string_view word(at, size_t(word_end - at));
        if (count == 4)
            return fmt::format("'{}' is a fifth number; allowed: x y [size] [angle]", word.substr(0, 40));
        const auto [stop, error] = std::from_chars(at, word_end, v[count]);
        if (error != std::errc() || stop != word_end || !(std::abs(v[count]) < 1e15))
            return fmt::format("'{}' stands for {}; allowed: a number", word.substr(0, 40), names[count]);
        ++count, at = word_end;
    }
    if (count == 0) return {};
    if (count == 1) return "there is no y; allowed: x y [size] [angle]";
    if (!(v[2] > 0 && v[2] <= 1)) return fmt::format("size is {:g}; allowed: more than 0, at most 1", v[2]);
    const Element e{{v[0], v[1]}, float(v[2]), float(v[3])};
    elements.push_back(e);
    return beyond_sheet(sheet, e, 1e-9 * (sheet.size.x + sheet.size.y));
}

void read_piece(Piece& piece, const MicroSheet& sheet) {
    for (std::string_view rest = piece.text; !rest.empty() && piece.flaw.empty(); ++piece.lines) {
        const size_t end = std::min(rest.find('\n'), rest.size());
        piece.flaw = read_line(rest.substr(0, end), sheet, piece.elements);
        rest.remove_prefix(std::min(end + 1, rest.size()));
    }
}

std::vector<Piece> read_text(const std::string& file, const std::string& text, const MicroSheet& sheet,
                             unsigned threads) {
    std::vector<Piece> pieces;
    const size_t piece_bytes = std::max<size_t>(text.size() / (size_t(threads) * 8) + 1, 1 << 16);
    for (size_t at = 0; at < text.size();) {
        const size_t end =
            std::min(text.find('\n', std::min(at + piece_bytes, text.size())), text.size() - 1) + 1;
        pieces.push_back({std::string_view(text).substr(at, end - at), {}, 0, {}});
        at = end;
    }
    parallel_for(pieces.size(), threads, [&](size_t i) { read_piece(pieces[i], sheet); });
    size_t line = 0;
    for (const Piece& piece : pieces) {
        line += piece.lines;
        if (!piece.flaw.empty()) fail_input("{}: line {}: {}", file, line, piece.flaw);
    }
    return pieces;
}

uint32_t part(double of_one) { return uint32_t(std::clamp(std::floor(of_one * 65536), 0.0, 65535.0)); }

// Into cells that are as wide as the elements or wider.
MicroPlaces pack(const std::string& file, const std::vector<Piece>& pieces, const MicroSheet& sheet,
                 MicroTables& tables) {
    uint64_t count = 0;
    double greatest = 0;
    for (const Piece& piece : pieces) {
        count += piece.elements.size();
        for (const Element& e : piece.elements) greatest = std::max(greatest, double(e.size));
    }
    if (count == 0)
        fail_input("{}: there are no elements; allowed: a line for each, x y [size] [angle]", file);
    if (count + tables.places.size() > most)
        fail_input("{}: {} elements; allowed: {} in a scene", file, count, most);
    const double widest =
        2.0001 * sheet.radius * greatest * (sheet.foot == MicroSheet::square ? std::sqrt(2) : 1);
    const bool strips = sheet.foot == MicroSheet::strip;
    // About one a cell, or more cells: a place is right to a thousandth of the widest element then.
    const double each =
        strips ? sheet.size.x / double(count) : std::sqrt(sheet.size.x * sheet.size.y / double(count));
    const double finest = std::min(std::max(sheet.size.x, sheet.size.y) / most_cells_a_side, each);
    const double cell = std::max({std::min(each, 32 * widest), widest, finest});
    const auto number = [&](double length) {
        return uint32_t(std::clamp(std::floor(length / cell), 1.0, double(1 << 24)));
    };
    MicroPlaces result{number(sheet.size.x), strips ? 1 : number(sheet.size.y), uint32_t(tables.cells.size()),
                       uint32_t(tables.places.size())};
    const glm::dvec2 cells(result.columns, result.rows);
    const auto place = [&](const Element& e) { return (e.center / sheet.size + 0.5) * cells; };
    const auto cell_of = [&](const glm::dvec2& p) {
        return size_t(std::clamp(p.y, 0.0, cells.y - 1)) * result.columns +
               size_t(std::clamp(p.x, 0.0, cells.x - 1));
    };
    tables.cells.resize(tables.cells.size() + size_t(result.columns) * result.rows + 1);
    tables.places.resize(tables.places.size() + count);
    uint32_t* const starts = &tables.cells[result.first_cell];
    glm::uvec2* const places = &tables.places[result.first_place];
    // Counted, then sorted: where a cell's elements begin moves to where they end, which is where the next
    // cell's begin.
    for (const Piece& piece : pieces)
        for (const Element& e : piece.elements) ++starts[cell_of(place(e)) + 1];
    const size_t last = size_t(result.columns) * result.rows;
    for (size_t i = 1; i <= last; ++i) starts[i] += starts[i - 1];
    for (const Piece& piece : pieces)
        for (const Element& e : piece.elements) {
            const glm::dvec2 p = place(e);
            const size_t i = cell_of(p);
            const double turns = double(e.angle) / (2 * M_PI);
            const uint32_t angle =
                uint32_t(int64_t(std::round((turns - std::floor(turns)) * 65536))) & 0xFFFFu;
            const uint32_t size = uint32_t(std::clamp(std::round(double(e.size) * 65536) - 1, 0.0, 65535.0));
            places[starts[i]++] = {
                part(p.x - double(i % result.columns)) | part(p.y - double(i / result.columns)) << 16,
                size | angle << 16};
        }
    for (size_t i = last; i > 0; --i) starts[i] = starts[i - 1];
    starts[0] = 0;
    return result;
}

MicroPlaces read_packed(std::ifstream& stream, const std::string& file, uint64_t bytes, MicroTables& tables) {
    Header header{};
    stream.read(reinterpret_cast<char*>(&header), sizeof header);
    if (bytes < sizeof header) fail_input("{}: {} bytes; allowed: at least {}", file, bytes, sizeof header);
    if (!stream || header.version != 1)
        fail_input("{}: version {} of packed places; allowed: 1", file, header.version);
    const uint64_t cells = uint64_t(header.columns) * header.rows;
    if (cells == 0 || header.columns > 1 << 24 || header.rows > 1 << 24 ||
        cells + tables.cells.size() > most || header.places + tables.places.size() > most)
        fail_input(
            "{}: {} elements in {} x {} cells; allowed: up to 16 million cells along x and y, {} of both in "
            "a scene",
            file, header.places, header.columns, header.rows, most);
    const uint64_t wanted = sizeof header + 4 * (cells + 1) + 8 * uint64_t(header.places);
    if (bytes != wanted) fail_input("{}: {} bytes; allowed: {}, as its head says", file, bytes, wanted);
    const MicroPlaces result{header.columns, header.rows, uint32_t(tables.cells.size()),
                             uint32_t(tables.places.size())};
    tables.cells.resize(tables.cells.size() + cells + 1);
    tables.places.resize(tables.places.size() + header.places);
    uint32_t* const starts = &tables.cells[result.first_cell];
    stream.read(reinterpret_cast<char*>(starts), std::streamsize(4 * (cells + 1)));
    if (header.places > 0)
        stream.read(reinterpret_cast<char*>(&tables.places[result.first_place]),
                    std::streamsize(8 * uint64_t(header.places)));
    if (!stream) fail_input("{}: cannot be read to its end", file);
    if (starts[0] != 0 || starts[cells] != header.places || !std::is_sorted(starts, starts + cells + 1))
        fail_input("{}: the numbers of its cells do not rise from 0 to {}", file, header.places);
    return result;
}

// Two squares overlap unless an axis of one of them parts them.
bool squares_overlap(const glm::dvec2& away, double r0, double a0, double r1, double a1, double slack) {
    const double turn = a1 - a0, spread = std::abs(std::cos(turn)) + std::abs(std::sin(turn));
    const auto parts = [&](double a, double own, double other) {
        const glm::dvec2 x(std::cos(a), std::sin(a)), y(-x.y, x.x);
        return std::max(std::abs(glm::dot(away, x)), std::abs(glm::dot(away, y))) >=
               own + spread * other - slack;
    };
    return !parts(a0, r0, r1) && !parts(a1, r1, r0);
}

// Looks at every element and those beside it.
class Check {
  public:
    Check(const MicroPlaces& places, const MicroTables& tables, const MicroSheet& sheet)
        : m_(places),
          sheet_(sheet),
          starts_(&tables.cells[places.first_cell]),
          places_(tables.places.data() + places.first_place),
          cell_(sheet.size / glm::dvec2(places.columns, places.rows)),
          slack_(4.0 / 65536 * std::max(cell_.x, cell_.y)) {
        const double widest = 2 * sheet.radius * (sheet.foot == MicroSheet::square ? std::sqrt(2) : 1);
        // No farther than where elements would have to be that are as large as can be.
        columns_ = uint32_t(std::min(std::ceil(widest / cell_.x), double(m_.columns)));
        rows_ = sheet.foot == MicroSheet::strip
                    ? m_.rows
                    : uint32_t(std::min(std::ceil(widest / cell_.y), double(m_.rows)));
    }

    std::string flaw_of_row(uint32_t row) const {
        for (uint32_t column = 0; column < m_.columns; ++column)
            for (uint32_t i = start(column, row); i < start(column + 1, row); ++i) {
                const Element e = element(column, row, i);
                if (std::string flaw = beyond_sheet(sheet_, e, slack_); !flaw.empty()) return flaw;
                for (uint32_t y = row; y < std::min(row + rows_ + 1, m_.rows); ++y)
                    for (uint32_t x = y == row ? column : column - std::min(columns_, column);
                         x < std::min(column + columns_ + 1, m_.columns); ++x)
                        for (uint32_t j = x == column && y == row ? i + 1 : start(x, y); j < start(x + 1, y);
                             ++j)
                            if (const Element other = element(x, y, j); overlap(e, other))
                                return fmt::format(
                                    "the elements at ({:g}, {:g}) and ({:g}, {:g}) overlap; allowed: "
                                    "elements that do not",
                                    e.center.x, e.center.y, other.center.x, other.center.y);
            }
        return {};
    }

  private:
    uint32_t start(uint32_t column, uint32_t row) const { return starts_[size_t(row) * m_.columns + column]; }
    Element element(uint32_t column, uint32_t row, uint32_t i) const {
        const glm::uvec2 v = places_[i];
        const glm::dvec2 offset = (glm::dvec2(v.x & 0xFFFFu, v.x >> 16) + 0.5) / 65536.0;
        return {(glm::dvec2(column, row) + offset) * cell_ - 0.5 * sheet_.size,
                float((v.y & 0xFFFFu) + 1) / 65536, float((v.y >> 16) * (2 * M_PI / 65536))};
    }
    bool overlap(const Element& a, const Element& b) const {
        const glm::dvec2 away = b.center - a.center;
        const double r0 = a.size * sheet_.radius, r1 = b.size * sheet_.radius,
                     apart = std::max(r0 + r1 - slack_, 0.0);
        if (sheet_.foot == MicroSheet::strip) return std::abs(away.x) < apart;
        if (sheet_.foot == MicroSheet::disk) return glm::dot(away, away) < apart * apart;
        return squares_overlap(away, r0, sheet_.turn + a.angle, r1, sheet_.turn + b.angle, slack_);
    }

    const MicroPlaces m_;
    const MicroSheet sheet_;
    const uint32_t* const starts_;
    const glm::uvec2* const places_;
    const glm::dvec2 cell_;
    const double slack_;  // m, of rounding to 16 bits
    uint32_t columns_ = 0, rows_ = 0;
};

}  // namespace

MicroPlaces read_micro_places(const std::filesystem::path& path, const MicroSheet& sheet, unsigned threads,
                              MicroTables& tables) {
    const std::string file = path.string();
    std::ifstream stream(path, std::ios::binary | std::ios::ate);
    if (!stream || !std::filesystem::is_regular_file(path)) fail_input("{}: cannot be read", file);
    const uint64_t bytes = uint64_t(stream.tellg());
    stream.seekg(0);
    std::string head(std::min<uint64_t>(bytes, sizeof magic), 0);
    stream.read(head.data(), std::streamsize(head.size()));
    stream.seekg(0);
    MicroPlaces places;
    if (head == std::string_view(magic, sizeof magic)) {
        places = read_packed(stream, file, bytes, tables);
    } else {
        std::string text(bytes, 0);
        stream.read(text.data(), std::streamsize(bytes));
        if (!stream) fail_input("{}: cannot be read to its end", file);
        places = pack(file, read_text(file, text, sheet, threads), sheet, tables);
    }
    const Check check(places, tables, sheet);
    std::vector<std::string> flaws(threads);
    std::atomic<uint32_t> next = 0;
    parallel_for(threads, threads, [&](size_t thread) {
        for (uint32_t row; flaws[thread].empty() && (row = next.fetch_add(1)) < places.rows;)
            flaws[thread] = check.flaw_of_row(row);
    });
    for (const std::string& flaw : flaws)
        if (!flaw.empty()) fail_input("{}: {}", file, flaw);
    return places;
}

std::string packed_micro_places(const MicroPlaces& m, const MicroTables& tables) {
    Header header{{}, 1, m.columns, m.rows, uint32_t(tables.places.size() - m.first_place)};
    std::memcpy(header.magic, magic, sizeof magic);
    std::string bytes(reinterpret_cast<const char*>(&header), sizeof header);
    bytes.append(reinterpret_cast<const char*>(&tables.cells[m.first_cell]),
                 4 * (size_t(m.columns) * m.rows + 1));
    bytes.append(reinterpret_cast<const char*>(tables.places.data() + m.first_place),
                 8 * size_t(header.places));
    return bytes;
}

}  // namespace etendue
