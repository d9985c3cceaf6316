// Every class of light, on the device: its sampler against its density and its radiance, its power against
// the light it sends, and its illuminance against closed forms. Classes come from the registry; one without a
// configuration here fails.
#include <cmath>
#include <cstring>
#include <functional>
#include <numbers>
#include <random>

#include "host/error.h"
#include "host/scene/environment_map.h"
#include "host/scene/features.h"
#include "host/scene/records.h"
#include "tests/support/device_fixture.h"
#include "tests/support/light_probe.h"
#include "tests/support/statistics.h"

using namespace etendue;
using nlohmann::json;

namespace {

constexpr double pi = std::numbers::pi;
constexpr double false_alarm = 1e-4;

// A bright patch, dark regions and colour: what an alias table can get wrong.
ImageDescription probe_image(uint32_t width, uint32_t height) {
    ImageDescription image;
    image.name = "probe";
    image.width = width, image.height = height;
    std::mt19937 random(1);
    std::uniform_real_distribution<float> uniform;
    for (uint32_t i = 0; i < width * height; ++i) {
        const uint32_t x = i % width, y = i / width;
        float v = uniform(random) * 0.2f + (y < height / 2 ? 0.5f : 0.05f);
        if (x >= width / 4 && x < width / 2 && y > height / 2) v = 0;
        image.rgba32f.insert(image.rgba32f.end(), {v, v * uniform(random), v * 0.5f, 1});
    }
    for (int c = 0; c < 3; ++c)
        image.rgba32f[((height / 4) * width + width - 1) * 4 + c] = 20;  // beside the seam
    for (int c = 0; c < 3; ++c) image.rgba32f[(width / 2) * 4 + c] = 5;  // beside the pole
    return image;
}

struct Configuration {
    std::string label;
    json parameters;
    glm::dmat4 placement{1.0};
    ImageDescription image;  // of a parameter `file`
    glm::vec3 point{0.3f, 0.2f, -0.4f};
};

// A node at (1, 2, -3) that turns -z to (0.6, -0.8, 0), enlarged: scale must not matter.
glm::dmat4 tilted_node() {
    glm::dmat4 m(1.0);
    m[2] = glm::dvec4(-0.6, 0.8, 0, 0) * 3.0;
    m[0] = glm::dvec4(0.8, 0.6, 0, 0) * 3.0;
    m[1] = glm::dvec4(0, 0, 1, 0) * 3.0;
    m[3] = glm::dvec4(1, 2, -3, 1);
    return m;
}

std::vector<Configuration> configurations(const std::string& name) {
    if (name == "point") return {{"", {{"intensity", 7}, {"color", {1, 0.5, 0.25}}}, tilted_node(), {}, {}}};
    if (name == "spot")
        return {
            {"wide",
             {{"intensity", 7}, {"inner_cone_angle", 0.4}, {"outer_cone_angle", 1.2}},
             tilted_node(),
             {},
             {}},
            {"narrow", {{"inner_cone_angle", 0.0005}, {"outer_cone_angle", 0.001}}, tilted_node(), {}, {}},
            {"sharp", {{"inner_cone_angle", 0.5}, {"outer_cone_angle", 0.5}}, tilted_node(), {}, {}}};
    if (name == "directional") return {{"", {{"intensity", 5}}, tilted_node(), {}, {}}};
    if (name == "constant") return {{"", {{"radiance", {1, 2, 3}}}, glm::dmat4(1.0), {}, {}}};
    if (name == "image")
        return {
            {"16 x 8", {{"file", "f"}, {"scale", 2}}, glm::dmat4(1.0), probe_image(16, 8), {}},
            {"7 x 5, turned", {{"file", "f"}, {"rotation", 1.234}}, glm::dmat4(1.0), probe_image(7, 5), {}},
            {"64 x 32", {{"file", "f"}, {"rotation", -2}}, glm::dmat4(1.0), probe_image(64, 32), {}},
            {"1 x 1", {{"file", "f"}}, glm::dmat4(1.0), probe_image(1, 1), {}}};
    return {};
}

LightProbe make_probe(const std::string& name, const Configuration& c) {
    return LightProbe(name, c.parameters, c.placement, c.image);
}

// The sphere in cells of equal solid angle: 32 rows in y by 64 columns in azimuth.
constexpr uint32_t rows = 32, columns = 64;

glm::vec3 cell_direction(double row, double column) {
    const double y = 1 - 2 * row / rows, phi = 2 * pi * column / columns,
                 s = std::sqrt(std::max(0.0, 1 - y * y));
    return {float(s * std::sin(phi)), float(y), float(-s * std::cos(phi))};
}
uint32_t direction_cell(glm::vec3 d) {
    double phi = std::atan2(double(d.x), -double(d.z));
    if (phi < 0) phi += 2 * pi;
    const auto row = std::clamp(int((1 - d.y) / 2 * rows), 0, int(rows) - 1);
    return uint32_t(row) * columns + std::min(uint32_t(phi / (2 * pi) * columns), columns - 1);
}

double luminance(glm::vec3 c) { return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z; }

}  // namespace

