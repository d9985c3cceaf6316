// Where the elements of a microstructure stand that a file places: in cells side by side over the whole sheet, made by
// host/scene/micro_places.
#include "lib/constants.glsl"

// Twin in host/scene/micro_places.h.
struct MicroPlaces {
    uint columns, rows;  // of cells; 0 = no file
    uint first_cell, first_place;
};
// Of each cell, row by row from -y, how many elements stand in those before it; and a last number behind them.
layout(scalar, set = 0) readonly buffer MicroCells { uint micro_cells[]; };
// 16 bits each, the low ones first: x and y within the cell, size - 1, angle, in parts of 65536.
layout(scalar, set = 0) readonly buffer MicroPlaceRows { uvec2 micro_places[]; };

// Of a cell's elements: the first, and the one behind the last.
uvec2 micro_places_of(MicroPlaces p, uint cell) {
    return p.first_place + uvec2(micro_cells[p.first_cell + cell], micro_cells[p.first_cell + cell + 1u]);
}

struct MicroPlace {
    vec2 offset;        // from the middle of the cell, in cells
    float size, angle;  // part of the full one; rad
};

MicroPlace micro_place(uint i) {
    uvec2 v = micro_places[i];
    vec4 part = vec4(v.x & 0xFFFFu, v.x >> 16, v.y & 0xFFFFu, v.y >> 16) * (1.0 / 65536.0);
    return MicroPlace(part.xy + (0.5 / 65536.0 - 0.5), part.z + 1.0 / 65536.0, 6.2831853 * part.w);
}
