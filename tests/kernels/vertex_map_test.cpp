// The grid of light vertices against trying every pair on the host, and directions as octahedral points.
#include <algorithm>
#include <array>
#include <bit>
#include <numeric>
#include <random>

#include "tests/support/device_fixture.h"
#include "tests/support/vertex_map_probe.h"

using namespace etendue;

namespace {

using Points = std::vector<GridPoint>;

// The distance from a camera makes the radius, within the slope that the grid allows; keys in random order.
Points with_radii(const std::vector<glm::vec3>& positions, float least, float slope,
                  const glm::vec3& camera) {
    Points points;
    for (const glm::vec3& p : positions) points.push_back({p, least + slope * glm::distance(p, camera)});
    std::vector<uint32_t> keys(points.size());
    std::iota(keys.begin(), keys.end(), 7u);
    std::shuffle(keys.begin(), keys.end(), std::mt19937(5));
    for (size_t i = 0; i < points.size(); ++i) points[i].key = keys[i] * 64;
    return points;
}

std::vector<glm::vec3> in_box(size_t count, const glm::vec3& low, const glm::vec3& high, uint32_t seed = 1) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> uniform(0, 1);
    std::vector<glm::vec3> result(count);
    for (glm::vec3& p : result)
        for (int k = 0; k < 3; ++k) p[k] = low[k] + (high[k] - low[k]) * uniform(random);
    return result;
}

std::vector<uint32_t> brute_force(const Points& points, const GridPoint& query) {
    std::vector<uint32_t> keys;
    for (const GridPoint& p : points) {
        const glm::vec3 d = p.position - query.position;
        const float d2 = d.x * d.x + d.y * d.y + d.z * d.z;
        if (d2 <= query.radius * query.radius && (p.flags & light_vertex_merges)) keys.push_back(p.key);
    }
    std::sort(keys.begin(), keys.end());
    return keys;
}

// Asks at `queries` and returns how many neighbours there were in all.
size_t check_neighbours(VertexMapProbe& probe, const Points& points, const Points& queries, uint32_t room) {
    probe.store(points, 3, uint32_t(points.size()));
    REQUIRE(probe.map.counts().stored == points.size());
    auto found = probe.neighbours(queries, room);
    size_t total = 0, wrong = 0;
    for (size_t i = 0; i < queries.size(); ++i) {
        std::sort(found[i].begin(), found[i].end());
        wrong += found[i] != brute_force(points, queries[i]);
        total += found[i].size();
    }
    CHECK(wrong == 0);
    return total;
}

size_t largest_bucket(const VertexMapProbe& probe) {
    const auto starts = probe.map.buffers().at("BucketStarts")->read_array<uint32_t>(probe.map.buckets() + 1);
    size_t largest = 0;
    for (size_t i = 1; i < starts.size(); ++i) largest = std::max<size_t>(largest, starts[i] - starts[i - 1]);
    return largest;
}

size_t check_cloud(const std::vector<glm::vec3>& positions, float least, float slope, const glm::vec3& camera,
                   size_t query_count = 500, uint32_t room = 4000, size_t* crowding = nullptr) {
    const Points points = with_radii(positions, least, slope, camera);
    VertexMapProbe probe(test_device(), uint32_t(points.size()));
    Points queries;
    std::mt19937 random(9);
    std::uniform_real_distribution<float> uniform(-1, 1);
    for (size_t i = 0; i < query_count; ++i) {
        GridPoint p = points[random() % points.size()];
        if (i % 2) {  // not where a vertex is
            p.position += 0.8f * p.radius * glm::vec3(uniform(random), uniform(random), uniform(random));
            p.radius = least + slope * glm::distance(p.position, camera);
        }
        queries.push_back(p);
    }
    const size_t total = check_neighbours(probe, points, queries, room);
    if (crowding) *crowding = largest_bucket(probe);
    return total;
}

}  // namespace