TEST_CASE("light: every registered class has a configuration to be tested with") {
    ClassRegistry registry(test_sources());
    for (const ClassInfo& info : registry.classes(Interface::light)) {
        CAPTURE(info.name);
        CHECK((info.name == "area" || !configurations(info.name).empty()));
    }
}

TEST_CASE("light: directions are sampled with the stated density, and bring the radiance that a ray meets") {
    ClassRegistry registry(test_sources());
    for (const ClassInfo& info : registry.classes(Interface::light))
        for (const Configuration& c : configurations(info.name)) {
            CAPTURE(info.name);
            CAPTURE(c.label);
            LightProbe probe = make_probe(info.name, c);
            const uint32_t count = 1 << 20;
            const auto samples = probe.sample(c.point, count, 5);
            if (samples[0].is_delta) {
                for (const ProbeSample& s : samples)  // pdf 0: the point is outside of a spot light's cone
                    if (s.pdf > 0) REQUIRE(s.pdf_towards == doctest::Approx(s.pdf).epsilon(1e-6));
                continue;
            }
            std::vector<double> observed(rows * columns + 1), expected(rows * columns + 1);
            double worst_pdf = 0, worst_radiance = 0, worst_length = 0;
            for (const ProbeSample& s : samples) {
                if (!(s.pdf > 0)) {
                    observed.back() += 1;
                    continue;
                }
                observed[direction_cell(s.direction)] += 1;
                worst_pdf = std::max(worst_pdf, std::abs(s.pdf_towards / double(s.pdf) - 1));
                worst_radiance = std::max(
                    worst_radiance, std::abs(luminance(s.radiance_towards) / luminance(s.radiance) - 1));
                worst_length = std::max(worst_length, std::abs(glm::length(glm::dvec3(s.direction)) - 1));
            }
            CHECK(worst_pdf < 2e-3);
            CHECK(worst_radiance < 2e-3);
            CHECK(worst_length < 1e-6);

            const uint32_t fine = 16;  // quadrature points along each side of a cell
            std::vector<glm::vec3> directions;
            for (uint32_t i = 0; i < rows * columns; ++i)
                for (uint32_t j = 0; j < fine * fine; ++j)
                    directions.push_back(cell_direction(i / columns + (j / fine + 0.5) / fine,
                                                        i % columns + (j % fine + 0.5) / fine));
            const auto towards = probe.evaluate(c.point, directions);
            double total = 0;
            for (size_t i = 0; i < directions.size(); ++i) {
                const double p = towards[i].pdf * (4 * pi / double(directions.size()));
                expected[i / (fine * fine)] += p * count;
                total += p;
            }
            CHECK(total == doctest::Approx(1).epsilon(1e-3));
            const ChiSquared chi = chi_squared_test(observed, expected);
            CAPTURE(chi.statistic);
            CAPTURE(chi.degrees);
            CHECK(chi.p_value > sidak_level(false_alarm, 8));
        }
}

