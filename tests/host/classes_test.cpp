// The registry and the reflection of records: every registered class compiles and describes its parameters.
#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <set>

#include "host/error.h"
#include "host/scene/classes.h"
#include "tests/support/source_path.h"
#include "tests/support/temporary_folder.h"

using namespace etendue;

namespace {
ShaderSources sources() {
    ShaderSources result;
    result.folder = source_path("shaders");
    return result;
}
const Parameter& parameter(const ClassInfo& info, const std::string& name) {
    for (const Parameter& p : info.parameters)
        if (p.member.name == name) return p;
    FAIL("no parameter ", name);
    throw 0;
}
}  // namespace

TEST_CASE("every registered class compiles alone, and its parameters are described") {
    ClassRegistry registry(sources());
    size_t count = 0;
    for (const InterfaceInfo& interface : all_interfaces()) {
        std::set<uint32_t> tags;
        for (const ClassInfo& listed : registry.classes(interface.interface)) {
            CAPTURE(listed.file);
            const ClassInfo* info = nullptr;
            CHECK_NOTHROW(info = registry.find(interface.interface, listed.name));
            if (!info) continue;
            CHECK(tags.insert(info->tag).second);
            CHECK(!info->summary.empty());
            for (const Parameter& p : info->parameters)
                if (p.from_scene) CHECK_MESSAGE(!p.text.empty(), p.member.name);
            ++count;
        }
    }
    CHECK(count >= 15);
}

TEST_CASE("a parameter's type, offset, default, range and unit come from its class file") {
    ClassRegistry registry(sources());
    const ClassInfo* camera = registry.find(Interface::receiver, "perspective");
    REQUIRE(camera);
    const Parameter& yfov = parameter(*camera, "yfov");
    CHECK(yfov.member.type == "float");
    CHECK(yfov.member.offset == 48);
    CHECK(yfov.default_value.get<double>() == doctest::Approx(0.7853981634));
    CHECK(yfov.unit == "rad");
    CHECK(yfov.in_range(1.0));
    CHECK(!yfov.in_range(0.0));
    CHECK(!yfov.in_range(4.0));
    CHECK(!parameter(*camera, "placement").from_scene);
    const ClassInfo* lambertian = registry.find(Interface::surface, "lambertian");
    CHECK(parameter(*lambertian, "reflectance").member.type == "SpectrumRef");
    CHECK(registry.find(Interface::surface, "velvet") == nullptr);
}

TEST_CASE("an element class from outside compiles with its interface's contract and dispatch") {
    const TemporaryFolder folder;
    std::ofstream(folder / "mirror_box.glsl")
        << "// Sends every ray back.\n"
           "struct MirrorBox {\n    float size;  //: 1 in (0, inf) m. Edge of the box.\n};\n"
           "bool mirror_box_enter(MirrorBox r, inout ElementRay ray) { return true; }\n"
           "bool mirror_box_leave(MirrorBox r, inout ElementRay ray) { ray.direction = -ray.direction; "
           "return true; }\n";
    ClassRegistry registry(sources());
    registry.add_class_file(Interface::element, folder / "mirror_box.glsl");
    const ClassInfo* info = registry.find(Interface::element, "mirror_box");
    REQUIRE(info);
    CHECK(parameter(*info, "size").unit == "m");
    std::ofstream(folder / "half_box.glsl")
        << "struct HalfBox { float size; };\n"
           "bool half_box_enter(HalfBox r, inout ElementRay ray) { return true; }\n";
    registry.add_class_file(Interface::element, folder / "half_box.glsl");
    CHECK_THROWS_AS(registry.find(Interface::element, "half_box"), Error);  // half_box_leave is missing
}
