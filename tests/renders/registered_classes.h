// Something of every registered class of surfaces and media, for what is asked of all of them.
#pragma once
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/support/bsdf_files.h"

namespace etendue {

// What a scene says of a surface of the class, whose other parameters are by default.
inline nlohmann::json surface_of(const std::string& name) {
    nlohmann::json surface = {{"class", name}};
    if (name == "measured") surface["file"] = "metal.bsdf";
    if (name == "color_filter") surface["transmittance"] = 0.5;
    if (name == "mueller") surface["matrix"] = {0.5, 0, 0, 0.5, 0, 0, 0, 0, 0, 0, 0, 0, 0.5, 0, 0, 0.5};
    return surface;
}

inline nlohmann::json medium_of(const std::string& name) {
    nlohmann::json medium = {{"class", name}};
    if (name == "uniaxial") medium["ior_ordinary"] = 1.66, medium["ior_extraordinary"] = 1.49;
    return medium;
}

// The file that `measured` names.
inline void write_metal(const std::filesystem::path& folder) {
    GgxMetal metal;
    metal.reflectance = [](double, size_t) { return 0.8; };
    std::ofstream(folder / "metal.bsdf", std::ios::binary) << tensor_file_bytes(rgl_fields(metal, {}));
}

}  // namespace etendue
