// Receivers, for every registered class: what connects a point to the film is the inverse of the ray that
// leaves the film, whatever the node's transform, and both see the same radiance. A class without a
// configuration here fails.
#include <cmath>
#include <numbers>
#include <random>

#include "host/scene/records.h"
#include "tests/support/device_fixture.h"
#include "tests/support/source_path.h"
#include "tests/support/statistics.h"

using namespace etendue;
using nlohmann::json;

namespace {

constexpr double pi = std::numbers::pi;
constexpr double false_alarm = 1e-4;

struct Emitted {
    glm::vec3 origin;
    float weight;
    glm::vec3 direction;
    float density, connect_pdf;
    uint32_t is_parallel;
};

struct Connected {
    glm::vec3 direction;
    float distance;
    glm::vec2 film;
    float density, weight, pdf, footprint;
};

const char* const text = R"(
    #define SCENE_RADIUS 3.0
    #include "features/receiver_kinds.glsl"
    layout(local_size_x = 64) in;
    struct Emitted { vec3 origin; float weight; vec3 direction; float density, connect_pdf; uint is_parallel; };
    struct Connected { vec3 direction; float distance; vec2 film; float density, weight, pdf, footprint; };
    layout(scalar, set = 0) readonly buffer Places { vec3 places[]; };
    layout(scalar, set = 0) readonly buffer Draws { vec2 draws[]; };
    layout(scalar, set = 0) writeonly buffer EmittedRays { Emitted emitted[]; };
    layout(scalar, set = 0) writeonly buffer Connections { Connected connected[]; };
    layout(push_constant) uniform Push { uint count, receiver, mode; float aspect; };
    void main() {
        uint i = gl_GlobalInvocationID.x;
        if (i >= count) return;
        if (mode == 0u) {
            CameraRay r = receiver_emit(receiver, places[i].xy, draws[i], aspect);
            emitted[i] = Emitted(r.origin, r.weight, r.direction, r.density, r.connect_pdf, uint(r.is_parallel));
        } else {
            ReceiverSample s;
            if (mode == 1u) s = receiver_connect(receiver, places[i], draws[i], aspect);
            else s = receiver_far(receiver, places[i], aspect);
            float slope;
            connected[i] = Connected(s.direction, s.distance, s.film, s.density, s.weight, s.pdf,
                                     receiver_footprint(receiver, places[i], aspect, slope));
        }
    }
)";

struct Configuration {
    std::string label;
    json parameters;
    glm::dmat4 node;
    double aspect = 1.5;
    double tolerance = 3e-5;  // of places on the film: the rounding of points over the size of the view
    bool sees_all = false;    // there is no direction beyond the film
    bool is_sharp = true;     // a point of the film is a ray
    bool plane_film = true;   // straight lines look straight
};