TEST_CASE("vertex grid: neighbours are those of a search over all vertices") {
    const glm::vec3 origin(0), one(1);
    SUBCASE("in a volume") { CHECK(check_cloud(in_box(20000, -one, one), 0.05f, 0, origin) > 1000); }
    SUBCASE("radii of many levels") {
        CHECK(check_cloud(in_box(20000, -one, one), 1e-6f, 0.0499f, origin) > 500);
    }
    SUBCASE("a cluster around the camera") {
        std::vector<glm::vec3> positions = in_box(8000, -one, one);
        for (glm::vec3& p : positions) p *= std::pow(glm::length(p), 12.0f);
        CHECK(check_cloud(positions, 1e-6f, 0.0499f, origin) > 1000);
    }
    SUBCASE("on planes through cell faces") {
        std::vector<glm::vec3> positions = in_box(20000, -one, one);
        for (size_t i = 0; i < positions.size(); ++i) positions[i][int(i % 3)] = i % 2 ? 0.0f : 0.5f;
        CHECK(check_cloud(positions, 0.02f, 0.01f, origin) > 1000);
    }
    SUBCASE("on a lattice whose spacing is the radius") {
        std::vector<glm::vec3> positions;
        for (int i = 0; i < 8000; ++i)
            positions.push_back(glm::vec3(i % 20 - 10, i / 20 % 20 - 10, i / 400 - 10) / 8.0f);
        CHECK(check_cloud(positions, 0.125f, 0, origin) > 2000);
    }
    SUBCASE("radii around a power of two") {  // two levels in most queries
        const float r = 1 / (2.125f * 8);
        CHECK(check_cloud(in_box(20000, -one, one), r - 0.04f, 0.04f, origin) > 1000);
    }
    SUBCASE("far from the origin") {
        const glm::vec3 far(1e4f, -1e4f, 1e4f);
        CHECK(check_cloud(in_box(10000, far, far + one), 0.05f, 0, origin) > 1000);
    }
    SUBCASE("far from the origin, radii below the spacing of floats") {
        const glm::vec3 far(8192, -1e4f, 9e3f);
        size_t crowding = 0;
        const std::vector<glm::vec3> positions = in_box(20000, far - 0.01f, far + 0.01f);
        CHECK(check_cloud(positions, 1e-6f, 0, origin, 500, 100, &crowding) > 500);
        CHECK(crowding < 100);  // cells far away keep numbers of their own
        CHECK(check_cloud(positions, 0.001f, 0, origin) > 500);
    }
    SUBCASE("neighbours towards the camera at the end of the radius") {
        // A vertex of a smaller radius lies in smaller cells; x = 42 with r = 2.05 is the middle of a cell of
        // side 4.
        const glm::vec3 camera(1, 0, 0);
        std::vector<glm::vec3> positions;
        for (const glm::vec3& p : in_box(4000, {20, 0, 0}, {80, 0, 0}))
            for (const float side : {0.0f, -0.999f, 0.999f})
                positions.push_back(p + side * 0.05f * (p - camera));
        CHECK(check_cloud(positions, 0, 0.05f, camera, 4000) > 10000);
    }
    SUBCASE("radii of 1e-6 and of 1000") {
        CHECK(check_cloud(in_box(20000, origin, one * 2e-5f), 1e-6f, 0, origin) > 500);
        CHECK(check_cloud(in_box(20000, one * -8000.0f, one * 8000.0f), 1000, 0, origin) > 500);
    }
    SUBCASE("all in one point") {
        CHECK(check_cloud(std::vector<glm::vec3>(3000, glm::vec3(0.3f)), 0.1f, 0, origin, 20) >= 30000);
    }
    SUBCASE("one vertex") { CHECK(check_cloud({glm::vec3(0.3f)}, 0.1f, 0, origin, 20) >= 10); }
}

