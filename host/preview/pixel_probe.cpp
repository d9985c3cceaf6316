#include "host/preview/pixel_probe.h"

#include <optional>

#include "host/render/start_media.h"

namespace etendue {

SeenPoint see_point(PreviewScene& scene, const glm::dvec2& film) {
    struct Record {  // twin of struct SeenPoint in shaders/kernels/see_point.comp
        uint32_t hit;
        glm::vec3 position, normal;
        float distance;
        uint32_t material, surface;
    };
    const Buffer buffer(scene.device, sizeof(Record), "SeenPoints");
    const float film_aspect = float(scene.request.width) / float(scene.request.height);
    const Views views(scene.device, scene.scene,
                      {{scene.receiver, scene.request.width, scene.request.height}});
    BufferTable table = views.buffers();
    table["SeenPoints"] = &buffer;
    std::optional<StartMedia> start_media;  // where the way of a ray depends on the medium that it starts in
    if (scene.scene.features.bending || scene.scene.features.body_count > 0) {
        start_media.emplace(scene.device, scene.scene, views, false);
        start_media->find();
        table["StartMedia"] = &start_media->buffer();
    }
    const Kernel kernel = make_color_kernel(scene.device, scene.scene, "kernels/see_point.comp", table);
    CommandList commands(scene.device);
    commands.dispatch(kernel, 1,
                      {{"receiver", scene.receiver},
                       {"film_x", float(film.x)},
                       {"film_y", float(film.y)},
                       {"aspect", film_aspect}});
    commands.run();
    const Record r = buffer.read_array<Record>(1)[0];
    return {r.hit != 0, glm::dvec3(r.position) + scene.scene.center, r.normal, r.distance, r.material,
            r.surface};
}

PixelReading read_pixel(PreviewScene& scene, const glm::uvec2& pixel) {
    PixelReading reading;
    reading.pixel = pixel;
    const glm::dvec2 film = (glm::dvec2(pixel) + 0.5) / glm::dvec2(scene.request.width, scene.request.height);
    reading.seen = see_point(scene, film);
    if (reading.seen.hit) {
        const auto& materials = scene.live.description().materials;
        if (reading.seen.material < materials.size())
            reading.material = materials[reading.seen.material].name;
        const auto used = scene.scene.classes.find(Interface::surface);
        if (used != scene.scene.classes.end())
            for (const ClassInfo* info : used->second)
                if (info->tag == reading.seen.surface >> 24) reading.surface_class = info->name;
    }
    Image spectra;
    spectra.width = (scene.request.width + scene.step - 1) / scene.step;
    spectra.height = (scene.request.height + scene.step - 1) / scene.step;
    scene.renderer.add_spectra(spectra);
    const size_t at = size_t(film.y * spectra.height) * spectra.width + size_t(film.x * spectra.width);
    for (size_t bin = 0; bin < spectra.channels.size() && spectra.channels[bin].starts_with("S0."); ++bin)
        reading.spectrum.push_back(plane(spectra, bin)[at]);
    return reading;
}

}  // namespace etendue