// Random rotations and places, by themselves and after what is no rigid motion.
std::vector<Configuration> configurations(const std::string& name) {
    json parameters;
    if (name == "perspective") parameters = {{"yfov", 0.8}};
    if (name == "orthographic") parameters = {{"ymag", 0.7}};
    if (name == "thin_lens") parameters = {{"yfov", 0.8}, {"focus", 2.5}, {"aperture", 0.3}};
    if (name == "panorama") parameters = json::object();
    if (name == "luminance_meter") parameters = {{"angle", 0.9}};
    if (name == "illuminance") parameters = {{"size", {1.2, 0.8}}};
    if (name == "rays") parameters = {{"size", {1.2, 0.8}}};
    if (name == "intensity") parameters = {{"resolution", {16, 8}}};
    // Needs a mesh: tests/renders/surface_meter_test.cpp.
    if (parameters.is_null()) return {};
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    const auto node = [&](const glm::dmat3& inner) {
        glm::dmat3 r;
        r[2] = glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
        r[0] = glm::normalize(glm::cross(glm::dvec3(normal(random), normal(random), normal(random)), r[2]));
        r[1] = glm::cross(r[2], r[0]);
        glm::dmat4 m(r * inner);
        m[3] = glm::dvec4(normal(random), normal(random), normal(random), 1);
        return m;
    };
    const auto scale = [](double x, double y, double z) {
        return glm::dmat3({x, 0, 0}, {0, y, 0}, {0, 0, z});
    };
    std::vector<Configuration> result = {
        {"rigid", parameters, node(glm::dmat3(1))},
        {"square film", parameters, node(glm::dmat3(1)), 1},
        {"enlarged", parameters, node(scale(30, 30, 30))},
        {"stretched", parameters, node(scale(1.5, 0.6, 2.5))},
        {"mirrored", parameters, node(scale(-1, 1, 1))},
        {"mirrored and stretched", parameters, node(scale(0.5, 2, -1.5))},
        {"sheared", parameters, node(glm::dmat3({1, 0.3, -0.2}, {0.4, 0.9, 0.1}, {-0.3, 0.2, 1.2}))},
    };
    if (name == "rays") result.push_back({"sphere", {{"radius", 0.7}}, node(scale(1.2, 1.2, 1.2))});
    if (name == "perspective") {
        result.push_back({"wide", {{"yfov", 2.6}}, node(glm::dmat3(1))});
        result.push_back({"small angle", {{"yfov", 2e-3}}, node(glm::dmat3(1)), 1.5, 1e-3});
        result.push_back({"made small", parameters, node(scale(1e-12, 1e-12, 1e-12))});
    }
    for (Configuration& c : result) {
        c.sees_all = name == "panorama" || name == "intensity" || c.label == "sphere";
        c.is_sharp = name == "perspective" || name == "orthographic";
        c.plane_film = !c.sees_all && name != "luminance_meter";
    }
    return result;
}

class ReceiverProbe {
  public:
    ReceiverProbe(const std::string& class_name, const Configuration& c) : aspect_(float(c.aspect)) {
        sources_.folder = source_path("shaders");
        ClassRegistry registry(sources_);
        const ClassInfo* info = registry.find(Interface::receiver, class_name);
        const SceneDescription scene;
        const RecordResolver resolver{scene, {}, {}, {}};
        RecordBuffer records;
        records.add(*info, fill_record(*info, {class_name, c.parameters, "/receiver"}, c.node, resolver));
        records.layout();
        records_ = create_buffer(test_device(), records.bytes(), "receiver records");
        ref_ = records.ref(*info, 0);
        is_far = info->is_far, has_receptor = info->has_receptor;
        sources_.generated["generated/receiver_classes.glsl"] =
            class_header(interface_info(Interface::receiver), {info});
        sources_.generated["probe_receiver.comp"] = "#define HAS_FAR_RECEIVERS 1\n" + std::string(text);
    }
    bool is_far = false, has_receptor = false;
    // `draws`: u of each; empty = the middle.
    std::vector<Emitted> emit(const std::vector<glm::dvec2>& film, const std::vector<glm::vec2>& draws = {}) {
        std::vector<glm::vec3> places;
        for (const glm::dvec2& f : film) places.push_back({f.x, f.y, 0});
        return run<Emitted>(0, "EmittedRays", places, draws);
    }
    std::vector<Connected> connect(const std::vector<glm::vec3>& points,
                                   const std::vector<glm::vec2>& draws = {}) {
        return run<Connected>(1, "Connections", points, draws);
    }
    std::vector<Connected> far(const std::vector<glm::vec3>& directions) {
        return run<Connected>(2, "Connections", directions, {});
    }

  private:
    template <class T>
    std::vector<T> run(uint32_t mode, const char* results, const std::vector<glm::vec3>& places,
                       std::vector<glm::vec2> draws) {
        draws.resize(places.size(), glm::vec2(0.5f));
        const uint32_t count = uint32_t(places.size());
        const Buffer in = create_buffer(test_device(), places, "places"),
                     numbers = create_buffer(test_device(), draws, "draws"),
                     out(test_device(), count * sizeof(T), results), none(test_device(), 4, "none");
        BufferTable buffers = {{"ReceiverRecords", &records_},
                               {"Places", &in},
                               {"Draws", &numbers},
                               {"EmittedRays", &none},
                               {"Connections", &none}};
        buffers[results] = &out;
        const Kernel kernel(test_device(), compile_shader(sources_, "probe_receiver.comp"), buffers);
        CommandList list(test_device());
        list.dispatch(kernel, (count + 63) / 64,
                      {{"count", count}, {"receiver", ref_}, {"mode", mode}, {"aspect", aspect_}});
        list.run();
        return out.template read_array<T>(count);
    }
    ShaderSources sources_;
    Buffer records_;
    uint32_t ref_ = 0;
    float aspect_;
};

