// Faces of uniaxial crystals on the device: powers and directions against values from double precision (the
// closed forms of 2.13; the general axes of 2.14 by an independent program), energy, reciprocity, and the
// prisms that are made of them.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/support/random.h"
#include "tests/support/surface_probe.h"

using namespace etendue;
using glm::dvec3, glm::vec3, glm::vec4;

namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr float no = 1.6584f, ne = 1.4864f;  // calcite at 589 nm
constexpr uint32_t ordinary = 1, extraordinary = 2;

// In the plane's frame (shaders/lib/crystal_interface.glsl). An axis of 0: isotropic, of the first index.
struct Medium {
    float first, second;
    vec3 axis;
};
Medium isotropic(float ior) { return {ior, ior, vec3(0)}; }
Medium calcite(const dvec3& axis) { return {no, ne, vec3(glm::normalize(axis))}; }

struct FaceQuery {
    Medium from, to;
    float kx;
    uint32_t mode = 0;
};
struct FaceAnswer {
    vec4 powers[2];  // of what comes as s and p, or in the first: what goes back (two), and on (two)
    vec4 rays[4];    // unit; n² of their phase space
};

std::vector<FaceAnswer> faces(const std::vector<FaceQuery>& queries) {
    Buffer in = create_buffer(test_device(), queries, "Queries"),
           out(test_device(), queries.size() * sizeof(FaceAnswer), "Answers");
    const Kernel kernel = make_test_kernel("probe_crystal", R"(
        #include "lib/crystal_interface.glsl"
        layout(local_size_x = 64) in;
        struct Query { Crystal from, to; float kx; uint mode; };
        struct Answer { vec4 powers[2]; vec4 rays[4]; };
        layout(scalar, set = 0) readonly buffer Queries { Query queries[]; };
        layout(scalar, set = 0) writeonly buffer Answers { Answer answers[]; };
        layout(push_constant) uniform Push { uint count; };
        void main() {
            uint i = gl_GlobalInvocationID.x;
            if (i >= count) return;
            CrystalFace f = crystal_face(queries[i].from, queries[i].to, queries[i].mode, queries[i].kx);
            for (uint k = 0u; k < 4u; ++k) {
                answers[i].rays[k] = vec4(f.waves[k].ray, f.waves[k].squared_index);
                for (uint j = 0u; j < 2u; ++j)
                    answers[i].powers[j][k] = f.waves[k].travels ? dot(f.amplitudes[j][k], f.amplitudes[j][k]) : 0.0;
            }
        }
    )",
                                           {{"Queries", &in}, {"Answers", &out}});
    CommandList list(test_device());
    list.dispatch(kernel, uint32_t(queries.size() + 63) / 64, {{"count", uint32_t(queries.size())}});
    list.run();
    return out.read_array<FaceAnswer>(queries.size());
}

FaceAnswer face(const FaceQuery& query) { return faces({query})[0]; }

double sum(const vec4& v) { return double(v.x) + v.y + v.z + v.w; }

dvec3 about_z(const dvec3& v, double angle) {
    return {v.x * std::cos(angle) - v.y * std::sin(angle), v.x * std::sin(angle) + v.y * std::cos(angle),
            v.z};
}

void check_near(const vec4& got, const vec4& wanted, double tolerance = 2e-6) {
    for (int i = 0; i < 4; ++i) {
        INFO("component ", i, ": ", got[i], ", wanted ", wanted[i]);
        CHECK(std::fabs(got[i] - wanted[i]) < tolerance);
    }
}

// Of an extraordinary ray.
dvec3 wave_vector(const Medium& m, const dvec3& ray) {
    const double o2 = double(m.first) * m.first, e2 = double(m.second) * m.second;
    const double cosine = glm::dot(ray, dvec3(m.axis)), c2 = cosine * cosine;
    return (e2 * ray + (o2 - e2) * cosine * dvec3(m.axis)) / std::sqrt(e2 * (1 - c2) + o2 * c2);
}

}  // namespace

