// Optical elements of class lens_system: the surfaces of a lens as geometry of the scene.
//
// Light runs along +z of the element, from the object to the image; the vertex of the first surface is the
// origin. Glass is closed by absorbing rings around every surface and tubes between them, so that only what
// takes the surfaces in their order comes through. Where nothing folds the axis they are a housing around all
// of the lens, else only around each piece of glass.
#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <map>

#include "host/gltf/import.h"
#include "host/lens/prescription_text.h"
#include "host/lens/pupil_rays.h"
#include "host/lens/trace.h"
#include "host/scene/scene_files.h"

namespace etendue {
namespace {

using nlohmann::json;

constexpr double metre = 1e-3;  // of a mm

LensSurface read_surface(const JsonAt& at, const Glass& before) {
    only_members(
        at, {"radius", "thickness", "material", "ior", "semi_diameter", "conic", "coefficients", "stop"});
    LensSurface s;
    const double radius = number(at, "radius", 0);
    s.shape.curvature = radius == 0 ? 0 : 1 / radius;
    s.shape.conic = number(at, "conic", 0);
    s.thickness = number(at, "thickness", 0);
    s.aperture.semi_diameter = number_value(member(at, "semi_diameter"), DBL_MIN);
    s.aperture.is_stated = true;
    if (const auto coefficients = find_array(at, "coefficients")) {
        s.shape.coefficients.push_back(0);  // of r²
        for (size_t i = 0; i < (*coefficients)->size(); ++i)
            s.shape.coefficients.push_back(number_value(element(*coefficients, i)));
    }
    if (const auto material = find(at, "material")) {
        const std::string name = text_value(*material);
        const Glass* glass = find_glass(name);
        const auto coded = coded_glass(name);
        s.is_mirror = upper(name) == "MIRROR";
        if (!s.is_mirror && !glass && !coded)
            fail_at(*material, "no data of the glass '{}'; allowed: mirror, glasses of {}, codes like 517642",
                    name, known_makers());
        s.glass = s.is_mirror ? before : glass ? *glass : *coded;
    }
    if (const auto ior = find(at, "ior")) {
        const double index = number_value(*ior, 1, 10);
        if (index != 1) s.glass = Glass::constant(fmt::format("{:g}", index), index);
    }
    return s;
}

Prescription read_surfaces(const JsonAt& at) {
    require_array(at);
    Prescription p;
    for (size_t i = 0; i < at->size(); ++i) {
        const JsonAt row = element(at, i);
        if (boolean(row, "stop", false)) p.stop = p.surfaces.size();
        p.surfaces.push_back(read_surface(row, p.glass_before(p.surfaces.size())));
    }
    if (p.surfaces.empty()) fail_at(at, "is empty; allowed: at least one surface");
    LensSurface image;
    image.glass = p.surfaces.back().glass;
    p.surfaces.push_back(image);
    finish_prescription({*at.file + ": " + at.pointer, {}}, p, 1 / metre);
    check_prescription(p);
    return p;
}

Prescription read_lens(GltfImport& import, const JsonAt& at) {
    const auto file = find(at, "file"), surfaces = find(at, "surfaces");
    if (file.has_value() == surfaces.has_value())
        fail_at(at, "names {}; allowed: one of file and surfaces",
                file ? "both" : "neither file nor surfaces");
    if (surfaces) return read_surfaces(*surfaces);
    const std::filesystem::path path = named_file(import.scene, text_value(*file));
    import.scene.buffer_files.push_back(path);
    Prescription p = read_prescription(path);
    for (const std::string& warning : p.warnings) warn(import, *file, warning);
    return p;
}

json ior_of(const Glass& glass) {
    if (glass.formula() == Glass::Formula::constant) return glass.coefficients()[0];
    return {{glass.formula() == Glass::Formula::sellmeier ? "sellmeier" : "cauchy", glass.coefficients()}};
}

class LensBuilder {
  public:
    LensBuilder(GltfImport& import, const JsonAt& at, const Prescription& p)
        : import_(import), at_(at), p_(p), frames_(lens_frames(p)), ghosts_(boolean(at, "ghosts", false)) {
        is_folded_ = std::ranges::any_of(p.surfaces,
                                         [](const LensSurface& s) { return s.is_mirror || s.frame_change; });
        for (size_t i = 0; i + 1 < p.surfaces.size(); ++i)
            if (!p.surfaces[i].frame_change) widest_ = std::max(widest_, rim_radius(i));
        widest_ *= 1.001;
    }