TEST_CASE("vertex grid: a vertex that does not merge is stored and not found") {
    Points points = with_radii(in_box(5000, glm::vec3(-1), glm::vec3(1)), 0.1f, 0, glm::vec3(0));
    for (size_t i = 0; i < points.size(); i += 3) points[i].flags = i % 2 ? 0x40000000u : 0u;
    VertexMapProbe probe(test_device(), 5000);
    CHECK(check_neighbours(probe, points, Points(points.begin(), points.begin() + 500), 256) > 500);
    std::vector<LightVertex> vertices = probe.vertices();
    std::sort(vertices.begin(), vertices.end(), [](auto& a, auto& b) {
        return (a.previous & no_light_vertex) < (b.previous & no_light_vertex);
    });
    size_t wrong = 0;
    for (uint32_t i = 0; i < points.size(); ++i) {
        const LightVertex& v = vertices[i];
        wrong += v.position != points[i].position || v.vcm != points[i].radius || v.vc != 4 ||
                 v.normal != 5 || v.throughput != glm::vec3(1, 2, 3) ||
                 v.direction != glm::vec2(0.5f, 0.25f) || v.instance != points[i].key ||
                 v.uv != glm::vec2(6, 7) || v.primitive != 8 || v.previous != (i | points[i].flags);
    }
    CHECK(wrong == 0);
}

TEST_CASE("vertex grid: the order of neighbours depends on their keys alone") {
    std::vector<glm::vec3> positions = in_box(20000, glm::vec3(-1), glm::vec3(1));
    std::fill(positions.begin(), positions.begin() + 10000, glm::vec3(0.1f, 0.2f, 0.3f));     // one bucket
    std::fill(positions.begin() + 10000, positions.begin() + 10600, glm::vec3(0.9f, 0, 0));   // large, too
    std::fill(positions.begin() + 10600, positions.begin() + 11100, glm::vec3(0, -0.9f, 0));  // just not
    Points points = with_radii(positions, 0.02f, 0.02f, glm::vec3(0));
    VertexMapProbe probe(test_device(), 20000);

    const auto ordered = [&](uint32_t groups, uint32_t expected) {
        probe.store(points, groups, expected);
        const std::vector<LightVertex> vertices = probe.vertices();
        std::vector<std::pair<uint32_t, std::array<float, 3>>> result;
        for (const glm::vec4& entry : probe.entries())
            result.push_back(
                {vertices[std::bit_cast<uint32_t>(entry.w)].instance, {entry.x, entry.y, entry.z}});
        return result;
    };
    const auto expected = ordered(1, 20000);
    CHECK(ordered(37, 100) == expected);
    std::reverse(points.begin(), points.end());
    CHECK(ordered(200, 20000) == expected);

    // Within a bucket keys ascend.
    std::vector<uint32_t> of_point;
    for (const auto& [key, position] : expected)
        if (position == std::array{0.1f, 0.2f, 0.3f}) of_point.push_back(key);
    CHECK(of_point.size() == 10000);
    CHECK(std::is_sorted(of_point.begin(), of_point.end()));
}

TEST_CASE("vertex grid: what does not fit is counted and not stored") {
    const Points points = with_radii(in_box(1000, glm::vec3(-1), glm::vec3(1)), 0.1f, 0, glm::vec3(0));
    VertexMapProbe probe(test_device(), 1000);
    const auto buffer = [&](const char* name) -> Buffer& {
        return const_cast<Buffer&>(*probe.map.buffers().at(name));
    };
    const uint32_t capacity = 10, untouched = 0xABCDABCD;  // less than there is, to see what lies behind
    buffer("LightVertexCounts").write(&capacity, 4);
    for (const char* name : {"LightVertices", "GridPlaces", "GridEntries"}) buffer(name).fill(untouched);
    probe.store(points, 4, 1000);
    CHECK(probe.map.counts().wanted == 1000);
    CHECK(buffer("BucketStarts").read_array<uint32_t>(1025)[1024] == capacity);
    for (const auto& [name, words] :
         {std::pair("LightVertices", 16), {"GridPlaces", 3}, {"GridEntries", 4}}) {
        const auto all = buffer(name).read_array<uint32_t>(1000 * words);
        const auto end = all.begin() + capacity * words;
        CHECK(std::count(all.begin(), end, untouched) == 0);
        CHECK(std::count(end, all.end(), untouched) == all.end() - end);
    }

    // Emptied, it holds nothing of the pass before.
    size_t found = 0;
    for (const auto& keys : probe.neighbours(points)) found += keys.size();
    CHECK(found >= 10);
    probe.store({}, 1, 0);
    CHECK(probe.map.counts().wanted == 0);
    for (const auto& keys : probe.neighbours(points)) CHECK(keys.empty());
}

