// Recorded paths as files.
#pragma once
#include <filesystem>
#include <vector>

#include "host/render/path_record.h"

namespace etendue {

// By the ending of the name, written atomically: .json, all that is known of each path; .csv, a row a vertex;
// .glb, coloured lines as glTF 2.0 has them, in the coordinates of the scene file, to be laid over it. Fails
// with one line for any other ending.
void write_paths(const std::filesystem::path& file, const std::vector<RecordedPath>& paths);
// Fails, too, before the work.
void check_path_file(const std::filesystem::path& file);

}  // namespace etendue
