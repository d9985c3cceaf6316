// Gratings: the directions of their orders, in the plane across the grooves and out of it, which of them are
// evanescent and what becomes of their light, and that all of it goes back the way it came.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/error.h"
#include "host/scene/grating_table.h"
#include "tests/contracts/surface_configurations.h"
#include "tests/contracts/mueller_frames.h"
#include "tests/support/source_path.h"
#include "tests/support/surface_probe.h"
#include "tests/support/temporary_folder.h"

using namespace etendue;
using nlohmann::json;

namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr double line = 587.6e-9;  // m, the wavelength that all light has where it is traced in colours

ClassRegistry registry() {
    ShaderSources sources;
    sources.folder = source_path("shaders");
    return ClassRegistry(sources);
}

// Of `shift` = wavelength / period, with the vector of order 1 along +x; each order to either side carries as
// much.
json grating(double shift, int most, const char* evanescent = "absorbed") {
    json orders = json::array();
    for (int m = -most; m <= most; ++m)
        orders.push_back(
            {{"order", m}, {"reflected", 0.4 / (2 * most + 1)}, {"transmitted", 0.6 / (2 * most + 1)}});
    return {{"period", line / shift}, {"axis", -90 * degree}, {"orders", orders}, {"evanescent", evanescent}};
}

struct Order {
    glm::vec3 wi;
    double part;  // of the power, or of the radiance, that is scattered between the two directions
    bool reflected;
};

// All directions that samples take.
std::vector<Order> orders_of(SurfaceProbe& probe, size_t record, const SurfaceSurroundings& at,
                             const glm::vec3& wo) {
    std::vector<Order> found;
    for (const SurfaceSample& s : probe.sample(record, at, wo, 8192, 5).samples) {
        if (!s.event) continue;
        if (!(s.event & event_delta) || std::abs(glm::length(s.wi) - 1) > 1e-6f)
            FAIL("no direction of an order");
        const auto same = [&](const Order& o) { return glm::distance(o.wi, s.wi) < 1e-4f; };
        if (std::none_of(found.begin(), found.end(), same))
            found.push_back({s.wi, double(s.weight.x) * s.pdf, (s.event & event_reflect) != 0});
    }
    return found;
}

struct Ray {
    int order;
    double polar, azimuth;  // degrees, of where the light goes; the polar angle is to the normal on its side
};

// Light that goes along (polar, azimuth), downward from above, and where all its orders go.
struct Mount {
    double shift, polar, azimuth;
    float ior_below;
    std::vector<Ray> reflected, transmitted;
};

void check_rays(const std::vector<Order>& found, const std::vector<Ray>& expected, bool reflected,
                double part) {
    CHECK(size_t(std::count_if(found.begin(), found.end(),
                               [&](const Order& o) { return o.reflected == reflected; })) == expected.size());
    for (const Ray& ray : expected) {
        CAPTURE(ray.order);
        const double theta = ray.polar * degree, phi = ray.azimuth * degree, up = reflected ? 1 : -1;
        const glm::vec3 wi(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                           up * std::cos(theta));
        const auto match = std::find_if(found.begin(), found.end(),
                                        [&](const Order& o) { return glm::distance(o.wi, wi) < 2e-6f; });
        REQUIRE(match != found.end());
        CHECK(match->part == doctest::Approx(part).epsilon(1e-5));
    }
}

}  // namespace