TEST_CASE("octahedral: directions come back within the stated angles") {
    std::mt19937 random(3);
    std::normal_distribution<float> normal;
    std::vector<glm::vec4> directions;
    const auto add = [&](const glm::dvec3& d) { directions.emplace_back(glm::vec3(glm::normalize(d)), 0); };
    for (int i = 0; i < 200000; ++i) add({normal(random), normal(random), normal(random)});
    for (int i = 0; i < 27; ++i)  // poles, folds, and beside them
        if (i != 13)
            for (const double e : {0.0, 1e-8, -1e-8, 1e-7, 1e-5, -1e-3})
                for (int k = 0; k < 3; ++k) {
                    glm::dvec3 d(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
                    d[k] += e;
                    add(d);
                }
    const Buffer in = create_buffer(test_device(), directions, "directions");
    const Buffer out(test_device(), directions.size() * 32, "decoded");
    const Kernel kernel = make_test_kernel("octahedral", R"(
        layout(local_size_x = 64) in;
        layout(push_constant) uniform Push { uint count; };
        #include "lib/octahedral.glsl"
        struct Decoded { vec3 from_floats; vec3 from_16_bits; vec2 encoded; };
        layout(scalar, set = 0) readonly buffer Directions { vec4 directions[]; };
        layout(scalar, set = 0) writeonly buffer Results { Decoded results[]; };
        void main() {
            uint i = gl_GlobalInvocationID.x;
            if (i >= count) return;
            vec3 d = directions[i].xyz;
            vec2 encoded = encode_octahedral(d);
            vec3 from_16_bits = decode_octahedral_16(encode_octahedral_16(d));
            results[i] = Decoded(decode_octahedral(encoded), from_16_bits, encoded);
        }
    )",
                                           {{"Directions", &in}, {"Results", &out}});
    CommandList commands(test_device());
    const auto count = uint32_t(directions.size());
    commands.dispatch(kernel, (count + 63) / 64, {{"count", count}});
    commands.run();
    struct Decoded {
        glm::vec3 from_floats, from_16_bits;
        glm::vec2 encoded;
    };
    const auto results = out.read_array<Decoded>(count);
    const auto angle = [](const glm::dvec3& a, const glm::dvec3& b) {
        return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
    };
    double worst = 0, worst_16 = 0, length_error = 0, outside = 0;
    for (uint32_t i = 0; i < count; ++i) {
        const glm::dvec3 d(directions[i].x, directions[i].y, directions[i].z);
        worst = std::max(worst, angle(d, results[i].from_floats));
        worst_16 = std::max(worst_16, angle(d, results[i].from_16_bits));
        length_error = std::max(length_error, std::abs(glm::length(glm::dvec3(results[i].from_floats)) - 1));
        outside =
            std::max({outside, std::abs(results[i].encoded.x) - 1.0, std::abs(results[i].encoded.y) - 1.0});
        const bool axis = std::abs(d.x) + std::abs(d.y) + std::abs(d.z) == 1;
        if (axis) CHECK(glm::dvec3(results[i].from_16_bits) == d);
    }
    MESSAGE("largest errors: ", worst, " and ", worst_16, " rad");
    CHECK(worst < 1e-6);
    CHECK(worst_16 < 6.6e-5);
    CHECK(length_error < 2e-7);
    CHECK(outside <= 1e-7);
}
