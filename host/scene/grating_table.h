// Efficiencies of a grating over wavelength and incidence (shaders/surfaces/grating.glsl), as a scene or a
// file gives them, checked.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "host/scene/grating_orders.h"

namespace etendue {

// The numbers are wavelengths (nm), sines of the angles of incidence, both rising, then for each order, from
// above and from below, reflected and transmitted, for each sine and wavelength two parts of the power: of s
// and of p.
struct GratingEfficiencies {
    std::vector<int> orders;  // 0 is always among them
    std::vector<float> numbers;
    uint32_t wavelengths = 0, sines = 0;
    bool polarizes = false, transmits = false;
};

// [{"order": m, "side": "above"|"below", "wavelength": nm, "angle": rad, "polarization": "s"|"p",
// "reflected": part, "transmitted": part}, …]: what is left out of side to polarization holds for all.
// `wavelength` may be a list, as long as that of the parts. Or {"file": CSV} with a column each. Fails where
// values are missing or given twice, or orders carry more than comes together.
GratingEfficiencies read_grating_table(const nlohmann::json& value, const SceneDescription& scene,
                                       const std::string& where);

GratingTable append(std::vector<GratingOrder>& orders, std::vector<float>& numbers,
                    const GratingEfficiencies& table);

}  // namespace etendue
