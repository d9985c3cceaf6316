// What the tests of geometry classes know of each beside its contract, in double precision, and one object of
// a class asked through the interface on the device.
#pragma once
#include <doctest/doctest.h>
#include <cmath>
#include <cstring>
#include <functional>
#include <map>
#include <optional>
#include <random>

#include "host/lens/surface_shape.h"
#include "tests/support/geometry_probe.h"
#include "tests/support/light_probe.h"
#include "tests/support/random.h"

namespace etendue {

// What the tests know of a class beside its contract.
struct Oracle {
    nlohmann::json parameters;
    // In double precision: distances of all crossings of the line, in any order.
    std::function<std::vector<double>(glm::dvec3 origin, glm::dvec3 direction)> crossings;
    // Signed distance of a point near the surface from it (rims aside).
    std::function<double(glm::dvec3)> distance;
    Box bounds;
    bool is_samplable = true, is_convex = true;
};

inline const glm::dvec3 corner[3] = {{-0.7, -0.4, 0.2}, {0.9, -0.3, -0.5}, {0.1, 0.8, 0.6}};

inline std::vector<double> quadratic(double a, double b, double c) {  // a t² + 2 b t + c
    const double d = b * b - a * c;
    if (!(d >= 0) || a == 0) return {};
    return {(-b - std::sqrt(d)) / a, (-b + std::sqrt(d)) / a};
}

// Of microstructure, with these parameters: the middle of the dome over a place, if there is one.
inline const nlohmann::json domes = {{"size", {1.5, 0.75}},
                                     {"pitch", {0.3125, 0.21875}},
                                     {"radius", 0.09375},
                                     {"depth", 0.0625},
                                     {"placement", "staggered"},
                                     {"density", 0.75},
                                     {"seed", 5}};
constexpr double cell_width = 0.3125, cell_height = 0.21875, dome_radius = 0.09375, dome_depth = 0.0625;
constexpr double dome_curvature = (dome_radius * dome_radius + dome_depth * dome_depth) / (2 * dome_depth);
inline std::optional<glm::dvec3> dome_over(const glm::dvec3& p) {
    const int columns = 4, rows = 3;
    const int row = int(std::floor(p.y / cell_height + 0.5 * rows));
    const double start = ((row & 1 ? 0.25 : -0.25) - 0.5 * columns) * cell_width;
    const int column = int(std::floor((p.x - start) / cell_width));
    if (row < 0 || row >= rows || column < 0 || column >= columns) return {};
    // hash_3d of shaders/lib/hash.glsl.
    glm::uvec3 v = glm::uvec3(column, row, 5) * 1664525u + 1013904223u;
    for (int round = 0; round < 2; ++round) {
        v.x += v.y * v.z, v.y += v.z * v.x, v.z += v.x * v.y;
        if (round == 0) v ^= v >> 16u;
    }
    if (float(v.z >> 8) / 16777216.0f >= 0.75f) return {};
    return glm::dvec3(start + (column + 0.5) * cell_width, (row + 0.5 - 0.5 * rows) * cell_height,
                      dome_depth - dome_curvature);
}
inline bool dome_covers(const std::optional<glm::dvec3>& dome, const glm::dvec3& p) {
    return dome && std::hypot(p.x - dome->x, p.y - dome->y) < dome_radius;
}
// Where a height along a ray is 0 between two t, `speed` being the ray's metres a unit of t: by steps, then
// halves; a pair of crossings within a step about where the height is least, by thirds.
inline std::vector<double> crossings_between(const std::function<double(double)>& at, double low, double high,
                                             int steps, double speed) {
    std::vector<double> found;
    if (!(low < high)) return found;
    const auto solve = [&](double l, double r) {
        const double side = at(l);
        for (int k = 0; k < 50; ++k) (side * at(0.5 * (l + r)) > 0 ? l : r) = 0.5 * (l + r);
        found.push_back(0.5 * (l + r));
    };
    double a = low, at_a = at(a);
    for (int i = 1; i <= steps; ++i) {
        const double b = low + (high - low) * i / steps, at_b = at(b);
        if (at_a * at_b <= 0) {
            solve(a, b);
        } else if (std::min(std::abs(at_a), std::abs(at_b)) < 3 * (b - a) * speed) {
            double l = a, r = b;
            for (int k = 0; k < 40; ++k) {
                const double m = l + (r - l) / 3, n = r - (r - l) / 3, at_m = at(m), at_n = at(n);
                if (std::min(at_m * at_a, at_n * at_a) <= 0) {
                    const double middle = at_m * at_a <= 0 ? m : n;
                    solve(a, middle), solve(middle, b);
                    break;
                }
                (std::abs(at_m) < std::abs(at_n) ? r : l) = std::abs(at_m) < std::abs(at_n) ? n : m;
            }
        }
        a = b, at_a = at_b;
    }
    return found;
}

// Of the class `asphere`: all crossings within the rim.
struct AsphereOracle {
    SurfaceShape shape;
    double aperture;

