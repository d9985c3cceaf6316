#include "host/image/checkpoint.h"

#include <cerrno>
#include <cstring>
#include <fstream>

#include "host/error.h"
#include "host/image/atomic_file.h"
#include "host/shallow_json.h"

namespace etendue {
namespace {

const char magic[8] = {'E', 'T', 'D', 'F', 'I', 'L', 'M', '\0'};
const uint32_t format_version = 2;
const int most_levels = 16;  // of the header
const size_t prefix_size = sizeof magic + 2 * sizeof(uint32_t);

template <class T>
void append(std::vector<std::byte>& bytes, const T& value) {
    auto* first = reinterpret_cast<const std::byte*>(&value);
    bytes.insert(bytes.end(), first, first + sizeof value);
}

// The file from its beginning to its end, hashed on the way: checkpoints may be large, and are held once.
class Reader {
  public:
    explicit Reader(const std::filesystem::path& path)
        : name_(path.string()), stream_(path, std::ios::binary) {
        std::error_code unknown;
        if (std::filesystem::is_directory(path, unknown)) errno = EISDIR;
        if (!stream_ || errno == EISDIR) fail_input("{}: cannot be read: {}", name_, std::strerror(errno));
        left_ = std::filesystem::file_size(path, unknown);
    }
    uint64_t left() const { return left_; }  // bytes
    std::vector<std::byte> take(uint64_t size) {
        if (size > left_) fail_input("{}: damaged: the checkpoint is cut short", name_);
        std::vector<std::byte> bytes(size);
        if (!stream_.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(size)))
            fail_input("{}: cannot be read: {}", name_, std::strerror(errno));
        left_ -= size;
        return bytes;
    }

  private:
    std::string name_;
    std::ifstream stream_;
    uint64_t left_ = 0;
};

template <class T>
T read_at(const std::vector<std::byte>& bytes, size_t offset) {
    T value;
    std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
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
                             {"passes", to_json(checkpoint.passes)},
                             {"about", checkpoint.about},
                             {"arrays", nlohmann::json::array()}};
    for (const CheckpointArray& array : checkpoint.arrays)
        header["arrays"].push_back({{"name", array.name}, {"bytes", array.bytes.size()}});
    const std::string text = header.dump();
    std::vector<std::byte> head, tail;
    append(head, magic);
    append(head, format_version);
    append(head, uint32_t(text.size()));
    auto* first = reinterpret_cast<const std::byte*>(text.data());
    head.insert(head.end(), first, first + text.size());
    uint64_t hash = hash_bytes(head);
    std::vector<std::span<const std::byte>> pieces = {head};
    for (const CheckpointArray& array : checkpoint.arrays) {
        hash = hash_bytes(array.bytes, hash);
        pieces.push_back(array.bytes);
    }
    append(tail, hash);
    pieces.push_back(tail);
    write_atomically(path, pieces);
}

Checkpoint read_checkpoint(const std::filesystem::path& path) {
    const std::string name = path.string();
    Reader reader(path);
    std::vector<std::byte> head = reader.take(std::min<uint64_t>(prefix_size, reader.left()));
    if (head.size() < sizeof magic || std::memcmp(head.data(), magic, sizeof magic) != 0)
        fail_input("{}: not a checkpoint of étendue", name);
    if (head.size() < prefix_size) fail_input("{}: damaged: the checkpoint is cut short", name);
    const uint32_t version = read_at<uint32_t>(head, sizeof magic);
    if (version != format_version)
        fail_input("{}: checkpoint format {}, only {} can be read", name, version, format_version);
    const std::vector<std::byte> text = reader.take(read_at<uint32_t>(head, sizeof magic + sizeof version));
    head.insert(head.end(), text.begin(), text.end());
    uint64_t hash = hash_bytes(head);

    Checkpoint checkpoint;
    try {
        const auto* first = reinterpret_cast<const char*>(text.data());
        const auto parsed = parse_shallow_json({first, first + text.size()}, most_levels);
        if (!parsed) fail_input("{}: damaged: the header cannot be read", name);
        const nlohmann::json& header = *parsed;
        checkpoint.identity = header.at("identity");
        checkpoint.passes = passes_from_json(header.at("passes"));
        checkpoint.about = header.at("about");
        for (const nlohmann::json& entry : header.at("arrays")) {
            const auto& array = checkpoint.arrays.emplace_back(
                CheckpointArray{entry.at("name"), reader.take(entry.at("bytes").get<uint64_t>())});
            hash = hash_bytes(array.bytes, hash);
        }
    } catch (const nlohmann::json::exception&) {
        fail_input("{}: damaged: the header cannot be read", name);
    }
    if (reader.left() != sizeof hash || read_at<uint64_t>(reader.take(sizeof hash), 0) != hash)
        fail_input("{}: damaged: the checkpoint is cut short or altered", name);
    return checkpoint;
}

void require_identity(const std::filesystem::path& path, const nlohmann::json& found,
                      const nlohmann::json& wanted, const std::string& elsewhere) {
    nlohmann::json keys = wanted;
    keys.update(found);
    for (const auto& [key, any] : keys.items()) {
        const auto text = [&key = key](const nlohmann::json& identity) {
            if (!identity.contains(key)) return std::string("none");
            const nlohmann::json& value = identity[key];
            return value.is_array() && value.size() == 1 ? value[0].dump() : value.dump();
        };
        if (text(found) != text(wanted))
            fail_input("{}: this checkpoint is of another render: its {} is {}, {} {}", path.string(), key,
                       text(found), elsewhere, text(wanted));
    }
}

std::vector<std::byte>& checkpoint_array(Checkpoint& checkpoint, const std::filesystem::path& path,
                                         const std::string& name, size_t bytes) {
    for (CheckpointArray& array : checkpoint.arrays)
        if (array.name == name && array.bytes.size() == bytes) return array.bytes;
    fail_input("{}: the checkpoint has no array '{}' of {} bytes", path.string(), name, bytes);
}

}  // namespace etendue
