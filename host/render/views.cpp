#include "host/render/views.h"

#include <algorithm>

#include "host/error.h"

namespace etendue {
namespace {

// Twin of struct View in shaders/features/views.glsl.
struct DeviceView {
    uint32_t receiver, index, first_pixel, width, height, element;
    float share;
};

uint32_t element_of(const Scene& scene, uint32_t receiver) {
    const auto found = std::ranges::find(scene.receivers, receiver, &Receiver::ref);
    return found == scene.receivers.end() ? 0 : found->element;
}

}  // namespace

uint64_t pixel_count(std::span<const FilmView> views) {
    uint64_t pixels = 0;
    for (const FilmView& view : views) pixels += view.pixels();
    return pixels;
}

Views::Views(Device& device, const Scene& scene, std::vector<FilmView> views)
    : scene_(scene), buffer_(device, sizeof(uint32_t) + views.size() * sizeof(DeviceView), "Views") {
    if (views.empty() || views.size() > most_views)
        fail_device("a render serves 1 to {} receivers, not {}", most_views, views.size());
    set(std::move(views));
}

void Views::set(std::vector<FilmView> views) {
    views_ = std::move(views);
    const auto& classes = scene_.classes.at(Interface::receiver);
    const auto has_receptor = [&](const FilmView& view) {
        return std::any_of(classes.begin(), classes.end(), [&](const ClassInfo* info) {
            return info->has_receptor && info->tag == view.receiver >> 24;
        });
    };
    const auto others = std::count_if(views_.begin(), views_.end(),
                                      [&](const FilmView& view) { return !has_receptor(view); });
    std::vector<DeviceView> table;
    for (const FilmView& view : views_) {
        const uint32_t index = uint32_t(table.size());
        table.push_back({view.receiver, index, uint32_t(first_pixel(index)), view.width, view.height,
                         element_of(scene_, view.receiver),
                         has_receptor(view) ? 1.0f : 1.0f / float(others)});
    }
    const uint32_t count = uint32_t(table.size());
    buffer_.write(&count, sizeof count);
    buffer_.write(table.data(), table.size() * sizeof(DeviceView), sizeof count);
}

uint64_t Views::first_pixel(size_t view) const { return pixel_count(std::span(views_).first(view)); }

}  // namespace etendue
