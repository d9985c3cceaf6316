#include "host/render/power_ledger.h"

#include "host/render/media_places.h"

namespace etendue {

PowerLedger::PowerLedger(Device& device, const Scene& scene) {
    for (const std::string& name : scene.material_names)
        names_.push_back(name.empty() ? "material without a name" : "material " + name);
    const MediaPlaces media(scene);
    const uint32_t materials = uint32_t(names_.size());
    names_.resize(materials + media.count());
    for (const auto& [ref, name] : scene.medium_names) names_[materials + media.of(ref)] = "medium " + name;
    std::vector<uint32_t> buffer(2 + 2 * names_.size(), 0);
    buffer[0] = materials, buffer[1] = media.stride;
    sums_ = create_buffer(device, buffer, "PowerLedger");
}

std::map<std::string, double> PowerLedger::take() {
    std::vector<uint32_t> words = sums_.read_array<uint32_t>(2 + 2 * names_.size());
    std::map<std::string, double> absorbed;
    for (size_t i = 0; i < names_.size(); ++i) {
        uint32_t& whole = words[2 + 2 * i];
        uint32_t& fraction = words[3 + 2 * i];
        if (whole || fraction) absorbed[names_[i]] += double(int32_t(whole)) + fraction / 4294967296.0;
        whole = fraction = 0;
    }
    sums_.write(words.data(), words.size() * sizeof(uint32_t));
    return absorbed;
}

}  // namespace etendue
