// Something of every registered class of surfaces and media, for what is asked of all of them.
#pragma once
#include <nlohmann/json.hpp>

#include "tests/support/bsdf_files.h"
#include "tests/support/temporary_folder.h"

namespace etendue {

// What a scene says of surfaces of the class, whose other parameters are by default.
inline nlohmann::json surface_of(const std::string& name) {
    nlohmann::json surface = {{"class", name}};
    if (name == "measured") surface["file"] = "metal.bsdf";
    if (name == "mueller_table") surface["file"] = "metal.pbsdf";
    if (name == "color_filter") surface["transmittance"] = 0.5;
    if (name == "grating")
        surface["period"] = 1e-6,
        surface["orders"] = {{{"order", 1}, {"reflected", 0.5}, {"transmitted", 0.2}},
                             {{"order", 0}, {"transmitted", 0.3}}};
    if (name == "mueller") surface["matrix"] = {0.5, 0, 0, 0.5, 0, 0, 0, 0, 0, 0, 0, 0, 0.5, 0, 0, 0.5};
    return surface;
}

inline nlohmann::json medium_of(const std::string& name) {
    nlohmann::json medium = {{"class", name}};
    if (name == "uniaxial") medium["ior_ordinary"] = 1.66, medium["ior_extraordinary"] = 1.49;
    return medium;
}

// The files that `measured` and `mueller_table` name.
inline void write_metals(const std::filesystem::path& folder) {
    GgxMetal metal;
    metal.reflectance = [](double, size_t) { return 0.8; };
    write_text(folder / "metal.bsdf", tensor_file_bytes(rgl_fields(metal, {})));
    const PolarizedMetal gold{0.4, [](double nm) { return std::complex(0.2, -nm / 160); }};
    const auto matrix = [&](double nm, const glm::dvec3& from, const glm::dvec3& to) {
        return metal_matrix(gold, nm, from, to);
    };
    write_text(folder / "metal.pbsdf",
               tensor_file_bytes(mueller_fields(even_nodes(25, 10, 19), {450, 500, 600}, matrix)));
}

}  // namespace etendue