TEST_CASE("calcite in air: reflectance and walk-off at normal incidence, angles of refraction (2.13)") {
    const dvec3 tilted(1, 0, 1);
    const FaceAnswer a = face({isotropic(1), calcite(tilted), 0});
    CHECK(std::fabs(a.rays[3].x - -0.108418) < 1e-6);
    CHECK(std::fabs(a.rays[3].z - 0.994105) < 1e-6);
    // The axis lies in the plane x z: s is ordinary, p extraordinary.
    check_near(a.powers[0], {0.061339324f, 0, 1 - 0.061339324f, 0});
    check_near(a.powers[1], {0, 0.04856794f, 0, 1 - 0.04856794f});
    const FaceAnswer in_face = face({isotropic(1), calcite({1, 0, 0}), 0});
    CHECK(std::fabs(in_face.powers[1].y - 0.038268826) < 1e-6);

    struct WalkOff {
        double axis, angle;
    };
    for (const WalkOff& w :
         {WalkOff{44.61, 6.232726}, {45, 6.224118}, {60, 5.118057}, {41.869415, 6.261171}}) {
        const double t = w.axis * degree;
        const FaceAnswer f = face({isotropic(1), calcite({std::sin(t), 0, std::cos(t)}), 0});
        CHECK(std::fabs(-std::atan2(f.rays[3].x, f.rays[3].z) / degree - w.angle) < 1e-4);
    }
    // A crystal of quartz is of the other sign: its ray goes towards the axis.
    const FaceAnswer quartz = face({isotropic(1), {1.5443f, 1.5534f, vec3(glm::normalize(tilted))}, 0});
    CHECK(quartz.rays[3].x > 0.005);

    struct Refraction {
        double from, ordinary, across, along, normal;  // ray angles by the place of the axis
    };
    for (const Refraction& r : {Refraction{30, 17.547443, 19.656672, 15.823468, 21.728887},
                                {45, 25.237975, 28.406089, 22.903367, 31.107560},
                                {60, 31.480301, 35.635934, 28.758892, 38.653972}}) {
        const float kx = float(std::sin(r.from * degree));
        const auto angle = [&](const dvec3& axis, int wave) {
            const vec4 ray = face({isotropic(1), calcite(axis), kx}).rays[wave];
            return std::atan2(ray.x, ray.z) / degree;
        };
        CHECK(std::fabs(angle({0, 1, 0}, 2) - r.ordinary) < 1e-4);
        CHECK(std::fabs(angle({0, 1, 0}, 3) - r.across) < 1e-4);
        CHECK(std::fabs(angle({1, 0, 0}, 3) - r.along) < 1e-4);
        CHECK(std::fabs(angle({0, 0, 1}, 3) - r.normal) < 1e-4);
    }
}

TEST_CASE("calcite in air: powers for general axes (2.14)") {
    const FaceAnswer a = face({isotropic(1), calcite({1, 1, 1}), float(std::sin(45 * degree))});
    check_near(a.powers[0], {0.1146504f, 0.00085474f, 0.16207308f, 0.72242178f});
    check_near(a.powers[1], {0.000110328f, 0.01304690f, 0.80034591f, 0.18649686f});
    check_near(a.rays[3], {0.404424f, -0.099112f, 0.909185f, a.rays[3].w});

    const double azimuth = 30 * degree;
    const FaceAnswer b =
        face({isotropic(1), calcite(about_z({1, 2, 2}, -azimuth)), float(std::sin(60 * degree))});
    check_near(b.powers[0], {0.21809285f, 0.00066814f, 0.12899847f, 0.65224055f});
    check_near(b.powers[1], {2.877e-5f, 0.00073456f, 0.83272416f, 0.16651251f});
    const dvec3 ray = about_z(dvec3(b.rays[3]), azimuth);
    check_near(vec4(vec3(ray), 0), {0.478033f, 0.177193f, 0.860283f, 0});
}

