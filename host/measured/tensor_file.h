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
#include <fstream>
#include <map>
#include <string>
#include <vector>

namespace etendue {

enum class TensorType : uint8_t { uint8 = 1, uint16 = 3, float32 = 10, float64 = 11 };

struct TensorField {
    TensorType type;
    std::vector<uint64_t> shape;
    uint64_t place, bytes;  // in the file, of all elements
};

// Reads what is asked for, when it is: fields may be larger than memory. What is wrong in the file fails with
// one line: the file, the field, what is allowed.
class TensorFile {
  public:
    explicit TensorFile(const std::filesystem::path& path);

    bool has(const std::string& field) const { return fields_.count(field) > 0; }
    // A field of that type and number of dimensions, none of them empty.
    const TensorField& field(const std::string& name, TensorType type, size_t dimensions) const;
    // `count` elements of such a field from element `first` on.
    template <class T>
    std::vector<T> read(const TensorField& field, uint64_t first, uint64_t count) const {
        std::vector<T> values(count);
        read_bytes(field.place + first * sizeof(T), count * sizeof(T), values.data());
        return values;
    }
    // The numbers of a field of float32, each finite.
    std::vector<float> floats(const std::string& name, size_t dimensions) const;
    // … which rise, at most `most` of them, within [lo, hi].
    std::vector<double> rising(const std::string& name, size_t dimensions, double lo, double hi,
                               size_t most) const;
    const std::string& name() const { return name_; }

  private:
    void read_bytes(uint64_t place, uint64_t count, void* data) const;
    template <class T>
    T next();  // of the list of fields
    std::string next_text(size_t length);

    std::string name_;
    mutable std::ifstream stream_;
    uint64_t size_ = 0, at_ = 0;
    std::map<std::string, TensorField> fields_;
};

std::string shape_text(const std::vector<uint64_t>& shape);  // "2 x 3"

}  // namespace etendue
