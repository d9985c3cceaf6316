#include "host/lens/paraxial.h"

#include "host/error.h"

namespace etendue {
namespace {

constexpr double far_pupil = 1e10;  // mm, of a telecentric lens

ParaxialMatrix operator*(const ParaxialMatrix& l, const ParaxialMatrix& r) {
    return {l.a * r.a + l.b * r.c, l.a * r.b + l.b * r.d, l.c * r.a + l.d * r.c, l.c * r.b + l.d * r.d};
}

// Signed index behind each surface: light towards -z has a negative one.
std::vector<double> signed_indices(const Prescription& p, double nm) {
    std::vector<double> indices;
    double sign = 1;
    for (const LensSurface& s : p.surfaces) {
        if (s.is_mirror) sign = -sign;
        indices.push_back(sign * s.glass.index(nm));
    }
    return indices;
}

// From before surface `first` to the vertex of surface `last`, before or behind its refraction.
ParaxialMatrix between(const Prescription& p, const std::vector<double>& indices, size_t first, size_t last,
                       double nm, bool with_last) {
    ParaxialMatrix m;
    for (size_t i = first; i <= last; ++i) {
        if (i > first) m = ParaxialMatrix{1, p.surfaces[i - 1].thickness / indices[i - 1], 0, 1} * m;
        if (i == last && !with_last) break;
        const double before = i == 0 ? p.object_glass.index(nm) : indices[i - 1];
        m = ParaxialMatrix{1, 0, -(indices[i] - before) * p.surfaces[i].shape.vertex_curvature(), 1} * m;
    }
    return m;
}

double entrance_diameter(const Prescription& p, const ParaxialFigures& f, double stop_scale) {
    using Kind = Prescription::PupilKind;
    const double to_pupil = p.object_distance + f.entrance_pupil;
    switch (p.pupil_kind) {
        case Kind::entrance_diameter:
            return p.pupil;
        case Kind::f_number:
            return std::abs(f.focal_length) / p.pupil;
        case Kind::object_aperture: {
            const double sine = p.pupil / f.index_before;
            return 2 * std::abs(to_pupil) * sine / std::sqrt(1 - sine * sine);
        }
        case Kind::working_f_number: {
            if (std::isinf(p.object_distance)) return std::abs(f.focal_length) / p.pupil;
            // A ray from the object's point on the axis with n u = 1.
            const double behind = f.matrix.c * p.object_distance / f.index_before + f.matrix.d;
            return std::abs(to_pupil / f.index_before * f.index_behind / behind / p.pupil);
        }
        default:
            return 2 * p.surfaces[p.stop].aperture.semi_diameter / std::abs(stop_scale);
    }
}

}  // namespace

ParaxialFigures paraxial_figures(const Prescription& p, double nm) {
    const size_t last = p.surfaces.size() - 2;
    const std::vector<double> indices = signed_indices(p, nm);
    ParaxialFigures f;
    f.matrix = between(p, indices, 0, last, nm, true);
    f.index_before = p.object_glass.index(nm), f.index_behind = indices[last];
    const ParaxialMatrix& m = f.matrix;
    f.focal_length = -1 / m.c;
    f.front_focus = f.index_before * m.d / m.c;
    f.rear_focus = -f.index_behind * m.a / m.c;
    f.front_principal = f.front_focus + f.index_before * f.focal_length;
    f.rear_principal = f.rear_focus - f.index_behind * f.focal_length;

    const ParaxialMatrix to_stop = between(p, indices, 0, std::min(p.stop, last), nm, false),
                         from_stop = between(p, indices, std::min(p.stop, last), last, nm, true);
    // from_stop starts behind the vertex of the stop, before its refraction.
    f.entrance_pupil = p.is_telecentric ? far_pupil : f.index_before * to_stop.b / to_stop.a;
    f.exit_pupil = -f.index_behind * from_stop.b / from_stop.d;
    f.entrance_diameter = entrance_diameter(p, f, to_stop.a);
    f.exit_diameter = std::abs(f.entrance_diameter * to_stop.a / from_stop.d);
    f.f_number = std::abs(f.focal_length) / f.entrance_diameter;
    if (std::isinf(p.object_distance)) {
        f.image = f.rear_focus, f.magnification = 0;
    } else {
        const double distance = p.object_distance / f.index_before;
        f.image = -f.index_behind * (m.a * distance + m.b) / (m.c * distance + m.d);
        f.magnification = 1 / (m.c * distance + m.d);
    }
    return f;
}

}  // namespace etendue
