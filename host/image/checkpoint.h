// Checkpoints: the state of a film between two passes, so that a later run goes on bit for bit where one
// stopped.
//
// File: the magic "ETDFILM\0", a format version (uint32) and the length of the header (uint32), the header as
// JSON
// {"identity", "passes", "counters", "arrays": [{"name", "bytes"}]}, the arrays one after the other, and a
// hash of all before it (uint64). Little-endian. Written atomically.
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

namespace etendue {

struct CheckpointArray {
    std::string name;
    std::vector<std::byte> bytes;
};

struct Checkpoint {
    // What the state belongs to: one entry for everything that must be equal for the run to go on, such as
    // {"scene": hash, "size": "640x480", "seed": 1, "algorithm": "backward"}. Keys stand in messages.
    nlohmann::json identity = nlohmann::json::object();
    uint64_t passes = 0;  // done
    nlohmann::json counters = nlohmann::json::object();
    std::vector<CheckpointArray> arrays;
};

void write_checkpoint(const std::filesystem::path& path, const Checkpoint& checkpoint);

// Fails with one line where the file is missing, damaged, of another version, or belongs to something else
// than `identity` (naming the first entry that differs).
Checkpoint read_checkpoint(const std::filesystem::path& path, const nlohmann::json& identity);

// The array of that name with exactly that many bytes; fails with one line where the checkpoint has none.
const std::vector<std::byte>& checkpoint_array(const Checkpoint& checkpoint,
                                               const std::filesystem::path& path, const std::string& name,
                                               size_t bytes);

// 64-bit hash of bytes, not cryptographic (FNV-1a over 8 bytes a step, finished as in MurmurHash3). Chain by
// passing the hash of what came before as `start`.
uint64_t hash_bytes(std::span<const std::byte> bytes, uint64_t start = 14695981039346656037u);

}  // namespace etendue