// Angles by hand: k + m lambda / period along the surface. 1000 lines a millimetre at 550 nm; the same in a
// conical mount; glass of 1.5 below, 600 nm at 1.2 µm; a coupler of 380 nm at 532 nm into glass of 1.7, whose
// orders lie beyond its critical angle of 36.03 degrees; 1200 lines at 632.8 nm in Littrow's mount, where
// order -1 goes back.
TEST_CASE("orders of a grating leave at the angles of the grating equation, and no others do") {
    const std::vector<Mount> mounts = {
        {0.55,
         45,
         0,
         1,
         {{0, 45, 0}, {-1, 9.03900, 0}, {-2, 23.13464, 180}, {-3, 70.54325, 180}},
         {{0, 45, 0}, {-1, 9.03900, 0}, {-2, 23.13464, 180}, {-3, 70.54325, 180}}},
        {0.55,
         30,
         90,
         1,
         {{0, 30, 90}, {1, 48.01358, 42.27369}, {-1, 48.01358, 137.72631}},
         {{0, 30, 90}, {1, 48.01358, 42.27369}, {-1, 48.01358, 137.72631}}},
        {0.5,
         30,
         40,
         1.5f,
         {{-2, 44.08056, 152.48426}, {-1, 20, 110}, {0, 30, 40}, {1, 70, 20}},
         {{-3, 50.79274, 163.94761},
          {-2, 27.63126, 152.48426},
          {-1, 13.18014, 110},
          {0, 19.47122, 40},
          {1, 38.78956, 20},
          {2, 71.18826, 13.08249}}},
        {532.0 / 380, 0, 0, 1.7f, {{0, 0, 0}}, {{0, 0, 0}, {1, 55.43968, 0}, {-1, 55.43968, 180}}},
        {632.8e-9 * 1.2e6,
         22.31386,
         0,
         1,
         {{0, 22.31386, 0}, {-1, 22.31386, 180}},
         {{0, 22.31386, 0}, {-1, 22.31386, 180}}},
    };
    ClassRegistry classes = registry();
    for (const Mount& mount : mounts) {
        CAPTURE(mount.shift);
        CAPTURE(mount.azimuth);
        SurfaceProbe probe(classes, "grating", {grating(mount.shift, 4)});
        const glm::vec3 wo = -glm::vec3(direction(mount.polar * degree, mount.azimuth * degree));
        const glm::vec3 from(wo.x, wo.y, -wo.z);  // where the light comes from, above
        const auto found = orders_of(probe, 0, {1, mount.ior_below, true}, from);
        check_rays(found, mount.reflected, true, 0.4 / 9);
        check_rays(found, mount.transmitted, false, 0.6 / 9);
    }
    CHECK(std::asin(1 / 1.7) / degree == doctest::Approx(36.03188).epsilon(1e-6));
}

TEST_CASE(
    "light that comes along an order of a grating goes back by the same part, and radiance by that over n²") {
    const json blazed = {{{"order", 1}, {"reflected", 0.5}, {"reflected_below", 0.1}, {"transmitted", 0.1}},
                         {{"order", 0}, {"reflected", 0.1}, {"transmitted", 0.05}},
                         {{"order", -2}, {"reflected", 0.15}, {"transmitted", 0.1}}};
    ClassRegistry classes = registry();
    std::vector<json> gratings;
    for (const char* evanescent : {"absorbed", "zero_order"})
        for (const double period : {0.4e-6, 0.7e-6, 1.9e-6}) {
            gratings.push_back(
                {{"period", period}, {"axis", 0.7}, {"orders", blazed}, {"evanescent", evanescent}});
            json even = grating(line / period, 2, evanescent);
            gratings.push_back(even);
        }
    SurfaceProbe probe(classes, "grating", gratings);
    size_t pairs = 0;
    for (const auto& [above, below] : {std::pair(1.f, 1.f), {1.f, 1.5f}, {1.7f, 1.33f}})
        for (size_t record = 0; record < gratings.size(); ++record)
            for (int k = 0; k < 12; ++k) {
                CAPTURE(gratings[record].dump());
                CAPTURE(k);
                const glm::vec3 wo(glm::normalize(
                    glm::dvec3(std::sin(k * 2.3), std::cos(k * 3.1), std::sin(k * 1.7 + 0.4))));
                const auto power = orders_of(probe, record, {above, below, true}, wo);
                const auto radiance = orders_of(probe, record, {above, below, false}, wo);
                CHECK(power.size() == radiance.size());
                for (const Order& there : power) {
                    if (there.part < 0.02 || std::abs(there.wi.z) < 0.02) continue;
                    const double n_o = wo.z > 0 ? above : below, n_i = there.wi.z > 0 ? above : below;
                    const auto part_of = [](const std::vector<Order>& all, const glm::vec3& wi) {
                        for (const Order& o : all)
                            if (glm::distance(o.wi, wi) < 1e-4f) return o.part;
                        return 0.0;
                    };
                    const auto back = orders_of(probe, record, {above, below, true}, there.wi);
                    CHECK(part_of(back, wo) == doctest::Approx(there.part).epsilon(1e-4));
                    CHECK(part_of(radiance, there.wi) ==
                          doctest::Approx(there.part * n_o * n_o / (n_i * n_i)).epsilon(1e-4));
                    ++pairs;
                }
            }
    CHECK(pairs > 500);
}

