// Exact sums on the device (shaders/lib/exact_sum.glsl): the bits of their twin on the host, however the
// values are dealt to registers and memory.
#include "host/render/exact_sum.h"

#include <cmath>
#include <random>

#include "tests/support/device_fixture.h"

using namespace etendue;

namespace {

constexpr uint32_t lanes = 256, values_a_lane = 1020;

// Each lane adds its values `at_once` in registers, then to its sum in memory.
std::vector<ExactSum> device_sums(const std::vector<glm::vec3>& values, uint32_t at_once) {
    Buffer in = create_buffer(test_device(), values, "values"),
           out(test_device(), lanes * sizeof(ExactSum), "sums");
    out.fill(0);
    const Kernel kernel = make_test_kernel("sum_exactly", R"(
        #include "lib/exact_sum.glsl"
        layout(local_size_x = 64) in;
        layout(scalar, set = 0) readonly buffer Values { vec3 values[]; };
        layout(scalar, set = 0) buffer Sums { ExactSum sums[]; };
        layout(push_constant) uniform Push { uint values_a_lane, at_once; };
        void main() {
            uint lane = gl_GlobalInvocationID.x;
            for (uint first = 0u; first < values_a_lane; first += at_once) {
                Digits digits = no_digits();
                for (uint i = first; i < min(first + at_once, values_a_lane); ++i)
                    add_exactly(digits, values[lane * values_a_lane + i]);
                ADD_DIGITS(sums[lane], digits)
            }
        }
    )",
                                           {{"Values", &in}, {"Sums", &out}});
    CommandList list(test_device());
    list.dispatch(kernel, lanes / 64, {{"values_a_lane", values_a_lane}, {"at_once", at_once}});
    list.run();
    return out.read_array<ExactSum>(lanes);
}

}  // namespace

TEST_CASE("exact sums: the device's are the host's, bit for bit, however many are added at once") {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform;
    std::vector<glm::vec3> values(lanes * values_a_lane);
    for (size_t i = 0; i < values.size(); ++i) {
        // Lanes differ in the range of their values: from none to 10^-30 … 10^30, and the largest alone,
        // whose sums in registers are as large as they can be.
        const double range = double(i / values_a_lane % 16) * 2;
        for (int c = 0; c < 3; ++c)
            values[i][c] =
                float((uniform(random) < 0.3 ? -1 : 1) * std::pow(10, range * (2 * uniform(random) - 1)));
        if (i / values_a_lane % 16 == 0)
            values[i] = glm::vec3(std::nextafter(8388608.0f, 0.0f), -8388607.5f, 0.499999f);
    }
    std::vector<ExactSum> expected(lanes);
    for (size_t i = 0; i < values.size(); ++i) add_exactly(expected[i / values_a_lane], values[i]);
    for (const uint32_t at_once : {1u, 7u, 255u}) {
        const std::vector<ExactSum> sums = device_sums(values, at_once);
        for (uint32_t lane = 0; lane < lanes; ++lane) CHECK(sums[lane] == expected[lane]);
    }
}
