// Files that are whole or not there: written beside their place under another name, then renamed over it, so
// that an interrupted or failed write never costs what stood there before.
#pragma once
#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

namespace etendue {

// Fails unless write_atomically(path) can work: a folder that can be written to, no folder at the place
// itself, no write-protected file. To be called before the work whose result goes there. Leaves no trace.
void check_writable(const std::filesystem::path& path);

// Makes the folder of --output where there is none. Fails unless it is empty or one of an earlier `work`
// ("bench"), whose `mark` it holds, a file that can be written.
void prepare_output_folder(const std::filesystem::path& folder, const char* mark, const char* work);

// Where `path` is no regular file (a pipe, a terminal) it is written to directly.
void write_atomically(const std::filesystem::path& path, std::span<const std::byte> bytes);
void write_atomically(const std::filesystem::path& path, std::string_view text);
// One behind the other.
void write_atomically(const std::filesystem::path& path,
                      const std::vector<std::span<const std::byte>>& pieces);

// The whole file; fails with one line where it cannot be read.
std::vector<std::byte> read_whole_file(const std::filesystem::path& path);

}  // namespace etendue