// Refraction keeps dA d²K_t = n² cos dA dOmega: n² is what K along a plane changes by with the ray there.
TEST_CASE("the phase space of a crystal's waves is that by finite differences") {
    for (const dvec3& axis : {dvec3(1, 0, 1), {0.2, 1, 0.3}, {0, 0, 1}, {1, 0.1, 0}}) {
        const Medium m = calcite(axis);
        const FaceAnswer a = face({isotropic(1), m, 0.5f});
        CHECK(std::fabs(a.rays[2].w - double(no) * no) < 1e-5);
        const dvec3 ray(a.rays[3]);
        const double h = 1e-5;
        const auto moved = [&](double x, double y) {
            const glm::dvec2 at(ray.x + x, ray.y + y);
            return wave_vector(m, {at.x, at.y, std::sqrt(1 - glm::dot(at, at))});
        };
        const dvec3 dx = (moved(h, 0) - moved(-h, 0)) / (2 * h), dy = (moved(0, h) - moved(0, -h)) / (2 * h);
        CHECK(std::fabs(moved(0, 0).x - 0.5) < 1e-6);
        CHECK(std::fabs(std::fabs(dx.x * dy.y - dx.y * dy.x) - a.rays[3].w) < 1e-4);
    }
}

// A face of no crystal at all is Fresnel's.
TEST_CASE("glass as a medium of crystal faces reflects as it should, total reflection included") {
    const FaceAnswer in = face({isotropic(1), isotropic(1.5f), float(std::sin(60 * degree))});
    check_near(in.powers[0], {0.176571488f, 0, 1 - 0.176571488f, 0});
    check_near(in.powers[1], {0, 0.001801938f, 0, 1 - 0.001801938f});
    const FaceAnswer total = face({isotropic(1.5f), isotropic(1), float(1.5 * std::sin(60 * degree))});
    check_near(total.powers[0], {1, 0, 0, 0});
    check_near(total.powers[1], {0, 1, 0, 0});
}

TEST_CASE("faces of crystals keep power, whatever the axes, and light goes back as it came") {
    Random random(7);
    const auto direction = [&] { return dvec3(random.direction()); };
    constexpr int count = 2000;
    std::vector<FaceQuery> entering, back, leaving, between, nearly;
    for (int i = 0; i < count; ++i) {
        const double kx = random(0, 0.999);
        const dvec3 axis = direction();
        entering.push_back({isotropic(1), calcite(axis), float(kx)});
        // K turned round and the plane with it, by half a turn about y.
        for (const uint32_t mode : {ordinary, extraordinary}) {
            back.push_back({calcite({-axis.x, axis.y, -axis.z}), isotropic(1), float(kx), mode});
            leaving.push_back({calcite(axis), isotropic(1), float(random(0, 1.45)), mode});
            between.push_back({calcite(axis), calcite(direction()), float(random(0, 1.45)), mode});
            nearly.push_back(
                {calcite({1e-5 * axis.x, 1e-5 * axis.y, 1}), isotropic(1), float(1e-4 * kx), mode});
        }
    }
    double worst = 0, worst_reciprocity = 0;
    size_t total = 0;
    const auto in = faces(entering), out = faces(back);
    for (size_t i = 0; i < in.size(); ++i)
        for (int polarization = 0; polarization < 2; ++polarization) {
            worst = std::max(worst, std::fabs(sum(in[i].powers[polarization]) - 1));
            for (int mode = 0; mode < 2; ++mode)
                worst_reciprocity =
                    std::max(worst_reciprocity, std::fabs(double(in[i].powers[polarization][2 + mode]) -
                                                          out[2 * i + mode].powers[0][2 + polarization]));
        }
    for (const auto& queries : {back, leaving, between, nearly})
        for (const FaceAnswer& a : faces(queries)) {
            worst = std::max(worst, std::fabs(sum(a.powers[0]) - 1));
            total += a.powers[0].z + a.powers[0].w == 0;
        }
    MESSAGE("power is kept to ", worst, ", reciprocity holds to ", worst_reciprocity);
    CHECK(worst < 1e-5);
    CHECK(worst_reciprocity < 1e-5);
    CHECK(total > 200);  // total reflection
}