// Calls test(probe, configuration) for every class and configuration.
template <class Test>
void for_every_receiver(const Test& test) {
    ClassRegistry registry(ShaderSources{.folder = source_path("shaders")});
    for (const ClassInfo& info : registry.classes(Interface::receiver))
        for (const Configuration& c : configurations(info.name)) {
            INFO(info.name, ", ", c.label);
            ReceiverProbe probe(info.name, c);
            test(probe, c);
        }
}

std::vector<glm::dvec2> random_film(size_t count, uint32_t seed, double lo = 0, double hi = 1) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(lo, hi);
    std::vector<glm::dvec2> film;
    // As floats, as they reach the device.
    for (size_t i = 0; i < count; ++i) film.push_back(glm::vec2(uniform(random), uniform(random)));
    return film;
}

std::vector<glm::vec2> random_draws(size_t count, uint32_t seed) {
    std::vector<glm::vec2> draws;
    for (const glm::dvec2& u : random_film(count, seed)) draws.push_back(glm::vec2(u));
    return draws;
}

double solid_angle(const glm::dvec3& a, const glm::dvec3& b,
                   const glm::dvec3& c) {  // Van Oosterom & Strackee 1983
    return 2 * std::atan2(std::abs(glm::dot(a, glm::cross(b - a, c - a))),
                          1 + glm::dot(a, b) + glm::dot(b, c) + glm::dot(c, a));
}

}  // namespace

TEST_CASE("receiver: every registered class has a configuration to be tested with") {
    ClassRegistry registry(ShaderSources{.folder = source_path("shaders")});
    for (const ClassInfo& info : registry.classes(Interface::receiver)) {
        if (info.on_surface) continue;
        CAPTURE(info.name);
        CHECK(!configurations(info.name).empty());
    }
}

TEST_CASE("receiver: a point on a ray is connected along that ray, and no other point is") {
    for_every_receiver([](ReceiverProbe& probe, const Configuration& c) {
        const auto film = c.sees_all ? random_film(20000, 5, 0.03, 0.97) : random_film(20000, 5, -0.2, 1.2);
        std::vector<glm::vec2> draws = random_draws(film.size(), 8);
        const auto rays = probe.emit(film, draws);
        std::vector<glm::vec3> points, behind;
        for (size_t i = 0; i < film.size(); ++i) {
            const float far = probe.has_receptor ? 0 : std::exp(float(i % 7) - 1);
            if (probe.is_far) draws[i] = glm::vec2(film[i]);  // what draws its connection
            points.push_back(rays[i].origin + far * rays[i].direction);
            behind.push_back(rays[i].origin - far * rays[i].direction);
        }
        const auto connected = probe.connect(points, draws), unseen = probe.connect(behind, draws);
        const bool asks_sight = c.plane_film && !probe.has_receptor;
        double worst_film = 0, worst_direction = 0, worst_density = 0, worst_distance = 0, worst_pdf = 0,
               worst_weight = 0;
        uint32_t wrong_sight = 0;
        for (size_t i = 0; i < film.size(); ++i) {
            wrong_sight += asks_sight && unseen[i].pdf != 0;
            const glm::dvec2 edge = glm::min(film[i], 1.0 - film[i]);
            const double inside = std::min(edge.x, edge.y);  // distance from the edge, negative beyond it
            if (std::abs(inside) < c.tolerance) continue;
            wrong_sight += asks_sight && (connected[i].pdf > 0) != (inside > 0);
            if (!(connected[i].pdf > 0) || inside < 0) continue;
            const Connected& s = connected[i];
            const double distance = glm::length(glm::dvec3(points[i]) - glm::dvec3(rays[i].origin));
            worst_film = std::max(worst_film, glm::length(glm::dvec2(s.film) - film[i]));
            worst_direction = std::max(worst_direction,
                                       glm::length(glm::dvec3(s.direction) + glm::dvec3(rays[i].direction)));
            worst_density = std::max(worst_density, std::abs(s.density / double(rays[i].density) - 1));
            worst_weight = std::max(worst_weight, std::abs(s.weight / double(rays[i].weight) - 1));
            if (!probe.is_far && !probe.has_receptor)
                worst_distance = std::max(worst_distance, std::abs(s.distance / distance - 1));
            const double pdf = double(rays[i].connect_pdf) * (rays[i].is_parallel ? 1 : distance * distance);
            worst_pdf = std::max(worst_pdf, std::abs(s.pdf / pdf - 1));
        }
        CHECK(wrong_sight == 0);
        CHECK(worst_film < c.tolerance);
        CHECK(worst_direction < 3e-6);
        CHECK(worst_density < 3e-5);
        CHECK(worst_distance < 1e-5);
        CHECK(worst_pdf < 2e-5);
        CHECK(worst_weight < 1e-6);
    });
}

