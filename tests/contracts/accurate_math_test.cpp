// shaders/lib/accurate_math.glsl against double precision, on the device.
#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

#include "tests/support/device_fixture.h"

using namespace etendue;

namespace {

struct Result {
    float atan2, asin, acos, cosine, sine, versine;
};

// Of pairs (y, x); the functions of one argument take y.
std::vector<Result> run_functions(const std::vector<glm::vec2>& arguments) {
    const uint32_t count = uint32_t(arguments.size());
    Buffer in = create_buffer(test_device(), arguments, "arguments"),
           out(test_device(), count * sizeof(Result), "results");
    const Kernel kernel = make_test_kernel("evaluate_functions", R"(
        #include "lib/accurate_math.glsl"
        layout(local_size_x = 64) in;
        struct Result { float atan2, asin, acos, cosine, sine, versine; };
        layout(scalar, set = 0) readonly buffer Arguments { vec2 arguments[]; };
        layout(scalar, set = 0) writeonly buffer Results { Result results[]; };
        layout(push_constant) uniform Push { uint count; };
        void main() {
            uint i = gl_GlobalInvocationID.x;
            if (i >= count) return;
            vec2 a = arguments[i];
            vec2 turned = cos_sin_turns(a.x);
            results[i] = Result(accurate_atan2(a.x, a.y), accurate_asin(a.x), accurate_acos(a.x), turned.x, turned.y, versine(a.x));
        }
    )",
                                           {{"Arguments", &in}, {"Results", &out}});
    CommandList list(test_device());
    list.dispatch(kernel, (count + 63) / 64, {{"count", count}});
    list.run();
    return out.read_array<Result>(count);
}

double relative(double value, double expected) {
    return expected == 0 ? std::abs(value) : std::abs(value / expected - 1);
}

}  // namespace

TEST_CASE("accurate math: asin, acos and versine keep a relative error of a few units in the last place") {
    std::vector<glm::vec2> arguments;
    for (int i = -100000; i <= 100000; ++i) arguments.push_back({float(i) / 100000, 0});
    for (int e = 1; e < 24; ++e)
        for (float x : {std::exp2(float(-e)), 1 - std::exp2(float(-e))})
            arguments.push_back({x, 0}), arguments.push_back({-x, 0});
    const auto results = run_functions(arguments);
    double asin_error = 0, acos_error = 0, versine_error = 0;
    for (size_t i = 0; i < results.size(); ++i) {
        const double x = arguments[i].x;
        asin_error = std::max(asin_error, relative(results[i].asin, std::asin(x)));
        acos_error = std::max(acos_error, relative(results[i].acos, std::acos(x)));
        if (std::abs(x) > 1e-15)
            versine_error =
                std::max(versine_error, relative(results[i].versine, 2 * std::pow(std::sin(x / 2), 2)));
    }
    CHECK(asin_error < 4e-7);
    CHECK(acos_error < 4e-7);
    CHECK(versine_error < 8e-7);
}

TEST_CASE("accurate math: arguments of asin and acos beyond 1 count as 1") {
    const auto results = run_functions({{1.0001f, 0}, {-1.0001f, 0}});
    CHECK(results[0].acos == 0.0f);
    CHECK(results[1].acos == doctest::Approx(3.14159265));
    CHECK(results[1].asin == doctest::Approx(-1.57079633));
}

TEST_CASE("accurate math: atan2 is right in every quadrant and at every scale") {
    std::vector<glm::vec2> arguments = {{0, 1}, {0, -1}, {1, 0}, {-1, 0}};
    for (int i = 0; i < 100000; ++i) {
        const double angle = (i + 0.5) / 100000 * 6.283185307179586 - 3.141592653589793;
        const double scale = std::exp2(double(i % 61 - 30));
        arguments.push_back({float(scale * std::sin(angle)), float(scale * std::cos(angle))});
    }
    for (int e = 1; e < 60; ++e)
        arguments.push_back({std::exp2(float(-e)), 1}), arguments.push_back({1, std::exp2(float(-e))});
    const auto results = run_functions(arguments);
    double worst = 0;
    for (size_t i = 0; i < results.size(); ++i)
        worst = std::max(
            worst, relative(results[i].atan2, std::atan2(double(arguments[i].x), double(arguments[i].y))));
    CHECK(worst < 4e-7);
    CHECK(run_functions({{0, 0}})[0].atan2 == 0.0f);
}

TEST_CASE("accurate math: cosine and sine of full turns are good to 2e-7, and exact at quarters") {
    std::vector<glm::vec2> arguments;
    for (int i = -200000; i <= 200000; ++i) arguments.push_back({float(i) / 65536, 0});
    const auto results = run_functions(arguments);
    double worst = 0;
    for (size_t i = 0; i < results.size(); ++i) {
        const double angle = 6.283185307179586 * arguments[i].x;
        worst = std::max({worst, std::abs(results[i].cosine - std::cos(angle)),
                          std::abs(results[i].sine - std::sin(angle))});
    }
    CHECK(worst < 2e-7);
    for (int quarter = -4; quarter <= 4; ++quarter) {
        const Result r = run_functions({{quarter * 0.25f, 0}})[0];
        CHECK(r.cosine == std::round(std::cos(quarter * 1.5707963267948966)));
        CHECK(r.sine == std::round(std::sin(quarter * 1.5707963267948966)));
    }
}
