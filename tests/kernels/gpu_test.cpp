// The GPU layer: buffers, reflection, kernels, push constants, indirect dispatch, timing.
#include <algorithm>
#include <array>
#include <glm/glm.hpp>
#include <numeric>

#include "host/error.h"
#include "host/gpu/buffer_addresses.h"
#include "tests/support/device_fixture.h"

using namespace etendue;

TEST_CASE("a kernel's bindings, push constants and records are read from its SPIR-V") {
    ShaderSources sources;
    sources.generated["probe"] = R"(
        layout(local_size_x = 64) in;
        struct Inner { vec4 data; };
        struct Record { float a; Inner inner; vec3 b; uint c; };
        layout(scalar, set = 0, binding = 5) readonly buffer Records__first { Record first[]; };
        layout(scalar, set = 0) buffer Results { float results[]; };
        layout(push_constant) uniform Push { uint count; float factor; };
        void main() { if (gl_GlobalInvocationID.x < count) results[gl_GlobalInvocationID.x] = factor * first[0].b.y + first[0].inner.data.x; }
    )";
    const ShaderLayout layout = reflect_shader(compile_shader(sources, "probe").spirv);
    REQUIRE(layout.blocks.size() == 2);
    const BlockLayout& records = layout.blocks[0].name == "Records" ? layout.blocks[0] : layout.blocks[1];
    CHECK(records.binding == 5);
    CHECK(records.stride == 36);
    CHECK(records.element_type == "Record");
    REQUIRE(records.element_members.size() == 4);
    CHECK(records.element_members[1].type == "Inner");
    CHECK(records.element_members[2].type == "vec3");
    CHECK(records.element_members[2].offset == 20);
    CHECK(layout.push_constants.size() == 2);
    CHECK(layout.local_size[0] == 64);
}

TEST_CASE("a kernel reads buffers and push constants and writes its results") {
    Device& device = test_device();
    std::vector<float> input(1000);
    std::iota(input.begin(), input.end(), 0.0f);
    Buffer in = create_buffer(device, input, "input");
    Buffer out(device, 4000, "output");
    const Kernel kernel = make_test_kernel("scale_input", R"(
        layout(local_size_x = 64) in;
        layout(scalar, set = 0) readonly buffer Input { float values[]; };
        layout(scalar, set = 0) buffer Output { float results[]; };
        layout(push_constant) uniform Push { uint count; float factor; };
        void main() { uint i = gl_GlobalInvocationID.x; if (i < count) results[i] = factor * values[i]; }
    )",
                                           {{"Input", &in}, {"Output", &out}});
    CommandList list(device);
    list.dispatch(kernel, 16, {{"count", 1000u}, {"factor", 3.0f}});
    KernelTimings timings;
    list.run(&timings);
    const auto result = out.read_array<float>(1000);
    for (int i = 0; i < 1000; ++i) REQUIRE(result[i] == 3.0f * float(i));
    CHECK(timings.at("scale_input").dispatches == 1);
}

TEST_CASE("components of a vector in a buffer are what the vector holds, wherever it was read or written before") {
    Device& device = test_device();
    std::vector<uint32_t> input(4 * 64);
    std::iota(input.begin(), input.end(), 0u);
    Buffer in = create_buffer(device, input, "input");
    Buffer out(device, 64 * 4 * 16, "output");
    // The first line of main reads a block: addresses must be there before it.
    const Kernel kernel = make_test_kernel("read_components", R"(
        layout(local_size_x = 64) in;
        struct Row { uvec4 whole, parts, own, own_parts; };
        layout(scalar, set = 0) readonly buffer Input { uvec4 values[]; };
        layout(scalar, set = 0) buffer Output { Row results[]; };
        void main() {
            uint zero = values[0].x, i = gl_GlobalInvocationID.x;
            results[i].whole = values[i];
            uvec4 v = values[i];
            results[i].parts = uvec4(v.x, values[i].y, values[i].z, values[i][3u - zero]);
            results[i].own = v + 1u;
            results[i].own.y += 5u;
            results[i].own_parts = uvec4(results[i].own.w, results[i].own.z, results[i].own.y, results[i].own.x);
        }
    )",
                                           {{"Input", &in}, {"Output", &out}});
    CommandList list(device);
    list.dispatch(kernel, 1);
    list.run();
    const auto rows = out.read_array<std::array<glm::uvec4, 4>>(64);
    for (uint32_t i = 0; i < rows.size(); ++i) {
        const glm::uvec4 v = 4 * i + glm::uvec4(0, 1, 2, 3);
        CHECK(rows[i] == std::array<glm::uvec4, 4>{v, v, v + glm::uvec4(1, 6, 1, 1), {4 * i + 4, 4 * i + 3, 4 * i + 7, 4 * i + 1}});
    }
}

