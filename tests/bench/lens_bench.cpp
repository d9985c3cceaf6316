// Rays per second of sequential tracing through lens files, on one thread.
//
//     lens_bench FILE …
#include <fmt/format.h>

#include <chrono>

#include "host/error.h"
#include "host/lens/pupil_rays.h"

using namespace etendue;

int main(int argc, char** argv) {
    for (int i = 1; i < argc; ++i) {
        try {
            const Prescription p = read_prescription(argv[i]);
            const ParaxialFigures figures = paraxial_figures(p, p.primary_nm());
            const FieldRays rays(p, figures, p.fields[0]);
            const LensTracer tracer(p, p.primary_nm());
            const std::vector<glm::dvec2> grid = pupil_grid(100);
            size_t traced = 0, arrived = 0;
            const auto begin = std::chrono::steady_clock::now();
            double seconds = 0;
            while (seconds < 0.5) {
                for (const glm::dvec2& point : grid) arrived += tracer.trace(rays.ray(point)).passes();
                traced += grid.size();
                seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
            }
            fmt::print("{:.0f}\n", double(traced) / seconds);
            if (arrived == 0) fmt::print(stderr, "{}: no ray arrives\n", argv[i]);
        } catch (const Error& e) {
            fmt::print(stderr, "{}\n", e.what());
            return int(e.code);
        }
    }
}
