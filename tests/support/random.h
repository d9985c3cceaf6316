// Random numbers and directions for tests, the same for the same seed.
#pragma once
#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

namespace etendue {

struct Random {
    std::mt19937 engine;
    explicit Random(uint32_t seed) : engine(seed) {}
    float operator()(float lo, float hi) { return std::uniform_real_distribution<float>(lo, hi)(engine); }
    glm::vec3 point(float size) { return {(*this)(-size, size), (*this)(-size, size), (*this)(-size, size)}; }
    glm::vec3 direction() {
        const float z = (*this)(-1, 1), phi = (*this)(0, 6.2831853f), r = std::sqrt(1 - z * z);
        return {r * std::cos(phi), r * std::sin(phi), z};
    }
    // Moved, turned, scaled by axis and mirrored.
    glm::dmat4 placement(double size) {
        glm::dmat4 m = glm::translate(glm::dmat4(1), glm::dvec3(point(float(size))));
        m = glm::rotate(m, double((*this)(0, 6)), glm::dvec3(direction()));
        return glm::scale(m, glm::dvec3((*this)(0.3f, 1.5f), (*this)(0.3f, 1.5f), (*this)(-1.5f, -0.3f)));
    }
};

}  // namespace etendue
