// The container of the RGL material database (rgl.epfl.ch/materials): named arrays of numbers in one binary
// file.
//
//     char     magic[12]        "tensor_file" and a zero
//     uint8    version[2]       1, 0
//     uint32   number of fields
//     of each field: uint16 length of its name; the name; uint16 number of dimensions; uint8 type;
//                    uint64 place of its data in the file; uint64 size of each dimension, the slowest first
//
// Little-endian. Types: 1 uint8, 2 int8, 3 uint16, 4 int16, 5 uint32, 6 int32, 7 uint64, 8 int64, 9 float16,
// 10 float32, 11 float64.
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace etendue {

enum class TensorType : uint8_t { uint8 = 1, float32 = 10, float64 = 11 };

struct TensorField {
    TensorType type;
    std::vector<uint64_t> shape;
    std::span<const std::byte> bytes;  // of all elements
};

// Reads the file whole. What is wrong in it fails with one line: the file, the field, what is allowed.
class TensorFile {
  public:
    explicit TensorFile(const std::filesystem::path& path);
    TensorFile(std::vector<std::byte> bytes, std::string name);

    bool has(const std::string& field) const { return fields_.count(field) > 0; }
    // A field of that type and number of dimensions, none of them empty.
    const TensorField& field(const std::string& name, TensorType type, size_t dimensions) const;
    // The numbers of such a field, each finite.
    std::vector<float> floats(const std::string& name, size_t dimensions) const;
    const std::string& name() const { return name_; }

  private:
    std::string name_;
    std::vector<std::byte> bytes_;
    std::map<std::string, TensorField> fields_;
};

std::string shape_text(const std::vector<uint64_t>& shape);  // "2 x 3"

}  // namespace etendue