    double height(glm::dvec3 p) const {
        const double r = std::hypot(p.x, p.y), reach = shape.reach();
        return p.z - (r < reach ? shape.sag(p.x, p.y) : shape.sag(reach, 0));
    }
    std::vector<double> crossings(glm::dvec3 o, glm::dvec3 d) const {
        // Within the cylinder of the rim, and between planes beyond the surface.
        double low = (d.z > 0 ? -3 - o.z : 3 - o.z) / d.z, high = (d.z > 0 ? 3 - o.z : -3 - o.z) / d.z;
        if (d.x != 0 || d.y != 0) {
            const std::vector<double> ends = quadratic(d.x * d.x + d.y * d.y, o.x * d.x + o.y * d.y,
                                                       o.x * o.x + o.y * o.y - aperture * aperture);
            if (ends.empty()) return {};
            low = d.z == 0 ? ends[0] : std::max(low, ends[0]),
            high = d.z == 0 ? ends[1] : std::min(high, ends[1]);
        } else if (std::hypot(o.x, o.y) > aperture) {
            return {};
        }
        const auto at = [&](double t) { return height(o + t * d); };
        return crossings_between(at, low, high, 32, glm::length(d));
    }
    double distance(glm::dvec3 p) const { return height(p) * shape.normal(p).z; }
};

// Of the class `bezier_patch`: the graph of z = sum of c[j][i] (x / X)^i (y / Y)^j over |x| < X, |y| < Y.
struct GraphOracle {
    double c[4][4], half_x, half_y;