TEST_CASE("what a grating's evanescent orders would carry is absorbed, or order 0 takes it") {
    ClassRegistry classes = registry();
    // 30 degrees, lambda / period = 0.6: sines 0.5 + 0.6 m. Of the orders -2 to 2 only 0, -1, -2 propagate.
    const json lopsided = {{{"order", 1}, {"reflected", 0.5}},
                           {{"order", -1}, {"reflected", 0.2}},
                           {{"order", 0}, {"reflected", 0.1}}};
    const json period = line / 0.6;
    SurfaceProbe probe(classes, "grating",
                       {grating(0.6, 2),
                        grating(0.6, 2, "zero_order"),
                        {{"period", period}, {"axis", -90 * degree}, {"orders", lopsided}}});
    const glm::vec3 from(direction(30 * degree, std::numbers::pi));
    const auto sum = [&](const std::vector<Order>& all) {
        double parts = 0;
        for (const Order& o : all) parts += o.part;
        return parts;
    };
    const auto zero = [&](const std::vector<Order>& all, bool reflected) {
        for (const Order& o : all)
            if (o.reflected == reflected && std::abs(o.wi.x - 0.5) < 1e-5) return o.part;
        return 0.0;
    };
    const SurfaceSurroundings at{1, 1, true};
    CHECK(sum(orders_of(probe, 0, at, from)) == doctest::Approx(0.6).epsilon(1e-5));
    const auto kept = orders_of(probe, 1, at, from);
    CHECK(sum(kept) == doctest::Approx(1).epsilon(1e-5));
    CHECK(zero(kept, true) == doctest::Approx(0.08 * 3).epsilon(1e-5));
    CHECK(zero(kept, false) == doctest::Approx(0.12 * 3).epsilon(1e-5));
    // Back along order 0 it is order -1 that is evanescent, with 0.2.
    const auto blazed = orders_of(probe, 2, at, from);
    CHECK(zero(blazed, true) == doctest::Approx(0.3).epsilon(1e-5));
    CHECK(sum(blazed) == doctest::Approx(0.5).epsilon(1e-5));
    // Within glass of 1.5, beyond the critical angle: what was to be transmitted is reflected.
    const glm::vec3 within(direction(150 * degree, std::numbers::pi));
    SurfaceProbe glass(classes, "grating", {grating(0.1, 1, "zero_order")});
    const glm::vec3 beyond(-0.9f, 0,
                           -std::sqrt(1 - 0.81f));  // 1.35 along the surface: no order is below 1.25
    const auto reflected = orders_of(glass, 0, {1, 1.5f, true}, beyond);
    CHECK(sum(reflected) == doctest::Approx(1).epsilon(1e-5));
    for (const Order& o : reflected) CHECK(o.reflected);
    CHECK(sum(orders_of(glass, 0, {1, 1.5f, true}, within)) == doctest::Approx(1).epsilon(1e-5));
}

TEST_CASE("a grating reflects light from below as was said of that, towards the same side") {
    const json orders = {{{"order", 1}, {"reflected", 0.5}, {"reflected_below", 0.1}},
                         {{"order", 0}, {"reflected", 0.2}}};
    ClassRegistry classes = registry();
    SurfaceProbe probe(classes, "grating",
                       {{{"period", line / 0.6}, {"axis", -90 * degree}, {"orders", orders}}});
    for (const float up : {1.f, -1.f}) {
        CAPTURE(up);
        const auto found = orders_of(probe, 0, {1, 1, true}, {0, 0, up});
        REQUIRE(found.size() == 2);
        for (const Order& o : found) {
            const bool zero = o.wi.x < 0.3f;
            CHECK(glm::distance(o.wi, zero ? glm::vec3(0, 0, up) : glm::vec3(0.6f, 0, 0.8f * up)) < 1e-5f);
            CHECK(o.part == doctest::Approx(zero ? 0.2 : up > 0 ? 0.5 : 0.1).epsilon(1e-5));
        }
    }
}

// Without wavelengths lanes have those of 611, 549 and 464 nm.
TEST_CASE("a table gives what stands in its rows, and between them what is linear in the sine") {
    ClassRegistry classes = registry();
    const json rows = grating_table();
    SurfaceProbe probe(classes, "grating",
                       {{{"period", line / 0.3}, {"axis", -90 * degree}, {"efficiencies", rows}}});
    const auto told = [&](int order, const char* side, const char* kind, double angle) {
        double sum = 0;  // of s and p, at 611 nm
        for (const json& row : rows)
            if (row["order"] == order && row["side"] == side && std::abs(double(row["angle"]) - angle) < 1e-9)
                sum += double(row[kind][2]);
        return 0.5 * sum;
    };
    size_t found = 0;
    for (const bool above : {true, false})
        for (const double angle : {-0.4, 0.1, 0.35}) {
            const char* const side = above ? "above" : "below";
            // Light travels towards +x where the angle is above 0.
            const glm::vec3 from(-std::sin(angle), 0, (above ? 1 : -1) * std::cos(angle));
            for (const Order& o : orders_of(probe, 0, {1, 1, true}, from)) {
                const int m = int(std::lround((o.wi.x - std::sin(angle)) / 0.3));
                const char* const kind = o.reflected ? "reflected" : "transmitted";
                double expected = told(m, side, kind, angle);
                if (angle == 0.35) {
                    const double part = (std::sin(angle) - std::sin(0.1)) / (std::sin(0.6) - std::sin(0.1));
                    expected = (1 - part) * told(m, side, kind, 0.1) + part * told(m, side, kind, 0.6);
                }
                CHECK(o.part == doctest::Approx(expected).epsilon(2e-5));
                ++found;
            }
        }
    CHECK(found == 2 * 3 * 6);
}

