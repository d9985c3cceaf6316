// The tone curves on the device against their twin in double precision, and what the host computes for them.
#include "host/preview/metering.h"
#include "host/preview/view_transform.h"

#include <doctest/doctest.h>

#include "tests/preview/tone_curves_twin.h"
#include "tests/support/device_fixture.h"

using namespace etendue;

namespace {

std::vector<glm::vec3> device_colors(const ViewSettings& settings, const std::vector<glm::vec3>& radiances) {
    const ViewTransform transform = view_transform(settings);
    const Buffer in = create_buffer(test_device(), radiances, "Radiances"),
                 view = create_buffer(test_device(), std::span(&transform, 1), "ViewTable"),
                 out(test_device(), radiances.size() * sizeof(glm::vec3), "Colors");
    const Kernel kernel = make_test_kernel("show.comp", R"(
layout(local_size_x = 64) in;
layout(push_constant) uniform Push { uint count; };
#include "view/tone_curves.glsl"
layout(scalar, set = 0) readonly buffer Radiances { vec3 radiances[]; };
layout(scalar, set = 0) readonly buffer ViewTable { ViewTransform view; };
layout(scalar, set = 0) writeonly buffer Colors { vec3 colors[]; };
void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i < count) colors[i] = view_color(view, radiances[i]);
})",
                                           {{"Radiances", &in}, {"ViewTable", &view}, {"Colors", &out}});
    CommandList commands(test_device());
    commands.dispatch(kernel, uint32_t(radiances.size() / 64 + 1), {{"count", uint32_t(radiances.size())}});
    commands.run();
    return out.read_array<glm::vec3>(radiances.size());
}

std::vector<glm::vec3> some_radiances() {
    std::vector<glm::vec3> result = {
        glm::vec3(0), glm::vec3(1), {-1, 0, 2}, glm::vec3(NAN), glm::vec3(INFINITY)};
    for (int i = -60; i < 60; ++i) {
        const float x = std::exp2(float(i) / 4);
        result.insert(result.end(), {glm::vec3(x), {x, 0.2f * x, 0.01f}, {0.1f * x, x, 3 * x}});
    }
    return result;
}

}  // namespace

TEST_CASE("every tone curve on the device agrees with its twin to a quarter of a step of 1/255") {
    const std::vector<glm::vec3> radiances = some_radiances();
    for (int curve = 0; curve < 5; ++curve)
        for (const std::optional<double> temperature :
             {std::optional<double>(), std::optional<double>(3000)}) {
            ViewSettings settings;
            settings.curve = ToneCurve(curve);
            settings.temperature = temperature;
            settings.exposure = -0.5;
            CAPTURE(tone_curve_name(settings.curve));
            const auto colors = device_colors(settings, radiances);
            double greatest = 0;
            for (size_t i = 0; i < radiances.size(); ++i) {
                const glm::dvec3 wanted = shown_color(settings, glm::dvec3(radiances[i]));
                for (int c = 0; c < 3; ++c) greatest = std::max(greatest, std::abs(wanted[c] - colors[i][c]));
            }
            CHECK(greatest < 0.25 / 255);
        }
}

TEST_CASE("tone curves rise from black to white, and middle grey stays in the middle") {
    for (const ToneCurve curve : {ToneCurve::linear, ToneCurve::srgb, ToneCurve::aces, ToneCurve::agx}) {
        CAPTURE(tone_curve_name(curve));
        ViewSettings settings;
        settings.curve = curve;
        double last = -1;
        for (double x = 1e-4; x < 100; x *= 1.1) {
            const double shown = shown_color(settings, glm::dvec3(x)).y;
            CHECK(shown >= last - 1e-3);  // the AgX polynomial dips a little at its ends
            last = shown;
        }
        CHECK(shown_color(settings, glm::dvec3(1e-5)).y < 0.02);
        CHECK(shown_color(settings, glm::dvec3(100)).y > 0.97);
        const double grey = shown_color(settings, glm::dvec3(0.18)).y;
        if (curve != ToneCurve::linear) CHECK((grey > 0.4 && grey < 0.6));
    }
}

