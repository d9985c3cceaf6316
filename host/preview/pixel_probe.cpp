#include "host/preview/pixel_probe.h"

namespace etendue {

SeenPoint see_point(PreviewScene& scene, const glm::dvec2& film) {
    struct Record {  // twin of struct SeenPoint in shaders/kernels/see_point.comp
        uint32_t hit;
        glm::vec3 position, normal;
        float distance;
        uint32_t material, surface;
    };
    const Buffer buffer(scene.device, sizeof(Record), "SeenPoints");
    const Kernel kernel =
        make_color_kernel(scene.device, scene.scene, "kernels/see_point.comp", {{"SeenPoints", &buffer}});
    CommandList commands(scene.device);
    commands.dispatch(kernel, 1,
                      {{"receiver", scene.receiver},
                       {"film_x", float(film.x)},
                       {"film_y", float(film.y)},
                       {"film_aspect", float(scene.request.width) / float(scene.request.height)}});
    commands.run();
    const Record r = buffer.read_array<Record>(1)[0];
    return {r.hit != 0, glm::dvec3(r.position) + scene.scene.center, r.normal, r.distance, r.material,
            r.surface};
}

}  // namespace etendue