TEST_CASE("a table is of the light, whichever way a path goes") {
    ClassRegistry classes = registry();
    SurfaceProbe probe(classes, "grating",
                       {{{"period", line / 0.3}, {"axis", 0.4}, {"efficiencies", grating_table()}}});
    size_t pairs = 0;
    for (int k = 0; k < 12; ++k) {
        const glm::vec3 wo(
            glm::normalize(glm::dvec3(std::sin(k * 2.3), std::cos(k * 3.1), 1.2 * std::sin(k * 1.7 + 0.4))));
        for (const Order& o : orders_of(probe, 0, {1, 1.5f, false}, wo)) {
            if (std::abs(o.wi.z) < 0.05 || std::abs(wo.z) < 0.05) continue;
            const double n_o = wo.z > 0 ? 1 : 1.5, n_i = o.wi.z > 0 ? 1 : 1.5;
            double power = 0;
            for (const Order& light : orders_of(probe, 0, {1, 1.5f, true}, o.wi))
                if (glm::distance(light.wi, wo) < 1e-4f) power = light.part;
            CHECK(o.part == doctest::Approx(power * n_o * n_o / (n_i * n_i)).epsilon(2e-4));
            ++pairs;
        }
    }
    CHECK(pairs > 30);
}

// Reciprocity: order m carries as much of light that comes along one of its two directions as along the
// other.
TEST_CASE("a table of what is the same both ways, is so") {
    json rows = json::array();
    const double shift = 0.3;
    for (int order = -1; order <= 1; ++order)
        for (int i = -40; i <= 40; ++i) {
            const double sine = i / 40.0;  // leaves at sine + order shift; back it comes at minus that
            const double middle = sine + 0.5 * order * shift;
            rows.push_back({{"order", order},
                            {"angle", std::asin(sine)},
                            {"reflected", 0.2 / (1 + middle * middle)},
                            {"transmitted", 0.1 * std::exp(-2 * middle * middle)}});
        }
    ClassRegistry classes = registry();
    SurfaceProbe probe(classes, "grating",
                       {{{"period", line / shift}, {"axis", -90 * degree}, {"efficiencies", rows}}});
    size_t pairs = 0;
    for (const double angle : {-1.0, -0.3, 0.17, 0.8}) {
        const glm::vec3 from(-std::sin(angle), 0, std::cos(angle));
        for (const Order& o : orders_of(probe, 0, {1, 1, true}, from))
            for (const Order& back : orders_of(probe, 0, {1, 1, true}, o.wi))
                if (glm::distance(back.wi, from) < 1e-4f) {
                    CHECK(back.part == doctest::Approx(o.part).epsilon(2e-3));
                    ++pairs;
                }
    }
    CHECK(pairs >= 16);
}

