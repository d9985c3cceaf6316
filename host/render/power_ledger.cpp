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
    for (const PlacedElement& element : scene.elements)
        elements_.push_back(element.name.empty() ? "element without a name" : element.name);
    std::vector<uint32_t> buffer(3 + 2 * (names_.size() + 3 * elements_.size()), 0);
    buffer[0] = materials, buffer[1] = media.stride, buffer[2] = uint32_t(names_.size());
    sums_ = create_buffer(device, buffer, "PowerLedger");
}

void PowerLedger::take(std::map<std::string, double>& absorbed_by,
                       std::map<std::string, ElementPower>& elements) {
    const size_t places = names_.size() + 3 * elements_.size();
    std::vector<uint32_t> words = sums_.read_array<uint32_t>(3 + 2 * places);
    const auto taken = [&](size_t place) {
        uint32_t& whole = words[3 + 2 * place];
        uint32_t& fraction = words[4 + 2 * place];
        const double sum = double(int32_t(whole)) + fraction / 4294967296.0;
        whole = fraction = 0;
        return sum;
    };
    for (size_t i = 0; i < names_.size(); ++i)
        if (const double sum = taken(i); sum != 0) absorbed_by[names_[i]] += sum;
    for (size_t i = 0; i < elements_.size(); ++i) {
        const size_t first = names_.size() + 3 * i;
        const ElementPower power{taken(first), taken(first + 1), taken(first + 2)};
        if (power.entered != 0 || power.left != 0 || power.absorbed != 0) elements[elements_[i]] += power;
    }
    sums_.write(words.data(), words.size() * sizeof(uint32_t));
}

}  // namespace etendue