TEST_CASE("white balance makes light of the chosen temperature white") {
    // CIE 15:2004: illuminant A is a blackbody of 2856 K, x 0.4476, y 0.4074.
    const glm::dvec2 a = blackbody_chromaticity(2856);
    CHECK(a.x == doctest::Approx(0.4476).epsilon(0.002));
    CHECK(a.y == doctest::Approx(0.4074).epsilon(0.002));
    const glm::dmat3 rgb_from_xyz = glm::transpose(
        glm::dmat3(3.2406, -1.5372, -0.4986, -0.9689, 1.8758, 0.0415, 0.0557, -0.2040, 1.0570));
    for (const double kelvin : {2000.0, 2856.0, 5000.0, 10000.0}) {
        CAPTURE(kelvin);
        const glm::dvec2 xy = blackbody_chromaticity(kelvin);
        const glm::dvec3 light = rgb_from_xyz * glm::dvec3(xy.x / xy.y, 1, (1 - xy.x - xy.y) / xy.y);
        const glm::dvec3 balanced = white_balance(kelvin) * light;
        for (int c = 0; c < 3; ++c) CHECK(balanced[c] == doctest::Approx(balanced[1]).epsilon(0.005));
    }
    // Near D65 it changes little.
    const glm::dmat3 none = white_balance(6504);
    for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r) CHECK(std::abs(none[c][r] - (c == r)) < 0.05);
}

TEST_CASE("metering brings the mean logarithm of the luminance to 18 percent, in thirds of a stop") {
    CHECK(metered_exposure(std::vector<glm::vec3>(10, glm::vec3(0.18f))) == doctest::Approx(0));
    CHECK(metered_exposure(std::vector<glm::vec3>(10, glm::vec3(0.18f * 64))) == doctest::Approx(-6));
    CHECK(metered_exposure(std::vector<glm::vec3>{{0.09f, 0.09f, 0.09f}, {0.36f, 0.36f, 0.36f}, {0, 0, 0}}) ==
          doctest::Approx(0));
    CHECK(metered_exposure(std::vector<glm::vec3>{glm::vec3(0)}) == 0);
}

TEST_CASE("metering holds highlights back that one pixel in a hundred or more shows, but not lamps") {
    const auto metered = [](size_t bright, float light) {
        std::vector<glm::vec3> picture(100000, glm::vec3(0));  // black pixels do not count
        for (size_t i = 0; i < 1000; ++i) picture[7 * i] = glm::vec3(i < bright ? light : 0.01f);
        return metered_exposure(picture);
    };
    const double dark = std::log2(0.18 / 0.01);
    CHECK(std::abs(metered(0, 1) - dark) < 0.17);
    CHECK(std::abs(metered(20, 0.16f) - std::log2(1 / 0.16)) < 0.17);
    CHECK(std::abs(metered(9, 0.16f) - dark) < 0.25);  // a few sparks
    CHECK(std::abs(metered(20, 100) - dark) < 0.5);    // a lamp
}

TEST_CASE("the exposure is metered again as pictures become better, until somebody sets it") {
    Metering metering;
    PreviewPicture picture;
    const auto look = [&](double exposure, double light, uint32_t step, uint64_t passes) {
        picture.radiance = {glm::vec3(float(0.18 * light))};
        picture.step = step, picture.passes = passes;
        return metering.look(picture, exposure);
    };
    CHECK(look(0, 1.0 / 64, 16, 1).value() == doctest::Approx(6));  // coarse: hardly any light
    CHECK(!look(6, 1, 16, 1));
    CHECK(!look(6, 1.0 / 60, 2, 1));  // finer, and too little of a difference
    CHECK(look(6, 1.0 / 16, 1, 1).value() == doctest::Approx(4));
    CHECK(look(4, 1.0 / 4, 1, 2).value() == doctest::Approx(2));
    CHECK(!look(2, 1, 1, 3));   // not twice the passes
    CHECK(!look(2, 1, 16, 1));  // coarse once more, as another camera begins
    picture.request.moving = true;
    CHECK(!look(2, 1, 1, 8));
    picture.request.moving = false;
    CHECK(look(2, 1, 1, 16).value() == doctest::Approx(0));
    CHECK(!look(0, 4, 1, 1000));  // enough
    picture.algorithm = Algorithm::bidirectional;
    CHECK(look(0, 4, 1, 1).value() == doctest::Approx(-2));
    CHECK(!look(-1, 16, 1, 2));  // set by hand
    CHECK(!look(-2, 16, 1, 8));
}
