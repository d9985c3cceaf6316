#include "host/scene/density_grid.h"

#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <memory>
#include <sstream>
#include <vector>

#include "host/error.h"
#include "host/image/atomic_file.h"

namespace etendue {
namespace {

// An OpenVDB file begins with this number (openvdb/version.h).
bool is_vdb(const std::vector<std::byte>& bytes) {
    return bytes.size() >= 8 && std::memcmp(bytes.data(), " BDV\0\0\0\0", 8) == 0;
}

struct NrrdHeader {
    std::map<std::string, std::string> fields;
    size_t end = 0;  // where the data begin
    std::string name;

    std::string field(const std::string& key, const std::string& otherwise) const {
        const auto found = fields.find(key);
        return found == fields.end() ? otherwise : found->second;
    }
    std::array<double, 3> numbers(const std::string& key, std::string text) const {
        for (char& c : text)
            if (c == '(' || c == ')' || c == ',') c = ' ';
        std::istringstream in(text);
        std::array<double, 3> v{};
        std::string rest;
        if (!(in >> v[0] >> v[1] >> v[2]) || in >> rest || !std::isfinite(v[0] + v[1] + v[2]))
            fail_input("{}: '{}: {}' of the NRRD file is not three numbers", name, key, text);
        return v;
    }
};

// Lines of text up to an empty one: "NRRD000n", "# comment", "field: value", "key:=value".
NrrdHeader read_header(const std::vector<std::byte>& bytes, const std::string& name) {
    NrrdHeader header;
    header.name = name;
    for (size_t number = 0;; ++number) {
        std::string line;
        while (header.end < bytes.size() && char(bytes[header.end]) != '\n' && line.size() < 4096)
            line += char(bytes[header.end++]);
        if (header.end == bytes.size() || line.size() == 4096)
            fail_input("{}: the header of the NRRD file has no end", name);
        ++header.end;
        if (!line.empty() && line.back() == '\r') line.pop_back();
        if (line.empty()) return header;
        const size_t colon = line.find(": ");
        if (number == 0 || line[0] == '#' || colon == std::string::npos) continue;
        header.fields[line.substr(0, colon)] = line.substr(colon + 2);
    }
}

// world_from_lattice: "space directions" and "space origin", else "spacings"; m.
glm::dmat4 placement(const NrrdHeader& header) {
    glm::dmat4 m(1.0);
    if (header.fields.contains("space directions")) {
        // (x,y,z) (x,y,z) (x,y,z), a vector an axis
        std::istringstream in(header.fields.at("space directions"));
        for (int axis = 0; axis < 3; ++axis) {
            std::string text;
            std::getline(in, text, ')');
            const auto v = header.numbers("space directions", text);
            for (int c = 0; c < 3; ++c) m[axis][c] = v[c];
        }
    } else {
        const auto v = header.numbers("spacings", header.field("spacings", "1 1 1"));
        for (int c = 0; c < 3; ++c) m[c][c] = v[c];
    }
    const auto origin = header.numbers("space origin", header.field("space origin", "(0,0,0)"));
    for (int c = 0; c < 3; ++c) m[3][c] = origin[c];
    return m;
}

DensityLattice read_nrrd(std::vector<std::byte> bytes, const std::string& name) {
    const NrrdHeader header = read_header(bytes, name);
    const auto require = [&](const char* key, const std::string& otherwise,
                             std::initializer_list<const char*> allowed) {
        const std::string value = header.field(key, otherwise);
        for (const char* a : allowed)
            if (value == a) return value;
        fail_input("{}: the NRRD file has '{}: {}'; allowed: {}", name, key, value, fmt::join(allowed, ", "));
    };
    require("dimension", "none", {"3"});
    require("encoding", "none", {"raw"});
    const std::string type = require("type", "none", {"float", "uchar", "unsigned char", "uint8", "uint8_t"});
    if (type == "float") require("endian", "none", {"little"});
    if (header.fields.contains("data file") || header.fields.contains("datafile"))
        fail_input("{}: the data of the NRRD file lie in another file; allowed: behind the header", name);
    const auto sizes = header.numbers("sizes", header.field("sizes", ""));
    DensityLattice lattice;
    for (int c = 0; c < 3; ++c) {
        if (!(sizes[c] >= 2 && sizes[c] <= 65536) || sizes[c] != std::floor(sizes[c]))
            fail_input("{}: the NRRD file has the size {} along an axis; allowed: 2 to 65536", name,
                       sizes[c]);
        lattice.points[c] = uint32_t(sizes[c]);
    }
    const size_t value_bytes = type == "float" ? 4 : 1;
    const double wanted = sizes[0] * sizes[1] * sizes[2] * double(value_bytes);
    if (double(bytes.size() - header.end) != wanted)
        fail_input("{}: {} bytes follow the header of the NRRD file; {} x {} x {} values of type {} take {}",
                   name, bytes.size() - header.end, lattice.points.x, lattice.points.y, lattice.points.z,
                   type, wanted);
    lattice.world_from_lattice = placement(header);
    const auto data = std::make_shared<std::vector<std::byte>>(std::move(bytes));
    lattice.read = [data, start = header.end, value_bytes, points = lattice.points](
                       glm::uvec3 first, glm::uvec3 count, float* out) {
        for (uint32_t z = 0; z < count.z; ++z)
            for (uint32_t y = 0; y < count.y; ++y) {
                const size_t row = (size_t(first.z + z) * points.y + first.y + y) * points.x + first.x;
                const std::byte* from = data->data() + start + row * value_bytes;
                if (value_bytes == 4) std::memcpy(out, from, 4 * size_t(count.x));
                for (uint32_t x = 0; value_bytes == 1 && x < count.x; ++x) out[x] = float(from[x]);
                out += count.x;
            }
    };
    return lattice;
}

}  // namespace

DensityLattice read_density_file(const std::filesystem::path& file, const std::string& grid) {
    std::vector<std::byte> bytes = read_whole_file(file);
    if (is_vdb(bytes)) return read_vdb(file, grid);
    if (bytes.size() < 8 || std::memcmp(bytes.data(), "NRRD000", 7) != 0)
        fail_input("{}: neither an OpenVDB nor an NRRD file", file.string());
    if (!grid.empty()) fail_input("{}: an NRRD file has no grid of the name '{}'", file.string(), grid);
    return read_nrrd(std::move(bytes), file.string());
}

}  // namespace etendue
