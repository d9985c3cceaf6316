#include "host/image/checkpoint.h"

#include <cstring>

#include "host/error.h"
#include "host/image/atomic_file.h"

namespace etendue {
namespace {

const char magic[8] = {'E', 'T', 'D', 'F', 'I', 'L', 'M', '\0'};
const uint32_t format_version = 1;
const size_t prefix_size = sizeof magic + 2 * sizeof(uint32_t);

template <class T>
void append(std::vector<std::byte>& bytes, const T& value) {
    auto* first = reinterpret_cast<const std::byte*>(&value);
    bytes.insert(bytes.end(), first, first + sizeof value);
}

template <class T>
T read_at(const std::vector<std::byte>& bytes, size_t offset) {
    T value;
    std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
}

void require_identity(const std::string& name, const nlohmann::json& found, const nlohmann::json& wanted) {
    for (const auto& [key, value] : wanted.items()) {
        if (found.contains(key) && found[key] == value) continue;
        std::string was = found.contains(key) ? found[key].dump() : "none";
        fail_input("{}: this checkpoint is of another render: its {} is {}, now {}", name, key, was,
                   value.dump());
    }
    for (const auto& [key, value] : found.items())
        if (!wanted.contains(key))
            fail_input("{}: this checkpoint is of another render: its {} is {}, now none", name, key,
                       value.dump());
}

}  // namespace

uint64_t hash_bytes(std::span<const std::byte> bytes, uint64_t start) {
    const uint64_t prime = 1099511628211u;
    uint64_t hash = start ^ bytes.size();
    while (!bytes.empty()) {
        uint64_t word = 0;
        size_t step = std::min(bytes.size(), sizeof word);
        std::memcpy(&word, bytes.data(), step);
        hash = (hash ^ word) * prime;
        hash ^= hash >> 29;  // the high bits of a word reach the low bits of the hash
        bytes = bytes.subspan(step);
    }
    hash ^= hash >> 33, hash *= 0xff51afd7ed558ccdu;
    hash ^= hash >> 33, hash *= 0xc4ceb9fe1a85ec53u;
    return hash ^ (hash >> 33);
}

void write_checkpoint(const std::filesystem::path& path, const Checkpoint& checkpoint) {
    nlohmann::json header = {{"identity", checkpoint.identity},
                             {"passes", checkpoint.passes},
                             {"counters", checkpoint.counters},
                             {"arrays", nlohmann::json::array()}};
    size_t size = 0;
    for (const CheckpointArray& array : checkpoint.arrays) {
        header["arrays"].push_back({{"name", array.name}, {"bytes", array.bytes.size()}});
        size += array.bytes.size();
    }
    std::string text = header.dump();
    std::vector<std::byte> bytes;
    bytes.reserve(prefix_size + text.size() + size + sizeof(uint64_t));
    append(bytes, magic);
    append(bytes, format_version);
    append(bytes, uint32_t(text.size()));
    auto* first = reinterpret_cast<const std::byte*>(text.data());
    bytes.insert(bytes.end(), first, first + text.size());
    for (const CheckpointArray& array : checkpoint.arrays)
        bytes.insert(bytes.end(), array.bytes.begin(), array.bytes.end());
    append(bytes, hash_bytes(bytes));
    write_atomically(path, bytes);
}

Checkpoint read_checkpoint(const std::filesystem::path& path, const nlohmann::json& identity) {
    std::string name = path.string();
    std::vector<std::byte> bytes = read_whole_file(path);
    if (bytes.size() < sizeof magic || std::memcmp(bytes.data(), magic, sizeof magic) != 0)
        fail_input("{}: not a checkpoint of étendue", name);
    if (bytes.size() < prefix_size + sizeof(uint64_t))
        fail_input("{}: damaged: the checkpoint is cut short", name);
    uint32_t version = read_at<uint32_t>(bytes, sizeof magic);
    if (version != format_version)
        fail_input("{}: checkpoint format {}, only {} can be read", name, version, format_version);
    size_t body = bytes.size() - sizeof(uint64_t);
    if (hash_bytes(std::span(bytes).first(body)) != read_at<uint64_t>(bytes, body))
        fail_input("{}: damaged: the checkpoint is cut short or altered", name);

    Checkpoint checkpoint;
    try {
        size_t offset = prefix_size + read_at<uint32_t>(bytes, sizeof magic + sizeof(uint32_t));
        if (offset > body) fail_input("{}: damaged: the header is longer than the file", name);
        auto* text = reinterpret_cast<const char*>(bytes.data());
        nlohmann::json header = nlohmann::json::parse(text + prefix_size, text + offset);
        checkpoint.identity = header.at("identity");
        checkpoint.passes = header.at("passes").get<uint64_t>();
        checkpoint.counters = header.at("counters");
        for (const nlohmann::json& entry : header.at("arrays")) {
            size_t size = entry.at("bytes").get<size_t>();
            if (size > body - offset) fail_input("{}: damaged: an array is longer than the file", name);
            auto first = bytes.begin() + ptrdiff_t(offset);
            checkpoint.arrays.push_back(
                {entry.at("name").get<std::string>(), {first, first + ptrdiff_t(size)}});
            offset += size;
        }
        if (offset != body) fail_input("{}: damaged: bytes are left behind the last array", name);
    } catch (const nlohmann::json::exception&) {
        fail_input("{}: damaged: the header cannot be read", name);
    }
    require_identity(name, checkpoint.identity, identity);
    return checkpoint;
}

const std::vector<std::byte>& checkpoint_array(const Checkpoint& checkpoint,
                                               const std::filesystem::path& path, const std::string& name,
                                               size_t bytes) {
    for (const CheckpointArray& array : checkpoint.arrays)
        if (array.name == name && array.bytes.size() == bytes) return array.bytes;
    fail_input("{}: the checkpoint has no array '{}' of {} bytes", path.string(), name, bytes);
}

}  // namespace etendue
