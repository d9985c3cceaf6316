#include "host/measured/tensor_file.h"

#include <array>
#include <cmath>
#include <cstring>

#include "host/error.h"
#include "host/image/atomic_file.h"

namespace etendue {
namespace {

// Bytes of an element, by type; 0 where there is no such type.
constexpr std::array<uint64_t, 12> element_bytes = {0, 1, 1, 2, 2, 4, 4, 8, 8, 2, 4, 8};
constexpr size_t max_dimensions = 8;

class Reader {
  public:
    Reader(std::span<const std::byte> bytes, const std::string& name) : bytes_(bytes), name_(name) {}
    template <class T>
    T read() {
        T value;
        std::memcpy(&value, take(sizeof(T)).data(), sizeof(T));
        return value;
    }
    std::string text(size_t length) {
        const auto part = take(length);
        return {reinterpret_cast<const char*>(part.data()), length};
    }

  private:
    std::span<const std::byte> take(size_t count) {
        if (count > bytes_.size() - at_)
            fail_input("{}: the tensor file ends within its list of fields", name_);
        at_ += count;
        return bytes_.subspan(at_ - count, count);
    }
    std::span<const std::byte> bytes_;
    const std::string& name_;
    size_t at_ = 0;
};

}  // namespace

std::string shape_text(const std::vector<uint64_t>& shape) {
    std::string text;
    for (const uint64_t size : shape) text += fmt::format("{}{}", text.empty() ? "" : " x ", size);
    return text;
}

TensorFile::TensorFile(const std::filesystem::path& path)
    : TensorFile(read_whole_file(path), path.string()) {}

TensorFile::TensorFile(std::vector<std::byte> bytes, std::string name)
    : name_(std::move(name)), bytes_(std::move(bytes)) {
    Reader reader(bytes_, name_);
    constexpr char magic[12] = "tensor_file";
    if (bytes_.size() < 18 || std::memcmp(bytes_.data(), magic, sizeof(magic)) != 0)
        fail_input("{}: not a tensor file: it does not begin with \"tensor_file\"", name_);
    reader.text(sizeof(magic));
    const uint8_t major = reader.read<uint8_t>(), minor = reader.read<uint8_t>();
    if (major != 1 || minor != 0)
        fail_input("{}: a tensor file of version {}.{}; allowed: 1.0", name_, major, minor);
    const uint32_t count = reader.read<uint32_t>();
    for (uint32_t i = 0; i < count; ++i) {
        const std::string name = reader.text(reader.read<uint16_t>());
        std::string shown;  // on one line, whatever the file calls it
        for (const char c : name.substr(0, 64)) shown += c >= ' ' && c <= '~' ? c : '?';
        const size_t dimensions = reader.read<uint16_t>();
        const uint8_t type = reader.read<uint8_t>();
        const uint64_t place = reader.read<uint64_t>();
        if (type >= element_bytes.size() || element_bytes[type] == 0)
            fail_input("{}: field {} has type {}; allowed: 1 to 11", name_, shown, type);
        if (dimensions > max_dimensions)
            fail_input("{}: field {} has {} dimensions; allowed: at most {}", name_, shown, dimensions,
                       max_dimensions);
        TensorField field{TensorType(type), {}, {}};
        uint64_t size = element_bytes[type];
        for (size_t d = 0; d < dimensions; ++d) {
            field.shape.push_back(reader.read<uint64_t>());
            // Nothing may be larger than the file, so products stay far below 2^64.
            size = field.shape.back() > bytes_.size() ? bytes_.size() + 1 : size * field.shape.back();
            if (size > bytes_.size()) break;
        }
        if (place > bytes_.size() || size > bytes_.size() - place)
            fail_input("{}: field {} reaches beyond the end of the file, which has {} bytes", name_, shown,
                       bytes_.size());
        field.bytes = std::span(bytes_).subspan(place, size);
        fields_[name] = std::move(field);
    }
}

const TensorField& TensorFile::field(const std::string& name, TensorType type, size_t dimensions) const {
    const auto found = fields_.find(name);
    if (found == fields_.end()) fail_input("{}: field {} is missing", name_, name);
    const TensorField& field = found->second;
    if (field.type != type)
        fail_input("{}: field {} has type {}; allowed: {}", name_, name, int(field.type), int(type));
    if (field.shape.size() != dimensions || field.bytes.empty())
        fail_input("{}: field {} has the shape [{}]; allowed: {} dimensions, none empty", name_, name,
                   shape_text(field.shape), dimensions);
    return field;
}

std::vector<float> TensorFile::floats(const std::string& name, size_t dimensions) const {
    const TensorField& found = field(name, TensorType::float32, dimensions);
    std::vector<float> values(found.bytes.size() / sizeof(float));
    std::memcpy(values.data(), found.bytes.data(), values.size() * sizeof(float));
    for (size_t i = 0; i < values.size(); ++i)
        if (!std::isfinite(values[i])) fail_input("{}: field {}: number {} is not finite", name_, name, i);
    return values;
}

}  // namespace etendue
