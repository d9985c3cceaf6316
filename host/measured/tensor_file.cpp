#include "host/measured/tensor_file.h"

#include <array>
#include <cmath>
#include <cstring>

#include "host/error.h"

namespace etendue {
namespace {

// Bytes of an element, by type; 0 where there is no such type.
constexpr std::array<uint64_t, 12> element_bytes = {0, 1, 1, 2, 2, 4, 4, 8, 8, 2, 4, 8};
constexpr size_t max_dimensions = 8;

}  // namespace

std::string shape_text(const std::vector<uint64_t>& shape) {
    std::string text;
    for (const uint64_t size : shape) text += fmt::format("{}{}", text.empty() ? "" : " x ", size);
    return text;
}

void TensorFile::read_bytes(uint64_t place, uint64_t count, void* data) const {
    stream_.seekg(std::streamoff(place));
    stream_.read(static_cast<char*>(data), std::streamsize(count));
    if (!stream_) fail_input("{}: cannot be read", name_);
}

std::string TensorFile::next_text(size_t length) {
    if (length > size_ - at_) fail_input("{}: the tensor file ends within its list of fields", name_);
    std::string text(length, '\0');
    read_bytes(at_, length, text.data());
    at_ += length;
    return text;
}

template <class T>
T TensorFile::next() {
    T value;
    std::memcpy(&value, next_text(sizeof(T)).data(), sizeof(T));
    return value;
}

TensorFile::TensorFile(const std::filesystem::path& path)
    : name_(path.string()), stream_(path, std::ios::binary) {
    std::error_code error;
    size_ = std::filesystem::file_size(path, error);
    if (error || !stream_)
        fail_input("{}: cannot be read: {}", name_, error ? error.message() : std::strerror(errno));
    const std::string magic("tensor_file", 12);
    if (size_ < 18 || next_text(magic.size()) != magic)
        fail_input("{}: not a tensor file: it does not begin with \"tensor_file\"", name_);
    const uint8_t major = next<uint8_t>(), minor = next<uint8_t>();
    if (major != 1 || minor != 0)
        fail_input("{}: a tensor file of version {}.{}; allowed: 1.0", name_, major, minor);
    const uint32_t count = next<uint32_t>();
    for (uint32_t i = 0; i < count; ++i) {
        const std::string name = next_text(next<uint16_t>());
        const std::string shown = name.substr(0, 64);
        const size_t dimensions = next<uint16_t>();
        const uint8_t type = next<uint8_t>();
        const uint64_t place = next<uint64_t>();
        if (type >= element_bytes.size() || element_bytes[type] == 0)
            fail_input("{}: field {} has type {}; allowed: 1 to 11", name_, shown, type);
        if (dimensions > max_dimensions)
            fail_input("{}: field {} has {} dimensions; allowed: at most {}", name_, shown, dimensions,
                       max_dimensions);
        TensorField field{TensorType(type), {}, place, element_bytes[type]};
        for (size_t d = 0; d < dimensions; ++d) {
            const uint64_t size = next<uint64_t>();
            field.shape.push_back(size);
            // What is larger than the file is so by one byte, so that no product exceeds 2^64.
            const bool fits = field.bytes == 0 || size <= size_ / field.bytes;
            field.bytes = fits ? size * field.bytes : size_ + 1;
        }
        if (place > size_ || field.bytes > size_ - place)
            fail_input("{}: field {} reaches beyond the end of the file, which has {} bytes", name_, shown,
                       size_);
        fields_[name] = std::move(field);
    }
}

const TensorField& TensorFile::field(const std::string& name, TensorType type, size_t dimensions) const {
    const auto found = fields_.find(name);
    if (found == fields_.end()) fail_input("{}: field {} is missing", name_, name);
    const TensorField& field = found->second;
    if (field.type != type)
        fail_input("{}: field {} has type {}; allowed: {}", name_, name, int(field.type), int(type));
    if (field.shape.size() != dimensions || field.bytes == 0)
        fail_input("{}: field {} has the shape [{}]; allowed: {} dimensions, none empty", name_, name,
                   shape_text(field.shape), dimensions);
    return field;
}

std::vector<float> TensorFile::floats(const std::string& name, size_t dimensions) const {
    const TensorField& found = field(name, TensorType::float32, dimensions);
    const std::vector<float> values = read<float>(found, 0, found.bytes / sizeof(float));
    for (size_t i = 0; i < values.size(); ++i)
        if (!std::isfinite(values[i])) fail_input("{}: field {}: number {} is not finite", name_, name, i);
    return values;
}

std::vector<double> TensorFile::rising(const std::string& name, size_t dimensions, double lo, double hi,
                                       size_t most) const {
    const std::vector<float> values = floats(name, dimensions);
    if (values.size() > most)
        fail_input("{}: field {} has {} numbers; allowed: at most {}", name_, name, values.size(), most);
    for (size_t i = 0; i < values.size(); ++i)
        if (!(values[i] >= lo && values[i] <= hi) || (i > 0 && !(values[i] > values[i - 1])))
            fail_input("{}: field {}: number {} is {}; allowed: numbers that rise, in [{:.6g}, {:.6g}]",
                       name_, name, i, values[i], lo, hi);
    return {values.begin(), values.end()};
}

}  // namespace etendue