TEST_CASE("receiver: the density is that of the rays which leave the film") {
    for_every_receiver([](ReceiverProbe& probe, const Configuration& c) {
        // The rays of a cell's corners bound a solid angle or an area; the density at its centre is the
        // cell's share.
        constexpr uint32_t n = 128;
        std::vector<glm::dvec2> corners, centers;
        for (uint32_t i = 0; i <= n; ++i)
            for (uint32_t j = 0; j <= n; ++j) {
                corners.push_back(glm::dvec2(j, i) / double(n));
                if (i < n && j < n) centers.push_back((glm::dvec2(j, i) + 0.5) / double(n));
            }
        const auto at = probe.emit(corners), middle = probe.emit(centers);
        double total = 0, worst = 0;
        for (uint32_t i = 0; i < n; ++i)
            for (uint32_t j = 0; j < n; ++j) {
                const uint32_t a = i * (n + 1) + j, b = a + 1, d = a + n + 1, e = d + 1;
                const Emitted& r = middle[i * n + j];
                const auto origin = [&](uint32_t k) { return glm::dvec3(at[k].origin); };
                const auto direction = [&](uint32_t k) { return glm::dvec3(at[k].direction); };
                const double radius = 0.5 * glm::length(origin(0) - origin((n + 1) * (n + 1) - 1));
                const double on_sphere = solid_angle(direction(a), direction(b), direction(e)) +
                                         solid_angle(direction(a), direction(e), direction(d));
                const double size =
                    c.label == "sphere" ? radius * radius * on_sphere
                    : r.is_parallel && !probe.is_far
                        ? std::abs(glm::dot(glm::cross(origin(b) - origin(a), origin(d) - origin(a)),
                                            glm::dvec3(r.direction)))
                        : on_sphere;
                double share = r.density * size;
                if (probe.is_far)
                    share *= r.weight;  // over all places
                else if (!r.is_parallel)
                    share /= r.connect_pdf;
                total += share;
                worst = std::max(worst, std::abs(share * n * n - 1));
            }
        CHECK(total == doctest::Approx(1).epsilon(5e-4));
        CHECK(worst < (c.label == "small angle" ? 4e-2 : 3e-3));
    });
}

TEST_CASE("receiver: light that leaves towards a far receiver comes to the film where its rays come from") {
    for_every_receiver([](ReceiverProbe& probe, const Configuration&) {
        if (!probe.is_far) return;
        const auto film = random_film(20000, 11);
        const auto rays = probe.emit(film, random_draws(film.size(), 12));
        std::vector<glm::vec3> directions;
        for (const Emitted& r : rays) directions.push_back(-r.direction);
        const auto seen = probe.far(directions);
        size_t other = 0;
        for (size_t i = 0; i < film.size(); ++i) {
            const double along = std::abs(seen[i].film.x - film[i].x);
            const double response =
                double(seen[i].density) * seen[i].weight / (double(rays[i].density) * rays[i].weight);
            // Near the ends of rows the one or the other.
            other += std::min(along, 1 - along) > 1e-3 || std::abs(seen[i].film.y - film[i].y) > 2e-4 ||
                     std::abs(response - 1) > 1e-4;
        }
        CHECK(other < film.size() / 200);
    });
}

