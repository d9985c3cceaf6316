#include "host/image/outputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace etendue {

std::vector<std::string> file_stems(const std::vector<std::string>& names) {
    std::vector<std::string> stems;
    for (std::string name : names) {
        for (char& c : name)
            if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-' && c != '_') c = '_';
        if (name.empty()) name = "unnamed";
        std::string unique = name;
        for (int i = 2; std::find(stems.begin(), stems.end(), unique) != stems.end(); ++i)
            unique = fmt::format("{}-{}", name, i);
        stems.push_back(unique);
    }
    return stems;
}

std::vector<std::filesystem::path> output_files(const std::filesystem::path& output,
                                                const std::vector<std::string>& names) {
    if (names.size() == 1 || output.empty()) return std::vector(names.size(), output);
    std::vector<std::filesystem::path> files;
    for (const std::string& stem : file_stems(names))
        files.push_back(output.parent_path() /
                        (output.stem().string() + "." + stem + output.extension().string()));
    return files;
}

}  // namespace etendue
