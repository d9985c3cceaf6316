#include "host/render/ray_record.h"

#include <algorithm>
#include <tuple>

#include "host/spectra/color.h"
#include "host/spectra/wavelengths.h"

namespace etendue {
namespace {

// Twins of the structs in shaders/features/ray_record.glsl.
struct DeviceCrossing {
    glm::vec3 position;
    uint32_t view;
    glm::vec3 direction;
    uint32_t key;
    glm::vec4 flux;
};
struct DeviceHeader {
    uint32_t count, room, greatest_key, padding;
};
static_assert(sizeof(DeviceCrossing) == 48 && sizeof(DeviceHeader) == 16);

constexpr uint32_t least_room = 1 << 16, most_room = 1 << 20, crossings_a_path = 2;
constexpr double of_room = 0.7;  // that the crossings of a pass are to fill where they are too many

const Receiver& receiver_of(const Scene& scene, const FilmView& view) {
    return *std::find_if(scene.receivers.begin(), scene.receivers.end(),
                         [&](const Receiver& r) { return r.ref == view.receiver; });
}

// As node_frame() of shaders/lib/frames.glsl: rows are the axes.
glm::dmat3 axes_of(const glm::dmat4& world_from_local) {
    const glm::dvec3 z = glm::normalize(glm::dvec3(world_from_local[2]));
    const glm::dvec3 x =
        glm::normalize(glm::dvec3(world_from_local[0]) - z * glm::dot(z, glm::dvec3(world_from_local[0])));
    glm::dvec3 y = glm::cross(z, x);
    if (glm::dot(y, glm::dvec3(world_from_local[1])) < 0) y = -y;
    return glm::transpose(glm::dmat3(x, y, z));
}

uint32_t part_of(uint32_t key, double part) { return uint32_t(double(key) * std::min(part, 1.0)); }

}  // namespace

void CrossingSample::add(std::span<const RayCrossing> more, uint32_t their_greatest_key) {
    crossings.insert(crossings.end(), more.begin(), more.end());
    const auto is_before = [](const RayCrossing& a, const RayCrossing& b) {
        return std::tie(a.key, a.lumens) < std::tie(b.key, b.lumens);
    };
    std::sort(crossings.begin(), crossings.end(), is_before);
    greatest_key = std::min(greatest_key, their_greatest_key);
    if (crossings.size() > most && crossings[most].key > 0)
        greatest_key = std::min(greatest_key, crossings[most].key - 1);
    const auto end =
        std::upper_bound(crossings.begin(), crossings.end(), greatest_key,
                         [](uint32_t key, const RayCrossing& crossing) { return key < crossing.key; });
    crossings.erase(end, crossings.end());
}

bool records_rays(const Scene& scene, const FilmView& view) {
    return receiver_of(scene, view).info->records_rays;
}

CrossingSample crossing_sample(const Scene& scene, const FilmView& view) {
    CrossingSample sample;
    const Receiver& receiver = receiver_of(scene, view);
    for (const Parameter& p : receiver.info->parameters)
        if (receiver.info->records_rays && p.member.name == "limit")
            sample.most = uint64_t(receiver.parameters.value("limit", p.default_value).get<double>());
    if (scene.features.spectral) sample.most = (sample.most + 3) / 4;  // a ray for each wavelength
    return sample;
}

RayRecord::RayRecord(Device& device, const Scene& scene, std::vector<FilmView> views, uint32_t paths_a_pass)
    : scene_(scene),
      views_(std::move(views)),
      room_(uint32_t(std::clamp<uint64_t>(uint64_t(crossings_a_path) * paths_a_pass, least_room, most_room))),
      buffer_(device, sizeof(DeviceHeader) + uint64_t(room_) * sizeof(DeviceCrossing), "Crossings") {
    for (const FilmView& view : views_) samples_.push_back(crossing_sample(scene, view));
    begin_pass();
}

void RayRecord::begin_pass() {
    const DeviceHeader header{0, room_, greatest_key_, 0};
    buffer_.write(&header, sizeof header);
}

bool RayRecord::fits() {
    count_ = buffer_.read_array<DeviceHeader>(1)[0].count;
    if (count_ <= room_) return true;
    greatest_key_ = part_of(greatest_key_, of_room * room_ / count_);
    return false;
}

void RayRecord::end_pass(uint64_t pass, uint32_t seed) {
    std::vector<DeviceCrossing> found(count_);
    buffer_.read(found.data(), found.size() * sizeof(DeviceCrossing), sizeof(DeviceHeader));
    const bool spectral = scene_.features.spectral;
    const Wavelengths w = spectral ? choose_wavelengths(pass, seed) : Wavelengths{};
    uint32_t wanted = 0;
    for (size_t v = 0; v < views_.size(); ++v) {
        if (samples_[v].most == 0) continue;
        const Receiver& receiver = receiver_of(scene_, views_[v]);
        const glm::dmat3 axes = axes_of(receiver.world_from_local);
        const glm::dvec3 from = glm::dvec3(receiver.world_from_local[3]) - scene_.center;
        std::vector<RayCrossing> crossings;
        for (const DeviceCrossing& c : found) {
            if (c.view != v) continue;
            RayCrossing crossing{axes * (1000.0 * (glm::dvec3(c.position) - from)),
                                 glm::normalize(axes * glm::dvec3(c.direction)),
                                 c.key,
                                 0,
                                 spectral ? c.flux * w.share : c.flux,
                                 w.nm};
            glm::dvec3 rgb(c.flux);
            if (spectral) {
                rgb = glm::dvec3(0);
                for (int i = 0; i < 4; ++i) rgb += glm::dvec3(w.rgb[i] * c.flux[i]);
            }
            crossing.lumens = float(luminance(rgb));
            crossings.push_back(crossing);
        }
        samples_[v].add(crossings, greatest_key_);
        wanted = std::max(wanted, samples_[v].greatest_key);
    }
    greatest_key_ = wanted;
    count_ = 0;
}

CrossingSample RayRecord::take(size_t view) {
    CrossingSample taken = samples_[view];
    samples_[view].crossings.clear();
    return taken;
}

}  // namespace etendue