TEST_CASE(
    "receiver: a patch of radiance seen through connections gives the mean of the film that rays give") {
    size_t tests = 0;
    for_every_receiver([&](ReceiverProbe&, const Configuration&) { ++tests; });
    const double level = sidak_level(false_alarm, tests);
    for_every_receiver([&](ReceiverProbe& probe, const Configuration& c) {
        if (probe.has_receptor) return;  // sees nothing but it
        // A tilted parallelogram across a corner of the view, or where that is no plane within it.
        const bool plane = c.plane_film;
        const auto marks = plane ? probe.emit({{0.1, 0.2}, {0.9, 0.1}, {0.3, 1.3}})
                                 : probe.emit({{0.4, 0.4}, {0.6, 0.35}, {0.45, 0.7}});
        const auto on = [&](int i, double far) {
            return glm::dvec3(marks[i].origin) + far * glm::dvec3(marks[i].direction);
        };
        const glm::dvec3 corner = on(0, 2), side = on(1, 2.5) - corner, other = on(2, 3) - corner;
        const glm::dvec3 cross = glm::cross(side, other), normal = glm::normalize(cross);
        Moments met, connected;
        for (const Emitted& r : probe.emit(random_film(1 << 18, 6), random_draws(1 << 18, 9))) {
            const glm::dvec3 d(r.direction), o = glm::dvec3(r.origin) - corner;
            const glm::dvec3 p = o - d * (glm::dot(o, normal) / glm::dot(d, normal));
            const double u = glm::dot(glm::cross(p, other), cross) / glm::dot(cross, cross),
                         v = glm::dot(glm::cross(side, p), cross) / glm::dot(cross, cross);
            const bool ahead = glm::dot(o, normal) * glm::dot(d, normal) < 0;
            met.add(ahead && u >= 0 && u <= 1 && v >= 0 && v <= 1 ? r.weight : 0);
        }
        std::vector<glm::vec3> points;
        for (const glm::dvec2& f : random_film(1 << 18, 7))
            points.push_back(corner + f.x * side + f.y * other);
        for (const Connected& s : probe.connect(points, random_draws(1 << 18, 10))) {
            // The intensity of the whole patch if all of it were here; radiance 1.
            const double intensity = std::abs(glm::dot(cross, glm::dvec3(s.direction)));
            connected.add(s.pdf > 0 ? intensity * s.density * s.weight / s.pdf : 0);
        }
        CAPTURE(met.mean);
        CAPTURE(connected.mean);
        CHECK(met.mean > (c.is_sharp ? 0.2 : 0.005));
        if (c.is_sharp) CHECK(met.mean < 0.8);
        CHECK(z_test(met.mean, connected.mean, std::hypot(met.standard_error(), connected.standard_error()),
                     1e-4) > level);
    });
}

TEST_CASE("receiver: the footprint is the size of the view at a point's distance") {
    for_every_receiver([](ReceiverProbe& probe, const Configuration& c) {
        if (!c.plane_film) return;  // the film has no size there
        const Emitted middle = probe.emit({{0.5, 0.5}})[0];
        std::vector<glm::vec3> points = {middle.origin};
        for (float far : {-3.0f, 0.01f, 1.0f, 50.0f})
            points.push_back(middle.origin + far * middle.direction);
        const auto connected = probe.connect(points);
        CHECK(connected[0].footprint > 0);  // at the receiver itself
        for (size_t i = 1; i < points.size(); ++i) {
            const double distance = glm::length(glm::dvec3(points[i]) - glm::dvec3(middle.origin));
            const double expected =
                (middle.is_parallel ? 1 : distance) * std::sqrt(double(middle.connect_pdf / middle.density));
            CHECK(connected[i].footprint == doctest::Approx(expected).epsilon(1e-4));
        }
    });
    ReceiverProbe rigid("perspective", configurations("perspective")[0]);
    const Emitted middle = rigid.emit({{0.5, 0.5}})[0];
    CHECK(rigid.connect({middle.origin + 4.0f * middle.direction})[0].footprint ==
          doctest::Approx(4 * 2 * std::tan(0.4) * std::sqrt(1.5)).epsilon(1e-5));
    ReceiverProbe parallel("orthographic", configurations("orthographic")[0]);
    CHECK(parallel.connect({{5, 6, 7}})[0].footprint ==
          doctest::Approx(2 * 0.7 * std::sqrt(1.5)).epsilon(1e-5));
}