    double height(double x, double y) const {
        double z = 0;
        for (int j = 3; j >= 0; --j) {
            double row = 0;
            for (int i = 3; i >= 0; --i) row = row * (x / half_x) + c[j][i];
            z = z * (y / half_y) + row;
        }
        return z;
    }
    // Bernstein's coefficients of (2 u - 1)^i, u from 0 to 1.
    nlohmann::json control_points() const {
        const double power[4][4] = {
            {1, 1, 1, 1}, {-1, -1 / 3.0, 1 / 3.0, 1}, {1, -1 / 3.0, -1 / 3.0, 1}, {-1, 1, -1, 1}};
        nlohmann::json points = nlohmann::json::array();
        for (int l = 0; l < 4; ++l)
            for (int k = 0; k < 4; ++k) {
                double z = 0;
                for (int j = 0; j < 4; ++j)
                    for (int i = 0; i < 4; ++i) z += c[j][i] * power[i][k] * power[j][l];
                points.push_back({half_x * power[1][k], half_y * power[1][l], z});
            }
        return points;
    }
    glm::dvec3 normal(const glm::dvec3& p) const {
        const double h = 1e-6;
        return glm::normalize(glm::dvec3(-(height(p.x + h, p.y) - height(p.x - h, p.y)) / (2 * h),
                                         -(height(p.x, p.y + h) - height(p.x, p.y - h)) / (2 * h), 1));
    }
    double distance(const glm::dvec3& p) const { return (p.z - height(p.x, p.y)) * normal(p).z; }
    std::vector<double> crossings(const glm::dvec3& o, const glm::dvec3& d) const {
        double low = -1e30, high = 1e30;
        for (int axis = 0; axis < 3; ++axis) {
            const double half = axis == 0 ? half_x : axis == 1 ? half_y : 3;
            if (d[axis] == 0 && std::abs(o[axis]) > half) return {};
            if (d[axis] == 0) continue;
            const double a = (-half - o[axis]) / d[axis], b = (half - o[axis]) / d[axis];
            low = std::max(low, std::min(a, b)), high = std::min(high, std::max(a, b));
        }
        const auto at = [&](double t) { return (o + t * d).z - height((o + t * d).x, (o + t * d).y); };
        return crossings_between(at, low, high, 48, glm::length(d));
    }
};

inline const std::map<std::string, Oracle>& oracles() {
    using V = glm::dvec3;
    using Ts = std::vector<double>;
    static const AsphereOracle asphere{{-0.25, -0.5, {0, -0.1, 0, -0.3}}, double(0.8f)};
    // One piece, which bulges towards +z.
    static const GraphOracle patch{
        {{0, 0, -0.06, -0.01}, {0, -0.02, 0, 0}, {-0.055, 0, 0, 0}, {0.005, 0, 0, 0}}, 0.75, 0.65};
    static const std::map<std::string, Oracle> table{
        {"triangle",
         {{},
          [](V o, V d) -> Ts {
              const V e1 = corner[1] - corner[0], e2 = corner[2] - corner[0], n = glm::cross(e1, e2);
              const double t = glm::dot(n, corner[0] - o) / glm::dot(n, d);
              const V p = o + t * d - corner[0];
              const double b1 = glm::dot(glm::cross(p, e2), n) / glm::dot(n, n);
              const double b2 = glm::dot(glm::cross(e1, p), n) / glm::dot(n, n);
              if (b1 < 0 || b2 < 0 || b1 + b2 > 1) return {};
              return {t};
          },
          [](V p) {
              return glm::dot(glm::normalize(glm::cross(corner[1] - corner[0], corner[2] - corner[0])),
                              p - corner[0]);
          },
          {{-0.7f, -0.4f, -0.5f}, {0.9f, 0.8f, 0.6f}}}},
        {"sphere",
         {{{"radius", 0.8}},
          [](V o, V d) { return quadratic(glm::dot(d, d), glm::dot(o, d), glm::dot(o, o) - 0.64); },
          [](V p) { return glm::length(p) - double(0.8f); },
          {glm::vec3(-0.8f), glm::vec3(0.8f)}}},
        {"disk",
         {{{"radius", 0.8}, {"hole", 0.25}},
          [](V o, V d) -> Ts {
              const V p = o - o.z / d.z * d;
              if (glm::length(p) > 0.8 || glm::length(p) < 0.25) return {};
              return {-o.z / d.z};
          },
          [](V p) { return p.z; },
          {{-0.8f, -0.8f, 0}, {0.8f, 0.8f, 0}}}},
        {"rectangle",
         {{{"size", {1.5, 0.7}}},
          [](V o, V d) -> Ts {
              const V p = o - o.z / d.z * d;
              if (std::abs(p.x) > 0.75 || std::abs(p.y) > 0.35) return {};
              return {-o.z / d.z};
          },
          [](V p) { return p.z; },
          {{-0.75f, -0.35f, 0}, {0.75f, 0.35f, 0}}}},
        {"cylinder",
         {{{"radius", 0.5}, {"height", 1.4}},
          [](V o, V d) -> Ts {
              Ts result;
              for (double t :
                   quadratic(d.x * d.x + d.y * d.y, o.x * d.x + o.y * d.y, o.x * o.x + o.y * o.y - 0.25))
                  if (std::abs(o.z + t * d.z) <= 0.7) result.push_back(t);
              return result;
          },
          [](V p) { return std::hypot(p.x, p.y) - 0.5; },
          {{-0.5f, -0.5f, -0.7f}, {0.5f, 0.5f, 0.7f}}}},
        {"microstructure",
         {domes,
          [](V o, V d) -> Ts {
              Ts result;
              const V p = o - o.z / d.z * d;
              if (std::abs(p.x) <= 0.75 && std::abs(p.y) <= 0.375 && !dome_covers(dome_over(p), p))
                  result.push_back(-o.z / d.z);
              for (int row = 0; row < 3; ++row)
                  for (int column = 0; column < 4; ++column) {
                      const double shift = row & 1 ? 0.25 : -0.25;
                      const V middle((column - 1.5 + shift) * cell_width, (row - 1) * cell_height, 0);
                      const auto dome = dome_over(middle);
                      if (!dome) continue;
                      const V from = o - *dome;
                      for (const double t : quadratic(glm::dot(d, d), glm::dot(from, d),
                                                      glm::dot(from, from) - dome_curvature * dome_curvature))
                          if (o.z + t * d.z >= 0) result.push_back(t);
                  }
              return result;
          },
          [](V p) {
              const auto dome = dome_over(p);
              return dome_covers(dome, p) ? glm::length(p - *dome) - dome_curvature : p.z;
          },
          {{-0.75f, -0.375f, 0}, {0.75f, 0.375f, 0.0625f}},
          false,
          false}},
        // Bulges towards +z, so that what leaves it on that side does not come back.
        {"asphere",
         {{{"curvature", -0.25},
           {"conic", -0.5},
           {"coefficients", {-0.1, 0, -0.3}},
           {"aperture", 0.8},
           {"hole", 0.25}},
          [](V o, V d) {
              Ts result = asphere.crossings(o, d);
              std::erase_if(result, [&](double t) {
                  const V p = o + t * d;
                  return std::hypot(p.x, p.y) < 0.25;
              });
              return result;
          },
          [](V p) { return asphere.distance(p); },
          {{-0.8f, -0.8f, float(asphere.shape.sag(0.8, 0))}, {0.8f, 0.8f, 0}}}},
        {"bezier_patch",
         {{{"control_points", patch.control_points()}},
          [](V o, V d) { return patch.crossings(o, d); },
          [](V p) { return patch.distance(p); },
          {{-0.75f, -0.65f, -0.15f}, {0.75f, 0.65f, 0.01f}}}},
    };
    return table;
}

inline std::vector<std::string> registered() {
    std::vector<std::string> names;
    for (const ClassInfo& info : ClassRegistry(test_sources()).classes(Interface::geometry))
        names.push_back(info.name);
    return names;
}

struct Sample {
    glm::vec3 position, normal;
    float pdf, pdf_towards;
};
struct Meeting {
    uint32_t met;
    float t;
    glm::vec3 position, error, normal;
};

inline const char* const sample_kernel = R"(
    #include "interfaces/geometry.glsl"
    layout(local_size_x = 64) in;
    struct Sample { vec3 position, normal; float pdf, pdf_towards; };
    layout(scalar, set = 0) readonly buffer Uniforms { vec2 uniforms[]; };
    layout(scalar, set = 0) writeonly buffer Samples { Sample samples[]; };
    layout(push_constant) uniform Push { uint count, ref, towards; float x, y, z; };
    void main() {
        uint i = gl_GlobalInvocationID.x;
        if (i >= count) return;
        vec3 reference = vec3(x, y, z);
        GeometrySample s;
        if (towards != 0u) s = geometry_sample_towards(ref, reference, uniforms[i]);
        else s = geometry_sample(ref, uniforms[i]);
        samples[i] = Sample(s.position, s.normal, s.pdf, geometry_pdf_towards(ref, reference, s.position, s.normal));
    }
)";
inline const char* const meet_kernel = R"(
    #include "interfaces/geometry.glsl"
    layout(local_size_x = 64) in;
    struct Ray { vec3 origin; float t_max; vec3 direction; float unused; };
    struct Meeting { uint met; float t; vec3 position, error, normal; };
    layout(scalar, set = 0) readonly buffer Rays { Ray rays[]; };
    layout(scalar, set = 0) writeonly buffer Meetings { Meeting meetings[]; };
    layout(push_constant) uniform Push { uint count, ref; };
    void main() {
        uint i = gl_GlobalInvocationID.x;
        if (i >= count) return;
        Ray r = rays[i];
        GeometryHit hit;
        bool met = geometry_intersect(ref, r.origin, r.direction, r.t_max, hit);
        Meeting m = Meeting(uint(met), hit.t, vec3(0), vec3(0), vec3(0));
        if (met) {
            LocalPoint p = geometry_locate(ref, r.origin, r.direction, hit);
            m.position = p.position, m.error = p.error, m.normal = p.normal;
        }
        meetings[i] = m;
    }
)";
inline const char* const measure_kernel = R"(
    #include "interfaces/geometry.glsl"
    layout(local_size_x = 1) in;
    layout(scalar, set = 0) writeonly buffer Measures { float area; vec3 lo; vec3 hi; };
    layout(push_constant) uniform Push { uint ref; };
    void main() {
        area = geometry_area(ref);
        vec3 l, h;
        geometry_bounds(ref, l, h);
        lo = l, hi = h;
    }
)";

