// A spectral parameter as scenes state it: a number, a colour or a table.
#pragma once
#include <glm/glm.hpp>
#include <optional>

#include "host/spectra/spectrum.h"

namespace etendue {

// What a value stands for decides how it becomes a colour, and how a colour becomes a spectrum.
enum class SpectralKind {
    factor,    // a reflectance, a coefficient …: seen under D65
    radiance,  // light. Tables, CSV files and blackbodies are W / (m² sr nm); numbers, colours and CIE's
               // illuminants are luminous: 1 = 1 cd/m², colours are on D65
    index,     // refractive index; without wavelengths that at 587.6 nm (the d line)
};

struct SpectralValue {
    glm::vec3 rgb{0};                    // linear Rec.709
    std::optional<SpectralTable> table;  // none: the value is a number or a colour

    SpectralTable as_table(SpectralKind kind) const;  // made for the colour where there is none
    float least() const, greatest() const;
    bool operator==(const SpectralValue&) const = default;
};

}  // namespace etendue
