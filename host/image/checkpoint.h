// Checkpoints: what passes of a render have added up to, so that a later run goes on bit for bit where one
// stopped, and so that parts of a render, made by several runs, can be merged.
//
// File: the magic "ETDFILM\0", a format version (uint32) and the length of the header (uint32), the header as
// JSON {"identity", "passes", "about", "arrays": [{"name", "bytes"}]}, the arrays one after the other, and a
// hash of all before it (uint64): hash_bytes of what precedes the arrays, then of each array. Little-endian.
// Written atomically.
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "host/image/pass_set.h"

namespace etendue {

struct CheckpointArray {
    std::string name;
    std::vector<std::byte> bytes;
};

struct Checkpoint {
    // What the passes belong to: one entry for everything that must be equal for others to be added, such as
    // {"scene": hash, "size": "640x480", "seed": 1, "algorithm": "backward"}. Keys stand in messages.
    nlohmann::json identity = nlohmann::json::object();
    PassSet passes;                                   // that it holds
    nlohmann::json about = nlohmann::json::object();  // what else is known of them, on which no sum depends
    std::vector<CheckpointArray> arrays;
};

void write_checkpoint(const std::filesystem::path& path, const Checkpoint& checkpoint);

// Fails with one line where the file is missing, damaged or of another version.
Checkpoint read_checkpoint(const std::filesystem::path& path);

// Fails with one line that names the first entry of `path`'s identity that differs from `wanted`, and says
// what it is `elsewhere` ("now", "in part.etd").
void require_identity(const std::filesystem::path& path, const nlohmann::json& found,
                      const nlohmann::json& wanted, const std::string& elsewhere);

// The array of that name with exactly that many bytes; fails with one line where the checkpoint has none.
std::vector<std::byte>& checkpoint_array(Checkpoint& checkpoint, const std::filesystem::path& path,
                                         const std::string& name, size_t bytes);

// 64-bit hash of bytes, not cryptographic (FNV-1a over 8 bytes a step, finished as in MurmurHash3). Chain by
// passing the hash of what came before as `start`.
uint64_t hash_bytes(std::span<const std::byte> bytes, uint64_t start = 14695981039346656037u);

}  // namespace etendue