// One object of a class, asked through the interface.
class ClassProbe {
  public:
    explicit ClassProbe(const std::string& name) : ClassProbe(name, oracles().at(name).parameters) {}
    ClassProbe(const std::string& name, const nlohmann::json& parameters)
        : registry_(test_sources()), sources_(test_sources()) {
        const ClassInfo* info = registry_.find(Interface::geometry, name);
        REQUIRE(info);
        const InterfaceInfo& interface = interface_info(Interface::geometry);
        std::vector<std::byte> record;
        if (name == "triangle") {  // is read in place of other records
            const PrimitiveRecord triangle{corner[0], 0, corner[1], no_record, corner[2], 0};
            record.resize(sizeof triangle);
            std::memcpy(record.data(), &triangle, sizeof triangle);
        } else {
            const SceneDescription scene;
            record = fill_record(*info, {name, parameters, "/geometry"}, {}, micro_.resolver(scene));
        }
        RecordBuffer records;
        records.add(*info, record);
        records.layout();
        records_ = create_buffer(test_device(), records.bytes(), "geometry records");
        ref_ = records.ref(*info, 0);
        sources_.generated["generated/geometry_classes.glsl"] = class_header(interface, {info});
        sample_ = compile("sample", sample_kernel);
        meet_ = compile("meet", meet_kernel);
        const Buffer out(test_device(), 7 * sizeof(float), "measures");
        run(compile("measure", measure_kernel), {{"Measures", &out}}, 1, {{"ref", ref_}});
        const std::vector<float> numbers = out.read_array<float>(7);
        area = numbers[0];
        bounds = {{numbers[1], numbers[2], numbers[3]}, {numbers[4], numbers[5], numbers[6]}};
    }