TEST_CASE("light: a point light's illuminance is I cos / d²") {
    const Configuration c = configurations("point")[0];
    LightProbe probe = make_probe("point", c);
    for (glm::vec3 p : {glm::vec3(0, 0, 0), glm::vec3(1, 2, -3.001f), glm::vec3(1e4f, 0, 0)}) {
        const ProbeSample s = probe.sample(p, 1, 0)[0];
        const glm::dvec3 d = glm::dvec3(1, 2, -3) - glm::dvec3(p);
        const double e = 7 / glm::dot(d, d);
        CHECK(s.is_delta);
        CHECK(s.radiance.x / s.pdf == doctest::Approx(e).epsilon(1e-6));
        CHECK(s.radiance.z / s.pdf == doctest::Approx(0.25 * e).epsilon(1e-6));
        CHECK(s.distance == doctest::Approx(glm::length(d)).epsilon(1e-6));
        CHECK(glm::length(glm::dvec3(s.direction) - glm::normalize(d)) < 1e-6);
    }
    CHECK(probe.sample({1, 2, -3}, 1, 0)[0].pdf == 0.0f);  // at the light itself: no direction
    CHECK(probe.measure().power == doctest::Approx(4 * pi * 7 * luminance({1, 0.5f, 0.25f})).epsilon(1e-6));
}

TEST_CASE("light: a spot light falls off as KHR_lights_punctual recommends, and its power is its flux") {
    for (const Configuration& c : configurations("spot")) {
        CAPTURE(c.label);
        LightProbe probe = make_probe("spot", c);
        const double intensity = c.parameters.value("intensity", 1.0),
                     inner = c.parameters["inner_cone_angle"], outer = c.parameters["outer_cone_angle"];
        const glm::dvec3 axis(0.6, -0.8, 0), side(0.8, 0.6, 0), origin(1, 2, -3);
        const int steps = 2000;
        double flux = 0;
        std::vector<glm::vec3> points;
        for (int i = 0; i < steps; ++i) {
            const double angle = 1.25 * outer * (i + 0.5) / steps;
            points.push_back(glm::vec3(origin + 2.0 * (std::cos(angle) * axis + std::sin(angle) * side)));
        }
        const auto samples = probe.sample_at(points);
        for (int i = 0; i < steps; ++i) {
            const glm::dvec3 d = glm::normalize(glm::dvec3(points[i]) - origin);
            const double angle = std::atan2(glm::length(glm::cross(axis, d)), glm::dot(axis, d));
            const double t = std::clamp(
                (std::cos(angle) - std::cos(outer)) / std::max(1e-12, std::cos(inner) - std::cos(outer)), 0.0,
                1.0);
            const double measured = samples[i].pdf > 0 ? samples[i].radiance.x : 0.0;
            if (c.label == "wide")
                REQUIRE(measured == doctest::Approx(intensity * t * t).epsilon(1e-4).scale(intensity));
            const double nominal = 1.25 * outer * (i + 0.5) / steps;
            flux += measured * 2 * pi * std::sin(nominal) * 1.25 * outer / steps;
        }
        // Points 2 m away are rounded to float: an angle of 0.001 is known to 1e-4 of itself.
        CHECK(probe.measure().power == doctest::Approx(flux).epsilon(c.label == "wide" ? 1e-4 : 2e-3));
    }
}

TEST_CASE("light: a directional light comes from +z of its node with its illuminance, whatever the scale") {
    LightProbe probe = make_probe("directional", configurations("directional")[0]);
    const ProbeSample s = probe.sample({1, 1, 1}, 1, 0)[0];
    CHECK(glm::length(s.direction - glm::vec3(-0.6f, 0.8f, 0)) < 1e-6f);
    CHECK(s.radiance.y == 5.0f);
    CHECK(s.distance >= 1e30f);
    CHECK(probe.measure(2.0f).power == doctest::Approx(pi * 4 * 5).epsilon(1e-6));
    CHECK(is_at_infinity(probe.measure()));
}

TEST_CASE("light: under a constant environment the illuminance is pi times the radiance") {
    LightProbe probe = make_probe("constant", configurations("constant")[0]);
    Moments e;
    for (const ProbeSample& s : probe.sample({}, 1 << 20, 3))
        e.add(s.radiance.y * std::max(0.0f, glm::dot(s.direction, glm::vec3(0.6f, 0, 0.8f))) / s.pdf);
    CHECK(z_test(e.mean, 2 * pi, e.standard_error(), 1e-5) > false_alarm);
    CHECK(probe.measure(3.0f).power == doctest::Approx(4 * pi * pi * 9 * luminance({1, 2, 3})).epsilon(1e-6));
}

