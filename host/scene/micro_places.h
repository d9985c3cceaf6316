// Places of the elements of a microstructure from files: text, or packed as the device reads them
// (shaders/lib/micro_places.glsl). Both forms are described in scenes/FORMAT.md.
#pragma once
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace etendue {

// Twin of struct MicroPlaces in shaders/lib/micro_places.glsl.
struct MicroPlaces {
    uint32_t columns = 0, rows = 0;
    uint32_t first_cell = 0, first_place = 0;
};

// Of all files, one behind the other.
struct MicroTables {
    std::vector<uint32_t> cells;
    std::vector<glm::uvec2> places;
};

// What a sheet says of its elements.
struct MicroSheet {
    glm::dvec2 size{0};                        // m
    double radius = 0, turn = 0;               // m, rad
    enum { disk, square, strip } foot = disk;  // a strip runs along y
};

// Reads a file and adds it to the tables. Fails, with one line that names the file and, of text, the line,
// where an element does not lie on the sheet or two overlap. 8 bytes an element, and 4 a cell, of which
// there are 2^26, or as many as elements, at most in files of text.
MicroPlaces read_micro_places(const std::filesystem::path& file, const MicroSheet& sheet, unsigned threads,
                              MicroTables& tables);

// Writes what was read last as a packed file.
std::string packed_micro_places(const MicroPlaces& places, const MicroTables& tables);

}  // namespace etendue