    std::vector<Sample> sample(const std::vector<glm::vec2>& u, std::optional<glm::vec3> towards = {},
                               glm::vec3 reference = glm::vec3(0)) {
        if (towards) reference = *towards;
        const Buffer in = create_buffer(test_device(), u, "uniforms");
        const Buffer out(test_device(), u.size() * sizeof(Sample), "samples");
        run(sample_, {{"Uniforms", &in}, {"Samples", &out}}, uint32_t(u.size()),
            {{"count", uint32_t(u.size())},
             {"ref", ref_},
             {"towards", uint32_t(towards.has_value())},
             {"x", reference.x},
             {"y", reference.y},
             {"z", reference.z}});
        return out.read_array<Sample>(u.size());
    }

    std::vector<Meeting> meet(const std::vector<ProbeRay>& rays) {
        const Buffer in = create_buffer(test_device(), rays, "rays");
        const Buffer out(test_device(), rays.size() * sizeof(Meeting), "meetings");
        run(meet_, {{"Rays", &in}, {"Meetings", &out}}, uint32_t(rays.size()),
            {{"count", uint32_t(rays.size())}, {"ref", ref_}});
        return out.read_array<Meeting>(rays.size());
    }

    float area = 0;
    Box bounds;

  private:
    CompiledShader compile(const std::string& name, const std::string& text) {
        ShaderSources sources = sources_;
        sources.generated[name] = text;
        return compile_shader(sources, name);
    }
    void run(const CompiledShader& shader, BufferTable buffers, uint32_t count,
             std::initializer_list<PushValue> values) {
        buffers[interface_info(Interface::geometry).buffer] = &records_;
        micro_.bind(buffers);
        const Kernel kernel(test_device(), shader, buffers);
        CommandList list(test_device());
        list.dispatch(kernel, (count + 63) / 64, values);
        list.run();
    }
    ClassRegistry registry_;
    MicroProbe micro_;
    ShaderSources sources_;
    CompiledShader sample_, meet_;
    Buffer records_;
    uint32_t ref_ = 0;
};

inline std::vector<glm::vec2> uniform_points(size_t n, uint32_t seed) {
    Random random(seed);
    std::vector<glm::vec2> u(n);
    for (glm::vec2& v : u) v = {std::min(random(0, 1), 0.99999994f), std::min(random(0, 1), 0.99999994f)};
    return u;
}

inline std::vector<glm::vec2> grid_points(int n) {
    std::vector<glm::vec2> u;
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++)
            u.emplace_back((float(i) + 0.5f) / float(n), (float(j) + 0.5f) / float(n));
    return u;
}

constexpr int side = 6;
inline size_t cell_of(const Box& bounds, const glm::vec3& p) {
    size_t cell = 0;
    for (int axis = 0; axis < 3; axis++) {
        const float extent = bounds.hi[axis] - bounds.lo[axis];
        const float place = extent > 0 ? (p[axis] - bounds.lo[axis]) / extent : 0.0f;
        cell = cell * side + size_t(std::clamp(int(place * side), 0, side - 1));
    }
    return cell;
}

// Isotropic uniform lines through the ball around the bounds: the measure that counts area (Crofton).
inline std::vector<ProbeRay> random_lines(const Box& bounds, size_t count, float& radius, uint32_t seed) {
    Random random(seed);
    const glm::vec3 center = 0.5f * (bounds.lo + bounds.hi);
    radius = 0.5f * glm::length(bounds.hi - bounds.lo) * 1.01f;
    std::vector<ProbeRay> rays(count);
    for (ProbeRay& r : rays) {
        const glm::vec3 d = random.direction();
        const glm::vec3 a =
            glm::normalize(glm::cross(d, std::abs(d.x) < 0.7f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0)));
        const glm::vec3 b = glm::cross(d, a);
        const float rho = radius * std::sqrt(random(0, 1)), phi = random(0, 6.2831853f);
        r = {center + rho * (std::cos(phi) * a + std::sin(phi) * b) - 2 * radius * d, 1e30f, d};
    }
    return rays;
}

}  // namespace etendue