namespace {

// The image's radiance by its definition, in double precision: the azimuth runs from -z to +x, bilinear in it
// and in the cosine of the polar angle, constant between the outermost row centres and the poles.
glm::dvec3 image_reference(const ImageDescription& image, double rotation, const glm::dvec3& d) {
    const auto texel = [&](int x, int y) {
        x = (x % int(image.width) + int(image.width)) % int(image.width);
        y = std::clamp(y, 0, int(image.height) - 1);
        const float* p = &image.rgba32f[(size_t(y) * image.width + x) * 4];
        return glm::dvec3(p[0], p[1], p[2]);
    };
    const double u = (std::atan2(d.x, 0.0 - d.z) + rotation) / (2 * pi) + 0.5;
    const double x = (u - std::floor(u)) * image.width - 0.5;
    const auto row_cos = [&](int y) {
        return y < 0 ? 1.0 : y >= int(image.height) ? -1.0 : std::cos(pi * (y + 0.5) / image.height);
    };
    int y = -1;
    while (y + 1 < int(image.height) && d.y <= row_cos(y + 1)) ++y;
    const double t = (row_cos(y) - d.y) / (row_cos(y) - row_cos(y + 1));
    const int left = int(std::floor(x));
    const double s = x - left;
    return glm::mix(glm::mix(texel(left, y), texel(left + 1, y), s),
                    glm::mix(texel(left, y + 1), texel(left + 1, y + 1), s), t);
}

}  // namespace

TEST_CASE("light: an environment image shows its definition's radiance in every direction") {
    for (const Configuration& c : configurations("image")) {
        CAPTURE(c.label);
        LightProbe probe = make_probe("image", c);
        const double scale = c.parameters.value("scale", 1.0), rotation = c.parameters.value("rotation", 0.0);
        std::mt19937 random(2);
        std::normal_distribution<double> normal;
        std::vector<glm::vec3> directions = {{0, 1, 0}, {0, -1, 0}, {0, 0, -1},
                                             {0, 0, 1}, {1, 0, 0},  {-1, 0, 0}};
        for (double tiny : {1e-3, 1e-5, 1e-8})
            for (double y : {1.0, -1.0})
                directions.push_back(glm::vec3(glm::normalize(glm::dvec3(tiny, y, 0.5 * tiny))));
        while (directions.size() < 50000)
            directions.push_back(
                glm::vec3(glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)))));
        const auto values = probe.evaluate({}, directions);
        double worst = 0;
        glm::vec3 where(0);
        for (size_t i = 0; i < directions.size(); ++i) {
            const glm::dvec3 reference =
                scale * image_reference(c.image, rotation, glm::normalize(glm::dvec3(directions[i])));
            const double error = glm::length(glm::dvec3(values[i].radiance) - reference) / (scale * 20);
            if (error > worst) worst = error, where = directions[i];
        }
        CAPTURE(where.x);
        CAPTURE(where.y);
        CAPTURE(where.z);
        CHECK(worst < 3e-5);
    }
}

TEST_CASE("light: the centre of an environment image lies along -z, its right towards +x, its top row up") {
    const auto brightest = [](uint32_t column, uint32_t row, double rotation) {
        ImageDescription image;
        image.name = "one texel";
        image.width = 64, image.height = 32;
        image.rgba32f.assign(64 * 32 * 4, 0.0f);
        for (int c = 0; c < 3; ++c) image.rgba32f[(row * 64 + column) * 4 + c] = 1;
        LightProbe probe =
            make_probe("image", {"", {{"file", "f"}, {"rotation", rotation}}, glm::dmat4(1.0), image, {}});
        glm::vec3 mean(0);
        for (const ProbeSample& s : probe.sample({}, 4096, 1)) mean += s.direction;
        return glm::normalize(mean);
    };
    const double tolerance = 0.08;  // half a texel is 0.05 rad
    CHECK(glm::length(brightest(32, 16, 0) - glm::vec3(0, 0, -1)) < tolerance);
    CHECK(glm::length(brightest(48, 16, 0) - glm::vec3(1, 0, 0)) < tolerance);
    CHECK(glm::length(brightest(0, 16, 0) - glm::vec3(0, 0, 1)) < tolerance);
    CHECK(glm::length(brightest(32, 0, 0) - glm::vec3(0, 1, 0)) < tolerance);
    CHECK(glm::length(brightest(32, 31, 0) - glm::vec3(0, -1, 0)) < tolerance);
    // A quarter turn about +y takes -z to -x.
    CHECK(glm::length(brightest(32, 16, pi / 2) - glm::vec3(-1, 0, 0)) < tolerance);
}

