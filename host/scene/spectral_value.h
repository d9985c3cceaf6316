// Spectral values of the scene format.
#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "host/scene/description.h"
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

// Fails with the place and what is allowed.
SpectralValue spectral_value(const nlohmann::json& value, const SceneDescription& scene,
                             const std::string& where, SpectralKind kind);

// "FILE: /pointer": the start of a message about an object of the scene.
std::string message_place(const SceneDescription& scene, const std::string& where);

}  // namespace etendue
