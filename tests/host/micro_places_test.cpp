// Files of places of a microstructure's elements: what is read, and what is refused.
#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>

#include "host/error.h"
#include "host/scene/micro_places.h"

using namespace etendue;

namespace {

const MicroSheet sheet{{0.4, 0.2}, 0.01};

MicroPlaces read(const std::string& content, MicroTables& tables, const MicroSheet& on = sheet) {
    const std::filesystem::path path = std::filesystem::temp_directory_path() / "etendue_places.txt";
    std::ofstream(path, std::ios::binary) << content;
    return read_micro_places(path, on, 2, tables);
}
std::string flaw(const std::string& content, const MicroSheet& on = sheet) {
    MicroTables tables;
    try {
        read(content, tables, on);
    } catch (const Error& e) {
        const std::string text = e.what(), file = "etendue_places.txt: ";
        return text.substr(text.find(file) + file.size());
    }
    return "none";
}

}  // namespace

TEST_CASE("a text of places is packed into cells, and read again from what is packed") {
    MicroTables tables;
    read("0 0\n", tables);  // of another sheet
    const MicroPlaces m =
        read("# x y size angle\n-0.15 0.05 0.5 1.5707963\n\n  0.15\t-0.05 # alone\r\n0.15 0.05 1 -1.5707963",
             tables);
    REQUIRE(tables.places.size() == 4);
    CHECK(m.first_place == 1);
    CHECK(m.columns * m.rows <= 3);
    CHECK(tables.cells.back() == 3);
    CHECK((tables.places[1].x >> 16) == 49152);  // y, in the only row
    CHECK((tables.places[2].x >> 16) == 16384);
    CHECK(tables.places[1].y == (32767 | 16384 << 16));
    CHECK(tables.places[2].y == 65535);
    CHECK(tables.places[3].y == (65535u | 49152u << 16));
    MicroTables again;
    const MicroPlaces p = read(packed_micro_places(m, tables), again);
    CHECK(p.columns == m.columns);
    CHECK(again.places[0] == tables.places[1]);
    CHECK(again.places[2] == tables.places[3]);
    CHECK(again.cells.back() == 3);
}

TEST_CASE("lines that say no place are named") {
    CHECK(flaw("") == "there are no elements; allowed: a line for each, x y [size] [angle]");
    CHECK(flaw("0 0\n0.1 here\n") == "line 2: 'here' stands for y; allowed: a number");
    CHECK(flaw("# a\n\n0.1\n") == "line 3: there is no y; allowed: x y [size] [angle]");
    CHECK(flaw("0 0 1 0 7\n") == "line 1: '7' is a fifth number; allowed: x y [size] [angle]");
    CHECK(flaw("0 0 1.5\n") == "line 1: size is 1.5; allowed: more than 0, at most 1");
    CHECK(flaw("0 0\n0.1 0.095 1\n") ==
          "line 2: the element at (0.1, 0.095), 0.02 m wide, is not within the sheet of 0.4 x 0.2 m");
    CHECK(flaw("0 0\n0.1 0.095 0.4\n") == "none");
    std::string many;
    for (int i = 0; i < 20000; ++i) many += "0.1 0.05 # far\n";
    CHECK(flaw(many + "nan 0\n") == "line 20001: 'nan' stands for x; allowed: a number");
}

TEST_CASE("elements that overlap are refused, those that touch are not") {
    CHECK(flaw("0 0\n0.0199 0\n0.1 0\n").ends_with("overlap; allowed: elements that do not"));
    CHECK(flaw("0 0\n0.02 0\n0.1 0\n") == "none");
    const MicroSheet squares{{0.4, 0.2}, 0.01, 0, MicroSheet::square},
        strips{{0.4, 0.2}, 0.01, 0, MicroSheet::strip};
    CHECK(flaw("0 0\n0.019 0.019\n0.1 0\n", squares) != "none");
    CHECK(flaw("0 0\n0.019 0.0201\n0.1 0\n", squares) == "none");
    CHECK(flaw("0 0 1 0.7854\n0.0205 0.0205\n0.1 0\n", squares) == "none");  // a corner between two sides
    CHECK(flaw("0 0 1 0.7854\n0.0205 0\n0.1 0\n", squares) != "none");
    CHECK(flaw("0 0\n0.015 0.09\n0.1 0\n", strips) != "none");
}

TEST_CASE("packed files that do not add up are refused") {
    MicroTables tables;
    const MicroPlaces m = read("0.1 0\n-0.1 0\n", tables);
    const std::string good = packed_micro_places(m, tables);
    CHECK(flaw(good) == "none");
    CHECK(flaw(good.substr(0, good.size() - 1)) ==
          fmt::format("{} bytes; allowed: {}, as its head says", good.size() - 1, good.size()));
    std::string other = good;
    other[8] = 2;
    CHECK(flaw(other) == "version 2 of packed places; allowed: 1");
    other = good, other[24] = 1;  // the first number of the cells
    CHECK(flaw(other) == "the numbers of its cells do not rise from 0 to 2");
    CHECK(flaw(good.substr(0, 20)).starts_with("20 bytes; allowed: at least"));
}
