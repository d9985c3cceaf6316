// Densities at the points of a lattice, made by the tests, written as NRRD files and looked up in double
// precision.
#pragma once
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <glm/glm.hpp>
#include <vector>

namespace etendue {

struct DensityField {
    glm::uvec3 points{2};
    glm::dvec3 lo{-1}, hi{1};   // the first and the last point, m
    std::vector<float> values;  // x fastest

    template <class F>  // of the position
    DensityField(glm::uvec3 points, glm::dvec3 lo, glm::dvec3 hi, F density)
        : points(points), lo(lo), hi(hi) {
        for (uint32_t z = 0; z < points.z; ++z)
            for (uint32_t y = 0; y < points.y; ++y)
                for (uint32_t x = 0; x < points.x; ++x)
                    values.push_back(float(density(lo + glm::dvec3(x, y, z) * spacing())));
    }

    glm::dvec3 spacing() const { return (hi - lo) / glm::dvec3(points - 1u); }

    double at(glm::dvec3 position) const {
        const glm::dvec3 p = (position - lo) / spacing();
        for (int c = 0; c < 3; ++c)
            if (p[c] < 0 || p[c] > points[c] - 1) return 0;
        const glm::uvec3 cell = glm::min(glm::uvec3(p), points - 2u);
        const glm::dvec3 f = p - glm::dvec3(cell);
        double sum = 0;
        for (uint32_t k = 0; k < 8; ++k) {
            const glm::uvec3 corner(k & 1, k >> 1 & 1, k >> 2), i = cell + corner;
            double part = values[(size_t(i.z) * points.y + i.y) * points.x + i.x];
            for (int c = 0; c < 3; ++c) part *= corner[c] ? f[c] : 1 - f[c];
            sum += part;
        }
        return sum;
    }

    void write(const std::filesystem::path& file) const {
        std::ofstream out(file, std::ios::binary);
        const glm::dvec3 s = spacing();
        out << "NRRD0004\n# densities of a test\ntype: float\ndimension: 3\nsizes: " << points.x << ' '
            << points.y << ' ' << points.z
            << "\nencoding: raw\nendian: little\nspace dimension: 3\nspace directions: (" << s.x
            << ",0,0) (0," << s.y << ",0) (0,0," << s.z << ")\nspace origin: (" << lo.x << ',' << lo.y << ','
            << lo.z << ")\n\n";
        out.write(reinterpret_cast<const char*>(values.data()), std::streamsize(4 * values.size()));
    }
};

}  // namespace etendue