    void build() {
        bool backward = false;  // light runs towards -z
        for (size_t i = 0; i + 1 < p_.surfaces.size(); ++i) {
            const LensSurface& s = p_.surfaces[i];
            if (s.frame_change) {
                if (!s.glass.is_air()) fail("changes its frame within glass; allowed: in air", i);
                continue;
            }
            check(i);
            if (s.is_mirror)
                add_surface(i, mirror(s.glass));
            else if (s.glass != p_.glass_before(i))
                add_surface(i, interface(backward ? s.glass : p_.glass_before(i),
                                         backward ? p_.glass_before(i) : s.glass));
            if (s.is_mirror) backward = !backward;
            add_rim(i);
            if (const double radius = tube_radius(i + 1)) add_tube(i, radius);
        }
    }

  private:
    [[noreturn]] void fail(const std::string& what, size_t i) const {
        fail_at(at_, "{}: {}", p_.name_of(i), what);
    }

    void check(size_t i) const {
        const LensSurface& s = p_.surfaces[i];
        const LensAperture& a = s.aperture;
        if (s.shape.is_cylinder) fail("is a cylinder; allowed in a scene: surfaces about the axis", i);
        if (s.grating) fail("is ruled; allowed in a scene: surfaces that are not", i);
        if (is_framed(a) && (s.is_mirror || s.shape.curvature != 0 || s.glass != p_.glass_before(i)))
            fail("its aperture is not round about the axis; allowed in a scene: that of a plane in air", i);
        const std::vector<double>& a_r = s.shape.coefficients;
        if ((!a_r.empty() && a_r[0] != 0) || a_r.size() > 9)
            fail("has a coefficient of r² or of more than r¹⁸; allowed in a scene: r⁴ to r¹⁸", i);
    }

    static bool is_framed(const LensAperture& a) {
        return std::isfinite(a.half_size.x) || std::isfinite(a.half_size.y) || a.center != glm::dvec2(0);
    }
    // mm. Sizes that only the rays of the design need have some room.
    double rim_radius(size_t i) const {
        const LensAperture& a = p_.surfaces[i].aperture;
        const double radius = std::isfinite(a.semi_diameter) ? a.semi_diameter : a.extent();
        return a.is_stated || i == p_.stop ? radius : std::min(1.01 * radius, p_.surfaces[i].shape.reach());
    }
    // mm: of the tube between a surface and the one before; 0 = none.
    double tube_radius(size_t i) const {
        if (i == 0 || i + 1 >= p_.surfaces.size()) return 0;
        if (!is_folded_) return widest_;
        const bool is_apart = p_.glass_before(i).is_air() || p_.surfaces[i].frame_change;
        return is_apart ? 0 : 1.001 * std::max(rim_radius(i - 1), rim_radius(i));
    }
    double rim_height(size_t i) const { return p_.surfaces[i].shape.sag(rim_radius(i), 0); }

    void add_surface(size_t i, uint32_t material) {
        const SurfaceShape& shape = p_.surfaces[i].shape;
        const double hole = p_.surfaces[i].aperture.inner_radius;
        json parameters{{"curvature", shape.curvature / metre},
                        {"conic", shape.conic},
                        {"aperture", rim_radius(i) * metre}};
        double power = metre * metre * metre;
        for (size_t k = 1; k < shape.coefficients.size(); ++k, power *= metre * metre)
            parameters["coefficients"].push_back(shape.coefficients[k] / power);
        if (hole > 0) parameters["hole"] = hole * metre;
        add(i, "asphere", parameters, 0, material);
        if (hole > 0 && !p_.surfaces[i].is_mirror) {  // what obstructs it
            parameters["aperture"] = hole * metre;
            parameters.erase("hole");
            add(i, "asphere", parameters, 0, black());
        }
    }

    // Around a surface, from its rim outward.
    void add_rim(size_t i) {
        const LensSurface& s = p_.surfaces[i];
        const bool is_stop = !s.is_mirror && s.glass.is_air() && p_.glass_before(i).is_air();
        if (is_stop && !s.aperture.is_stated && i != p_.stop) return;
        const double outer = is_stop ? widest_ : std::max(tube_radius(i), tube_radius(i + 1));
        if (is_stop && is_framed(s.aperture)) return add_frame(i, outer);
        const double hole = rim_radius(i) * (1 - 1e-6);
        if (is_stop && s.aperture.inner_radius > 0)
            add(i, "disk", {{"radius", s.aperture.inner_radius * metre}}, 0, black());
        if (outer > hole && !s.is_mirror)
            add(i, "disk", {{"radius", outer * metre}, {"hole", hole * metre}}, rim_height(i), black());
    }