TEST_CASE("prisms of calcite: what is extinguished is so exactly (2.15)") {
    // A beam enters along the normal of a face that the axis lies in, and meets the gap at an angle. Glan and
    // Taylor: the axis in the plane of incidence there; Glan and Foucault: across it.
    struct Prism {
        double angle;
        bool taylor;
        double gap, with_faces;  // what passes of the extraordinary wave: two faces with their echoes; four
    };
    for (const Prism& p : {Prism{38.5, true, 0.948472, 0.877267},
                           {39, true, 0.928043, 0.858372},
                           {40, true, 0.862562, 0.797806},
                           {38.5, false, 0.589360, 0.545115}}) {
        const double sine = std::sin(p.angle * degree), cosine = std::cos(p.angle * degree);
        const Medium crystal = calcite(p.taylor ? dvec3(cosine, 0, -sine) : dvec3(0, 1, 0));
        const FaceAnswer o = face({crystal, isotropic(1), float(no * sine), ordinary});
        CHECK(o.powers[0].z + o.powers[0].w == 0);
        CHECK(std::fabs(sum(o.powers[0]) - 1) < 2e-5);
        const FaceAnswer e = face({crystal, isotropic(1), float(ne * sine), extraordinary});
        const double r = double(e.powers[0].x) + e.powers[0].y, gap = (1 - r) / (1 + r);
        const double entry = face({isotropic(1), calcite({1, 0, 0}), 0}).powers[1].w;
        CAPTURE(p.angle);
        CHECK(std::fabs(gap - p.gap) < 1e-5);
        CHECK(std::fabs(gap * entry * entry - p.with_faces) < 1e-5);
    }
}

// Two wedges cemented: the axis of the first lies along the edge, that of the second across, parallel to the
// exit.
TEST_CASE("a Wollaston prism splits a beam by the angles of both waves (2.15)") {
    struct Wedge {
        double angle, first, second;
    };
    for (const Wedge& w :
         {Wedge{15, -2.631770, 2.650424}, {20, -3.564864, 3.611642}, {30, -5.603472, 5.790647}}) {
        const double sine = std::sin(w.angle * degree), cosine = std::cos(w.angle * degree);
        // The beam comes along z and meets the wedge's plane at the angle: in the plane's frame the world's x
        // is
        // (-cosine, 0, sine).
        const Medium first = calcite({0, 1, 0}), second = calcite({-cosine, 0, sine});
        std::vector<double> exits;
        for (const uint32_t mode : {ordinary, extraordinary}) {
            const double index = mode == ordinary ? no : ne;
            const FaceAnswer a = face({first, second, float(index * sine), mode});
            const int wave = a.powers[0].z > a.powers[0].w ? 2 : 3;
            CHECK(a.powers[0][wave] > 0.99);
            CHECK(a.powers[0][5 - wave] < 1e-6);  // each wave becomes the other: their E stay across
            CHECK((wave == 3) == (mode == ordinary));
            const dvec3 ray(a.rays[wave]);
            const dvec3 k = wave == 3 ? wave_vector(second, ray) : double(no) * ray;
            exits.push_back(std::asin(k.x * cosine - k.z * sine) / degree);
        }
        std::sort(exits.begin(), exits.end());
        CAPTURE(w.angle);
        CHECK(std::fabs(exits[0] - w.first) < 1e-4);
        CHECK(std::fabs(exits[1] - w.second) < 1e-4);
    }
}
