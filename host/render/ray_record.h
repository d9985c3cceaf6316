// Rays written down where forward paths cross receivers that record them (shaders/features/ray_record.glsl).
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "host/render/views.h"

namespace etendue {

struct RayCrossing {
    glm::vec3 position;   // mm, in the frame of the receiver's node, whatever its scale
    glm::vec3 direction;  // unit, likewise
    uint32_t key;         // evenly distributed, whatever the ray
    float lumens;
    glm::vec4 flux;  // lm as linear Rec.709, or with wavelengths W of each
    glm::vec4 nm;    // those wavelengths; 0 in colours
};

// The crossings of a receiver, or an even sample of them: those whose keys are at most `greatest_key`.
// Samples of different passes, united down to the smaller of their greatest keys, are one of them all.
struct CrossingSample {
    uint64_t most = 0;  // crossings to be kept; 0 = the receiver records none
    uint32_t greatest_key = UINT32_MAX;
    std::vector<RayCrossing> crossings;  // in order of their keys
    void add(std::span<const RayCrossing> more, uint32_t their_greatest_key);
    bool is_whole() const { return greatest_key == UINT32_MAX; }
};
bool records_rays(const Scene& scene, const FilmView& view);
// Empty; of as many crossings as the receiver's `limit` of rays allows.
CrossingSample crossing_sample(const Scene& scene, const FilmView& view);

// Collects them, pass after pass.
class RayRecord {
  public:
    RayRecord(Device& device, const Scene& scene, std::vector<FilmView> views, uint32_t paths_a_pass);
    BufferTable buffers() const { return {{"Crossings", &buffer_}}; }
    void begin_pass();
    // After a pass: false where there was no room for its crossings. Then it is to be traced once more, and
    // will find room, since fewer keys are taken from then on.
    bool fits();
    void end_pass(uint64_t pass, uint32_t seed);
    CrossingSample take(size_t view);  // what has been collected since the last call

  private:
    const Scene& scene_;
    std::vector<FilmView> views_;
    std::vector<CrossingSample> samples_;  // a view each
    uint32_t room_, greatest_key_ = UINT32_MAX, count_ = 0;
    Buffer buffer_;
};

}  // namespace etendue
