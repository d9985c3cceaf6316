// What readers of ray files share: numbers at places in a large file, and rays that are checked.
#pragma once
#include <cstring>
#include <fstream>
#include <functional>
#include <span>

#include "host/error.h"
#include "host/photometry/ray_file.h"

namespace etendue {

// Numbers are little-endian, as they are here.
class RayReader {
  public:
    explicit RayReader(const std::filesystem::path& file);

    // `byte` counts from 0.
    template <class... Args>
    [[noreturn]] void fail(uint64_t byte, fmt::format_string<Args...> format, Args&&... args) const {
        fail_input("{}: byte {}: {}", name, byte, fmt::format(format, std::forward<Args>(args)...));
    }
    template <class T>
    T number(uint64_t byte) {
        T value;
        read(byte, std::as_writable_bytes(std::span(&value, 1)));
        return value;
    }
    // A whole number within limits.
    int32_t choice(uint64_t byte, const char* what, int32_t least, int32_t most);
    void read(uint64_t byte, std::span<std::byte> bytes);
    // Calls `take` with the `columns` floats of each ray, one after the other.
    void for_each_ray(uint64_t byte, uint64_t count, uint32_t columns,
                      const std::function<void(std::span<const float>)>& take);

    std::string name;
    uint64_t size = 0;  // bytes

  private:
    std::ifstream in_;
};

// Puts rays into a file, one after the other. Messages count them from 1.
class RayCollector {
  public:
    RayCollector(RayFile& file, std::string name, double unit)
        : file_(file), name_(std::move(name)), unit_(unit) {}
    // Fails unless there are 1 to most_rays. `where`: the place that says so.
    void reserve(uint64_t count, const std::string& where);
    // Position (in units), direction, flux. What is not finite, too far, without direction or negative fails.
    void add(std::span<const float> position, std::span<const float> direction, float flux);
    // Of the ray that was added last.
    void add_lumens(float lumens);
    void add_tristimulus(const glm::vec2& xz);
    void add_wavelength(double nm);
    void add_polarization(const RayPolarization& polarization);
    // Fails where all rays are dark; says what was corrected.
    void finish();

  private:
    template <class... Args>
    [[noreturn]] void fail(uint64_t ray, fmt::format_string<Args...> format, Args&&... args) const {
        fail_input("{}: ray {}: {}", name_, ray, fmt::format(format, std::forward<Args>(args)...));
    }
    RayFile& file_;
    std::string name_;
    double unit_;  // mm
    uint64_t turned_ = 0;
};

// One reader a format. `looks_like_…`: whether the beginning of the file is that of the format.
bool looks_like_tm25(RayReader& in);
bool looks_like_zemax(RayReader& in);
bool looks_like_zemax_text(RayReader& in);
bool looks_like_lighttools(RayReader& in);
bool looks_like_speos(RayReader& in);
RayFile read_tm25(RayReader& in);
RayFile read_zemax(RayReader& in);
RayFile read_zemax_text(RayReader& in);
RayFile read_lighttools(RayReader& in);
RayFile read_speos(RayReader& in);

}  // namespace etendue