TEST_CASE("a loop has as many turns as it wants, or as the device says") {
    Buffer out(test_device(), 256, "output");
    out.fill(0);
    const Kernel kernel = make_test_kernel("count_turns", R"(
        layout(local_size_x = 64) in;
        layout(scalar, set = 0) buffer Output { uint results[]; };
        layout(push_constant) uniform Push { uint wanted; };
        void main() {
            uint i = gl_GlobalInvocationID.x, turns = 0u;
            do turns += 1u + results[i]; while (subgroupAny(turns < wanted));
            results[i] = turns;
        }
    )",
                                           {{"Output", &out}});
    CommandList list(test_device());
    list.dispatch(kernel, 1, {{"wanted", 200000u}});
    list.run();
    const uint32_t most = test_device().description.max_loop_turns;
    for (const uint32_t turns : out.read_array<uint32_t>(64)) CHECK(turns == (most > 0 ? most : 200000u));
}

TEST_CASE(
    "arrays are read and written through addresses, beyond the size of a binding; other blocks stay bound") {
    Device& device = test_device();
    // Where a binding may be as large as an allocation, nearly as large as that: drivers pad buffers.
    const uint64_t words =
        std::min(device.description.max_buffer_range + 4000, device.description.max_allocation - 65536) / 4;
    Buffer large(device, 4 * words, "large");
    const uint32_t mark = 7;
    large.write(&mark, 4, 4 * (words - 1));
    Buffer fixed = create_buffer(device, std::vector<uint32_t>{uint32_t(words - 1), 0}, "fixed");
    const char* text = R"(
        layout(local_size_x = 1) in;
        layout(scalar, set = 0) buffer Large { uint values[]; };
        layout(scalar, set = 0) buffer Fixed { uint last, result; };
        void main() {
            result = values[last];
            values[last] = 8u;
            atomicAdd(values[last - 1u], 3u);
        }
    )";
    const Kernel kernel = make_test_kernel("touch_end", text, {{"Large", &large}, {"Fixed", &fixed}});
    large.write(&mark, 4, 4 * (words - 2));
    CommandList list(device);
    list.dispatch(kernel, 1);
    list.run();
    CHECK(fixed.read_array<uint32_t>(2)[1] == 7);
    CHECK(large.read_array<uint32_t>(2, words - 2) == std::vector<uint32_t>{10, 8});

    ShaderSources sources;
    sources.generated["touch_end"] = text;
    const AddressedShader changed = use_addresses(compile_shader(sources, "touch_end").spirv);
    CHECK(changed.blocks == std::vector<std::string>{"Large"});
}

TEST_CASE("a kernel may begin with a read of a buffer") {
    Device& device = test_device();
    Buffer in = create_buffer(device, std::vector<uint32_t>{5, 6}, "input");
    Buffer out(device, 8, "output");
    const char* text = R"(
        layout(local_size_x = 1) in;
        layout(scalar, set = 0) readonly buffer Input { uint values[]; };
        layout(scalar, set = 0) buffer Output { uint results[]; };
        void main() { results[0] = values[1]; }
    )";
    const Kernel kernel = make_test_kernel("read_first", text, {{"Input", &in}, {"Output", &out}});
    CommandList list(device);
    list.dispatch(kernel, 1);
    list.run();
    CHECK(out.read_array<uint32_t>(1)[0] == 6);
}

TEST_CASE("a buffer that the host does not bind is named") {
    CHECK_THROWS_WITH_AS(
        make_test_kernel("lonely",
                         "layout(scalar) buffer Missing { float a[]; }; void main() { a[0] = 1.0; }", {}),
        "kernel lonely reads buffer Missing, which the host does not bind", Error);
}

TEST_CASE("a shader error names file and line") {
    ShaderSources sources;
    sources.generated["broken.comp"] = "void main() {\n  undefined_name = 1;\n}\n";
    CHECK_THROWS_WITH_AS(compile_shader(sources, "broken.comp"),
                         "broken.comp:2: 'undefined_name' : undeclared identifier", Error);
}