    // Around a rectangular aperture, which need not lie about the axis: plates above, below and beside it.
    void add_frame(size_t i, double outer) {
        const LensAperture& a = p_.surfaces[i].aperture;
        const glm::dvec2 half = glm::min(a.half_size, glm::dvec2(outer)), lo = a.center - half,
                         hi = a.center + half;
        const auto plate = [&](glm::dvec2 from, glm::dvec2 to) {
            const glm::dvec2 size = (to - from) * metre, middle = 0.5 * (from + to);
            if (size.x > 0 && size.y > 0)
                add(i, "rectangle", {{"size", {size.x, size.y}}}, 0, black(), middle);
        };
        plate({-outer, -outer}, {lo.x, outer});
        plate({hi.x, -outer}, {outer, outer});
        plate({lo.x, -outer}, {hi.x, lo.y});
        plate({lo.x, hi.y}, {hi.x, outer});
    }

    void add_tube(size_t i, double radius) {
        const double from = rim_height(i), to = p_.surfaces[i].thickness + rim_height(i + 1);
        if (from == to) return;
        add(i, "cylinder", {{"radius", radius * metre}, {"height", std::abs(to - from) * metre}},
            0.5 * (from + to), black());
    }

    // At a place in the frame of a surface, mm.
    void add(size_t i, const char* geometry, const json& parameters, double z, uint32_t material,
             glm::dvec2 xy = {}) {
        glm::dmat4 place(frames_[i].turn);
        place[3] = glm::dvec4((frames_[i].shift + frames_[i].turn * glm::dvec3(xy, z)) * metre, 1);
        import_.scene.shapes.push_back({"surface " + p_.surfaces[i].label,
                                        {geometry, parameters, at_.pointer},
                                        import_.content_root * place,
                                        material});
    }

    // The name of a glass's medium; of air none.
    std::string medium(const Glass& glass) {
        if (glass.is_air()) return "";
        const json parameters{{"ior", ior_of(glass)}};
        std::string name = "glass " + glass.name();
        for (;; name += "'") {
            const auto same = std::ranges::find(import_.scene.media, name, &MediumDescription::name);
            if (same == import_.scene.media.end()) break;
            if (same->medium.parameters == parameters) return name;
        }
        import_.scene.media.push_back({name, {"homogeneous", parameters, at_.pointer}});
        return name;
    }

    uint32_t add_material(const std::string& name, const char* surface, const json& parameters,
                          const Glass& below = {}, const Glass& above = {}) {
        const auto known = materials_.find(name);
        if (known != materials_.end()) return known->second;
        MaterialDescription material;
        material.name = name, material.surface = {surface, parameters, at_.pointer};
        material.inside = medium(below), material.outside = medium(above);
        import_.scene.materials.push_back(material);
        return materials_[name] = uint32_t(import_.scene.materials.size() - 1);
    }
    static std::string name_of(const Glass& glass) { return glass.is_air() ? "air" : glass.name(); }
    uint32_t interface(const Glass& below, const Glass& above) {
        return add_material(name_of(below) + " to " + name_of(above),
                            ghosts_ ? "dielectric" : "antireflective", json::object(), below, above);
    }
    uint32_t mirror(const Glass& around) {
        return add_material("mirror in " + name_of(around), "conductor", {{"reflectance", 1}}, around,
                            around);
    }
    uint32_t black() { return add_material("lens housing", "absorber", json::object()); }

    GltfImport& import_;
    const JsonAt& at_;
    const Prescription& p_;
    const std::vector<FrameChange> frames_;
    const bool ghosts_;
    bool is_folded_ = false;
    double widest_ = 0;  // mm
    std::map<std::string, uint32_t> materials_;
};

}  // namespace

void place_lens_system(GltfImport& import, const JsonAt& at) {
    only_members(at, {"class", "file", "surfaces", "ghosts"});
    const Prescription p = read_lens(import, at);
    LensBuilder(import, at, p).build();
}

}  // namespace etendue