TEST_CASE("light: illuminance and power of an environment image are those of quadrature") {
    for (const Configuration& c : configurations("image")) {
        CAPTURE(c.label);
        LightProbe probe = make_probe("image", c);
        const double scale = c.parameters.value("scale", 1.0), rotation = c.parameters.value("rotation", 0.0);
        const glm::dvec3 normal = glm::normalize(glm::dvec3(0.3, 0.5, -0.7));
        double illuminance = 0, integral = 0;
        const int n = 800;
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < 2 * n; ++j) {
                const double y = 1 - 2 * (i + 0.5) / n, phi = pi * (j + 0.5) / n, s = std::sqrt(1 - y * y);
                const glm::dvec3 d(s * std::sin(phi), y, -s * std::cos(phi));
                const double l = scale * luminance(glm::vec3(image_reference(c.image, rotation, d)));
                integral += l * 4 * pi / (2.0 * n * n);
                illuminance += l * std::max(0.0, glm::dot(d, normal)) * 4 * pi / (2.0 * n * n);
            }
        Moments e;
        for (const ProbeSample& s : probe.sample({}, 1 << 20, 3))
            if (s.pdf > 0)
                e.add(luminance(s.radiance) * std::max(0.0, glm::dot(glm::dvec3(s.direction), normal)) /
                      s.pdf);
            else
                e.add(0);
        CHECK(z_test(e.mean, illuminance, e.standard_error(), 1e-4 * illuminance) > false_alarm);
        CHECK(probe.measure(2.0f).power == doctest::Approx(pi * 4 * integral).epsilon(1e-4));
    }
}

TEST_CASE("light: a sun ten million times brighter than the sky leaves the sky's share right") {
    ImageDescription image;
    image.name = "sun and sky";
    image.width = 1024, image.height = 512;
    image.rgba32f.assign(1024 * 512 * 4, 1.0f);
    for (int c = 0; c < 3; ++c) image.rgba32f[(100 * 1024 + 300) * 4 + c] = 1e7f;
    LightProbe probe = make_probe("image", {"", {{"file", "f"}}, glm::dmat4(1.0), image, {}});
    const double integral = probe.measure(1.0f).power / pi;
    // The lower half holds 2 pi of the sky.
    const uint32_t count = 1 << 23;
    double below = 0;
    for (uint32_t seed = 0; seed < 8; ++seed)
        for (const ProbeSample& s : probe.sample({}, count / 8, seed)) below += s.direction.y < 0;
    MESSAGE(below, " of ", count, " samples go to the sky below the horizon");
    const double expected = 2 * pi / integral * count;
    CHECK(z_test(below, expected, std::sqrt(expected), 1e-3 * expected) > false_alarm);
}

TEST_CASE("light: texels that are no radiance are named by column and row") {
    for (float bad :
         {-1.0f, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        ImageDescription image = probe_image(8, 4);
        image.rgba32f[(2 * 8 + 5) * 4 + 1] = bad;
        CHECK_THROWS_WITH_AS(
            build_environment_map(image),
            fmt::format(
                "probe: the texel in column 5, row 2 of this environment image is {}; radiance is a finite "
                "number, at least 0",
                bad)
                .c_str(),
            Error);
    }
    CHECK_THROWS_AS(build_environment_map(ImageDescription{}), Error);
}

TEST_CASE("light: 8-bit environment images are taken as sRGB") {
    ImageDescription image;
    image.name = "grey";
    image.width = image.height = 2;
    image.rgba8.assign(16, 188);  // 0.5029 in linear light
    LightProbe probe = make_probe("image", {"", {{"file", "f"}}, glm::dmat4(1.0), image, {}});
    CHECK(probe.evaluate({}, {{0.6f, 0, 0.8f}})[0].radiance.y == doctest::Approx(0.5029).epsilon(1e-3));
}

TEST_CASE("light: a black environment image sends nothing") {
    ImageDescription image = probe_image(8, 4);
    for (float& v : image.rgba32f) v = 0;
    LightProbe probe = make_probe("image", {"", {{"file", "f"}}, glm::dmat4(1.0), image, {}});
    CHECK(probe.sample({}, 1, 0)[0].pdf == 0.0f);
    CHECK(probe.measure().power == 0.0f);
    CHECK(probe.evaluate({}, {{0, 0, 1}})[0].pdf == 0.0f);
}
