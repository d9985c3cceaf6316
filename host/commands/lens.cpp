// etendue lens: what a lens file prescribes, its figures, its section, its rays.
#include <fmt/format.h>

#include "host/commands.h"
#include "host/error.h"
#include "host/image/atomic_file.h"
#include "host/lens/drawing.h"
#include "host/table.h"

namespace etendue {
namespace {

std::string length(double mm) {
    return std::isfinite(mm) ? fmt::format("{:.7g}", mm + 0.0) : "infinite";  // + 0: no -0
}

std::string kind_of(const Prescription& p, size_t i) {
    const LensSurface& s = p.surfaces[i];
    std::string kind;
    const auto add = [&](const std::string& word) { kind += (kind.empty() ? "" : ", ") + word; };
    if (i + 1 == p.surfaces.size()) add("image");
    if (i == p.stop) add("stop");
    if (s.is_mirror) add("mirror");
    if (s.frame_change) add("change of frame");
    if (s.shape.is_cylinder) add("cylinder");
    if (s.shape.conic != 0) add(fmt::format("K {:.7g}", s.shape.conic));
    for (size_t a = 0; a < s.shape.coefficients.size(); ++a)
        if (s.shape.coefficients[a] != 0) add(fmt::format("r^{} {:.7g}", 2 * a + 2, s.shape.coefficients[a]));
    if (s.grating)
        add(fmt::format("grating {:.7g}/mm, order {:g}", s.grating->lines_per_mm, s.grating->order));
    if (s.aperture.inner_radius > 0) add(fmt::format("hole {:.5g}", s.aperture.inner_radius));
    if (s.aperture.center != glm::dvec2(0))
        add(fmt::format("about ({:.5g}, {:.5g})", s.aperture.center.x, s.aperture.center.y));
    return kind;
}

void print_surfaces(const Prescription& p) {
    Table table = {{"surface", "radius", "thickness", "glass", "index", "semi-diameter", "remarks"}};
    table.push_back({"object", "", length(p.object_distance), p.object_glass.name(),
                     fmt::format("{:.6f}", p.object_glass.index(p.primary_nm())), "", ""});
    for (size_t i = 0; i < p.surfaces.size(); ++i) {
        const LensSurface& s = p.surfaces[i];
        const bool is_image = i + 1 == p.surfaces.size();
        const double semi = std::min(s.aperture.semi_diameter, s.aperture.half_size.y);
        table.push_back(
            {s.label,
             s.frame_change           ? ""
             : s.shape.curvature == 0 ? "plane"
                                      : length(1 / s.shape.curvature),
             is_image ? "" : length(s.thickness), s.glass.name(),
             is_image ? "" : fmt::format("{:.6f}", s.glass.index(p.primary_nm())),
             std::isfinite(semi) ? fmt::format("{:.5g}{}", semi, s.aperture.is_stated ? "" : "*") : "",
             kind_of(p, i)});
    }
    fmt::print("{}* as the rays need it; it stops none\n\n", as_text(table));
}

void print_figures(const Prescription& p, const ParaxialFigures& f) {
    const auto line = [](const char* name, const std::string& value) {
        fmt::print("{:<24}{}\n", name, value);
    };
    const bool is_afocal = !std::isfinite(f.focal_length) || std::abs(f.focal_length) > 1e12;
    if (is_afocal) {
        line("focal length", "infinite (afocal)");
    } else {
        line("focal length", length(f.focal_length));
        line("back focal length", length(f.rear_focus));
        line("front focal length", length(-f.front_focus));
        line("principal points", fmt::format("{} behind the first vertex, {} behind the last",
                                             length(f.front_principal), length(f.rear_principal)));
        if (!p.is_telecentric) line("f-number", fmt::format("{:.6g}", f.f_number));
    }
    if (p.is_telecentric)
        line("entrance pupil", "at infinity");
    else
        line("entrance pupil", fmt::format("{} across, {} behind the first vertex",
                                           length(f.entrance_diameter), length(f.entrance_pupil)));
    line("exit pupil",
         fmt::format("{} across, {} behind the last vertex", length(f.exit_diameter), length(f.exit_pupil)));
    if (std::isfinite(p.object_distance))
        line("image of the object", fmt::format("{} behind the last vertex, magnified {:.6g} times",
                                                length(f.image), f.magnification));
    if (p.wavelengths.size() > 1 && !is_afocal) {
        Table table = {{"\nwavelength (nm)", "focal length", "back focal length"}};
        for (const LensWavelength& w : p.wavelengths) {
            const ParaxialFigures at = paraxial_figures(p, w.nm);
            table.push_back({fmt::format("{:.7g}", w.nm), length(at.focal_length), length(at.rear_focus)});
        }
        fmt::print("{}", as_text(table));
    }
}

const char* field_title(Prescription::FieldKind kind) {
    switch (kind) {
        case Prescription::FieldKind::angle:
            return "field (degrees)";
        case Prescription::FieldKind::object_height:
            return "object";
        default:
            return "image";
    }
}

void print_spots(const Prescription& p, const ParaxialFigures& f) {
    Table table = {
        {field_title(p.field_kind), "chief ray x", "y", "rms spot radius", "greatest", "clear pupil"}};
    for (const LensField& field : p.fields) {
        const LensSpot spot = lens_spot(p, f, field);
        const bool is_dark = spot.clear == 0;
        const auto number = [&](double value) {
            return is_dark ? std::string("-") : fmt::format("{:.6g}", value);
        };
        table.push_back({fmt::format("{:.5g}, {:.5g}", field.value.x, field.value.y), number(spot.chief.x),
                         number(spot.chief.y), number(spot.rms), number(spot.greatest),
                         fmt::format("{:.1f} %", 100 * spot.clear)});
    }
    fmt::print("\n{}", as_text(table));
}

const char* fate_name(const TracedRay& traced) {
    switch (traced.fate) {
        case TracedRay::Fate::misses:
            return "misses";
        case TracedRay::Fate::totally_reflected:
            return "totally reflected";
        case TracedRay::Fate::evanescent:
            return "evanescent";
        default:
            return traced.stopped ? "stopped" : "arrives";
    }
}

// A row a ray and surface, with the index behind it; surface "start" is where the ray enters the frame of
// the first.
std::string rays_as_csv(const Prescription& p, const ParaxialFigures& f, size_t across) {
    Table table = {{"field", "wavelength_nm", "pupil_x", "pupil_y", "surface", "x_mm", "y_mm", "z_mm",
                    "direction_x", "direction_y", "direction_z", "index", "fate"}};
    for (size_t i = 0; i < p.fields.size(); ++i) {
        const FieldRays rays(p, f, p.fields[i]);
        for (const LensWavelength& w : p.wavelengths) {
            const LensTracer tracer(p, w.nm);
            for (const glm::dvec2& pupil : pupil_grid(across)) {
                const LensRay start = rays.ray(pupil);
                const TracedRay traced = tracer.trace(start);
                const auto add = [&](const std::string& surface, const LensRay& ray, const Glass& glass) {
                    table.push_back({std::to_string(i + 1)});
                    const auto add_numbers = [&](std::initializer_list<double> values) {
                        for (const double value : values) table.back().push_back(fmt::format("{}", value));
                    };
                    const auto& [x, d] = ray;
                    add_numbers({w.nm, pupil.x, pupil.y});
                    table.back().push_back(surface);
                    add_numbers({x.x, x.y, x.z, d.x, d.y, d.z, glass.index(w.nm)});
                    table.back().push_back(fate_name(traced));
                };
                add("start", start, p.object_glass);
                for (size_t s = 0; s < traced.points.size(); ++s)
                    add(p.surfaces[s].label, traced.points[s], p.surfaces[s].glass);
            }
        }
    }
    return as_csv(table);
}

}  // namespace

int lens_command(const LensOptions& options) {
    if (!options.output.empty()) check_writable(options.output);
    Prescription p = read_prescription(options.lens);
    if (options.object) {
        p.object_distance = *options.object;
        p.surfaces.end()[-2].thickness = paraxial_figures(p, p.primary_nm()).image;
    }
    for (const std::string& warning : p.warnings)
        fmt::print(stderr, "warning: {}: {}\n", printable(p.file), printable(warning));
    const ParaxialFigures figures = paraxial_figures(p, p.primary_nm());
    fmt::print("{}{}lengths in mm, at {:.7g} nm\n\n", printable(p.title), p.title.empty() ? "" : "\n",
               p.primary_nm());
    print_surfaces(p);
    print_figures(p, figures);
    print_spots(p, figures);
    if (options.output.extension() == ".svg")
        write_atomically(options.output, lens_drawing(p, figures, options.rays));
    else if (options.output.extension() == ".csv")
        write_atomically(options.output, rays_as_csv(p, figures, options.rays));
    return 0;
}

}  // namespace etendue
