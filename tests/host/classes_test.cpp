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