TEST_CASE("tables that make no sense are told in one line, and files by theirs") {
    SceneDescription scene;
    const auto message = [&](const json& table) -> std::string {
        try {
            read_grating_table(table, scene, "/efficiencies");
        } catch (const Error& e) {
            CHECK(e.code == ExitCode::bad_input);
            return e.what();
        }
        return "";
    };
    const auto tells = [&](const json& table, const std::string& words) {
        const std::string text = message(table);
        CHECK_MESSAGE(text.find(words) != std::string::npos, text);
        CHECK(text.find('\n') == std::string::npos);
    };
    const json s = {{"order", 1}, {"polarization", "s"}, {"wavelength", 550}, {"reflected", 0.5}};
    json p = s, other = s;
    p["polarization"] = "p", other["wavelength"] = 600;
    CHECK(message({s, p}) == "");
    tells(0.5, "/efficiencies: allowed: a list of rows");
    tells(json::array(), "has no rows");
    tells({s, s},
          "/efficiencies/1: order 1, reflected from above at 550 nm and 0 rad, s, stands there twice");
    tells(json::array({s}),
          "order 1, reflected from above: nothing at 550 nm and 0 rad, p; allowed: values at all");
    tells({s, p, other}, "order 1, reflected from above: nothing at 600 nm and 0 rad, p");
    tells({{{"order", 1}, {"side", "left"}, {"reflected", 0.5}}},
          "/0/side: is \"left\"; allowed: above, below");
    tells({{{"order", 1}, {"reflected", 1.5}}}, "/0/reflected: allowed: numbers from 0 to 1");
    tells({{{"order", 1}, {"angle", 2}, {"reflected", 0.5}}}, "/0/angle: allowed");
    tells({{{"order", 1}}}, "/0: has no efficiency");
    tells({{{"order", 1}, {"wavelength", {500, 600}}, {"reflected", 0.5}}}, "/0/reflected: allowed: as many");
    tells({{{"order", 1}, {"reflected", 0.7}}, {{"order", 2}, {"transmitted", 0.4}}},
          "orders carry 1.1 of the light from above at 550 nm and 0 rad, s, together; allowed: at most 1");

    const TemporaryFolder folder;
    scene.folder = folder.path;
    write_text(folder / "orders.csv",
               "# measured\norder, wavelength, polarization, transmitted\n1, 500, s, 0.25\n"
               "1, 500, p, 0.5\n1, 600, s, 0.125\n1, 600, p, 0\n");
    const GratingEfficiencies read = read_grating_table({{"file", "orders.csv"}}, scene, "/efficiencies");
    CHECK(read.orders == std::vector<int>{0, 1});
    CHECK(read.polarizes);
    CHECK(read.transmits);
    CHECK(read.wavelengths == 2);
    CHECK(read.sines == 1);
    // Wavelengths, sine, then order 0 of four blocks; of order 1 what is reflected from above.
    CHECK(std::vector<float>(read.numbers.begin() + 3 + 5 * 4, read.numbers.begin() + 3 + 6 * 4) ==
          std::vector<float>{0.25f, 0.5f, 0.125f, 0});
    write_text(folder / "bad.csv", "order, transmitted\n1, 0.5\n2\n");
    tells({{"file", "bad.csv"}}, "bad.csv: line 3: has 1 cells; allowed: 2");
    write_text(folder / "bad.csv", "order, transmitted\n1, much\n");
    tells({{"file", "bad.csv"}}, "bad.csv: line 2/transmitted: allowed: numbers from 0 to 1");
    tells({{"file", "none.csv"}}, "none.csv: cannot be read");
}

TEST_CASE("orders that make no sense are told in one line") {
    const SceneDescription scene;
    const auto message = [&](const json& orders) -> std::string {
        try {
            read_grating_orders(orders, scene, "/orders",
                                [](const SpectralValue&, SpectralKind) { return 0u; });
        } catch (const Error& e) {
            CHECK(e.code == ExitCode::bad_input);
            return e.what();
        }
        return "";
    };
    const auto tells = [&](const json& orders, const std::string& words) {
        const std::string text = message(orders);
        CHECK_MESSAGE(text.find(words) != std::string::npos, text);
        CHECK(text.find('\n') == std::string::npos);
    };
    const json one = {{"order", 1}, {"reflected", 0.5}};
    CHECK(message(json::array({one})) == "");
    CHECK(message({{{"order", 0}, {"transmitted", 1}}, {{"order", 1}, {"reflected_below", 0}}}) == "");
    tells(0.5, "/orders: allowed: a list of");
    tells(json::array(), "/orders: allowed: a list of");
    tells(json::array({0.5}), "/orders/0: allowed: a list of");
    tells(json::array({one, one}), "/orders/1/order: 1 stands there twice");
    tells(json::array({{{"reflected", 0.5}}}),
          "/orders/0/order: allowed: a whole number from -100000 to 100000");
    tells(json::array({{{"order", 0.5}}}), "/orders/0/order: allowed: a whole number");
    tells(json::array({{{"order", 2}, {"absorbed", 0.5}}}),
          "/orders/0/absorbed: unknown; allowed: order, reflected");
    tells(json::array({{{"order", 2}, {"reflected", 1.5}}}), "/orders/0/reflected: 1.5 is out of range");
    tells(json::array({{{"order", 2}, {"reflected", "much"}}}), "/orders/0/reflected");
    tells(json::array({one, {{"order", 2}, {"transmitted", 0.6}}}),
          "/orders: orders carry 1.1 of the light from the side of the normal together");
    tells(json::array({one, {{"order", 2}, {"reflected_below", 0.6}}}),
          "/orders: orders carry 1.1 of the light from below together");
    json many = json::array();
    for (int m = 0; m < 65; ++m) many.push_back({{"order", m}});
    tells(many, "/orders: 65 orders; allowed: at most 64");
}
