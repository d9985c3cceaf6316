// A class file such as a scene may bring along.
#pragma once
#include <string>

#include "tests/support/source_path.h"
#include "tests/support/temporary_folder.h"

namespace etendue {

// The surface class "chalk": lambertian by another name.
inline std::string chalk_class() {
    std::string text = read_text(source_path("shaders/surfaces/lambertian.glsl"));
    for (const auto& [from, to] :
         {std::pair<std::string, std::string>{"Lambertian", "Chalk"}, {"lambertian", "chalk"}})
        for (size_t at; (at = text.find(from)) != std::string::npos;) text.replace(at, from.size(), to);
    return text;
}

}  // namespace etendue
