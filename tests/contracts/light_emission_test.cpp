// The choice of the light that a forward ray leaves, on the device: as often as stated, in proportion to
// power.
#include <cmath>
#include <random>

#include "host/lights/emission_choice.h"
#include "host/scene/features.h"
#include "tests/support/device_fixture.h"
#include "tests/support/source_path.h"
#include "tests/support/statistics.h"

using namespace etendue;

namespace {

constexpr double false_alarm = 1e-4;

struct Choice {
    uint32_t light;
    float probability, stated;
};

const char* const text = R"(
    #include "features/light_emission.glsl"
    layout(local_size_x = 64) in;
    struct Choice { uint light; float probability; float stated; };
    layout(scalar, set = 0) readonly buffer Numbers { float numbers[]; };
    layout(scalar, set = 0) writeonly buffer Choices { Choice choices[]; };
    layout(push_constant) uniform Push { uint count; };
    void main() {
        uint i = gl_GlobalInvocationID.x;
        if (i >= count) return;
        Choice c;
        c.light = choose_emitter(numbers[i], c.probability);
        c.stated = emitter_probability(c.light);
        choices[i] = c;
    }
)";

std::vector<Choice> choose(const std::vector<EmissionChoice>& table, uint32_t lights,
                           const std::vector<float>& numbers) {
    ShaderSources sources;
    sources.folder = source_path("shaders");
    sources.generated["choose_emitters.comp"] = text;
    Features features;
    features.light_count = lights;
    CompileOptions options;
    options.defines = features.defines();
    Buffer in = create_buffer(test_device(), numbers, "numbers"),
           entries = create_buffer(test_device(), table, "emission"),
           out(test_device(), numbers.size() * sizeof(Choice), "choices");
    const Kernel kernel(test_device(), compile_shader(sources, "choose_emitters.comp", options),
                        {{"Numbers", &in}, {"Choices", &out}, {"LightEmission", &entries}});
    CommandList list(test_device());
    list.dispatch(kernel, uint32_t(numbers.size() + 63) / 64, {{"count", uint32_t(numbers.size())}});
    list.run();
    return out.read_array<Choice>(numbers.size());
}

// Powers over nine orders of magnitude, some zero.
std::vector<double> test_powers(uint32_t count) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform;
    std::vector<double> powers;
    for (uint32_t i = 0; i < count; ++i)
        powers.push_back(i % 5 == 3 ? 0.0 : std::pow(10.0, 9 * uniform(random) - 4));
    return powers;
}

}  // namespace

TEST_CASE("light emission: lights are chosen as often as stated, and in proportion to power") {
    const std::vector<uint32_t> counts = {2, 7, 100, 5000};
    for (uint32_t count : counts) {
        CAPTURE(count);
        const std::vector<double> powers = test_powers(count);
        const auto table = build_emission_choices(powers);
        std::mt19937 random(11);
        std::vector<float> numbers(1 << 21);
        for (float& u : numbers) u = float(random() >> 8) * 0x1p-24f;
        std::vector<double> observed(count), expected(count);
        bool agrees = true;
        for (const Choice& c : choose(table, count, numbers)) {
            REQUIRE(c.light < count);
            observed[c.light] += 1;
            agrees = agrees && c.probability == c.stated && c.probability > 0;
        }
        CHECK(agrees);
        double power = 0;
        for (double p : powers) power += p;
        for (uint32_t i = 0; i < count; ++i) {
            expected[i] = table[i].probability * double(numbers.size());
            // Every entry's threshold is known to a random number, of which it has 2^24 / count.
            CHECK(std::abs(table[i].probability - powers[i] / power) <
                  2e-7 * count * (1 + powers[i] / power));
            CHECK((table[i].probability > 0) == (powers[i] > 0));
        }
        CHECK(chi_squared_test(observed, expected).p_value > sidak_level(false_alarm, counts.size()));
    }
}

TEST_CASE("light emission: over all random numbers each light is chosen exactly as often as stated") {
    const uint32_t count = 4001;
    const auto table = build_emission_choices(test_powers(count));
    std::vector<float> numbers(1 << 21);
    std::vector<double> times(count);
    for (uint32_t part = 0; part < 8; ++part) {
        for (uint32_t i = 0; i < numbers.size(); ++i)
            numbers[i] = float(part * uint32_t(numbers.size()) + i) * 0x1p-24f;
        for (const Choice& c : choose(table, count, numbers)) times[c.light] += 1;
    }
    uint32_t wrong = 0;
    for (uint32_t i = 0; i < count; ++i) wrong += times[i] != double(table[i].probability) * 0x1p24;
    CHECK(wrong == 0);
}

TEST_CASE("light emission: one light needs no choice, dark ones are never chosen") {
    const std::vector<float> numbers = {0.0f, 0.3f, 0.9999f};
    for (const Choice& c : choose(std::vector<EmissionChoice>(1), 1, numbers)) {
        CHECK(c.light == 0);
        CHECK(c.probability == 1.0f);
        CHECK(c.stated == 1.0f);
    }
    const std::vector<double> dark(3);
    for (const Choice& c : choose(build_emission_choices(dark), 3, numbers)) CHECK(c.probability == 0.0f);
    const std::vector<double> one = {0, 2, 0};
    for (const Choice& c : choose(build_emission_choices(one), 3, numbers)) {
        CHECK(c.light == 1);
        CHECK(c.probability == 1.0f);
    }
}
