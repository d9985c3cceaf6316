// Elements of class lens_system: their rays against tracing surface by surface in double precision, a
// camera's film behind one.
#include <numeric>

#include "host/lens/trace.h"
#include "host/render/path_record.h"
#include "tests/renders/algorithm_comparison.h"
#include "tests/support/random.h"
#include "tests/support/source_path.h"
#include "tests/support/temporary_folder.h"

using namespace etendue;
using nlohmann::json;

namespace {

const char* const double_gauss = "tests/host/lenses/own_dgauss_tronnier.txt";
// Of the plane, in mm: where the film is sharp for an object 2 m away, and a disk that holds the last
// surface.
constexpr double film_distance = 77.4251, disk_radius = 20.5;

// Rays of a beam through a lens, which is turned and moved, meet its surfaces where the tracer says, and end
// where its apertures stop them.
void check_rays(const std::filesystem::path& file, double beam_radius, double tilt) {
    CAPTURE(file);
    const Prescription p = read_prescription(file);
    const std::vector<FrameChange> frames = lens_frames(p);
    SceneBuilder s;
    const int lens = s.scene([&] {
        s.placed("element", {{"class", "lens_system"}, {"file", file.string()}}, at(0, 0, 0));
        s.placed("light", {{"class", "collimated"}, {"radius", beam_radius}},
                 {{-0.05 * std::sin(2 * tilt), 0, -0.05 * std::cos(2 * tilt)},
                  {0, std::cos(tilt), 0, std::sin(tilt)}});
    });
    s.placed("element", {{"class", "subscene"}, {"scene", lens}},
             {{0.3, -0.2, 0.1}, {0.2, 0.3, -0.1, 0.9273618495495703}});
    s.perspective(0.8, at(0, 0, 3));
    const SceneDescription description = s.import();
    Scene scene = compile_test_scene(description);
    RenderSettings settings;
    settings.width = 32, settings.height = 16, settings.receiver = scene.receivers.at(0).ref;
    PathRecorder recorder(test_device(), scene, settings, true, 256, true);
    std::vector<uint32_t> all(recorder.paths_a_pass());
    std::iota(all.begin(), all.end(), 0u);
    const glm::dmat4 to_lens = glm::inverse(description.elements.at(0).parent_from_local);

    double worst = 0;
    int arrived = 0, stopped = 0, differing = 0;
    for (const RecordedPath& path : recorder.record(0, all)) {
        std::vector<glm::dvec3> met;
        glm::dvec3 start(0);
        bool is_stopped = false;
        double nm = 587.6;
        for (const PathVertex& v : path.vertices) {
            const glm::dvec3 place = glm::dvec3(to_lens * glm::dvec4(v.position, 1)) * 1000.0;
            if (v.event == PathEvent::emitted) start = place;
            is_stopped |= v.event == PathEvent::absorbed;
            if (const double left = wavelength_at(path, v); left > 0) nm = left;
            if (v.event == PathEvent::reflected || v.event == PathEvent::refracted) met.push_back(place);
        }
        if (met.empty()) continue;
        const glm::dvec3 direction = glm::normalize(met[0] - start);
        const TracedRay expected =
            LensTracer(p, nm).trace({start - direction * (start.z / direction.z), direction});
        size_t next = 0;
        const size_t end = expected.stopped.value_or(expected.points.size());
        bool same = is_stopped != expected.passes();
        for (size_t i = 0; i + 1 < end && same; ++i) {
            const bool is_there = p.surfaces[i].is_mirror || p.surfaces[i].glass != p.glass_before(i);
            if (!is_there || p.surfaces[i].frame_change) continue;
            same = next < met.size();
            if (!same) break;
            const glm::dvec3 place = frames[i].shift + frames[i].turn * expected.points[i].position;
            worst = std::max(worst, glm::distance(place, met[next++]));
        }
        ++(expected.passes() ? arrived : stopped);
        differing += !same;
    }
    MESSAGE(arrived, " arrive, ", stopped, " are stopped; worst distance ", worst, " mm, ", differing,
            " end elsewhere");
    CHECK(arrived > 50);
    CHECK(worst < 1e-4);
    CHECK(differing <= 1);  // at a rim
    if (tilt > 0.1) CHECK(stopped > 30);
}

// A double Gauss with its film behind it, in the scene, whose x and y run as those of the lens.
SceneBuilder camera(const json& resolution) {
    SceneBuilder s;
    double length = 0;
    for (const LensSurface& surface : read_prescription(source_path(double_gauss)).surfaces)
        length += surface.thickness;
    length += film_distance - 72.2118;
    s.placed("element", {{"class", "lens_system"}, {"file", source_path(double_gauss)}}, at(0, 0, 0));
    s.placed("receiver",
             {{"class", "illuminance"},
              {"size", {0.036, 0.024}},
              {"resolution", resolution},
              {"pupil", {film_distance / 1000, disk_radius / 1000}}},
             {{0, 0, length / 1000}, {1, 0, 0, 0}});
    return s;
}

// The lens from behind: rays from the film.
Prescription reversed(const Prescription& p) {
    Prescription r = p;
    const size_t n = p.surfaces.size() - 1;
    for (size_t i = 0; i < n; ++i) {
        r.surfaces[i] = p.surfaces[n - 1 - i];
        r.surfaces[i].shape.curvature *= -1;
        r.surfaces[i].glass = p.glass_before(n - 1 - i);
        r.surfaces[i].thickness = i + 1 < n ? p.surfaces[n - 2 - i].thickness : 1;
    }
    return r;
}

}  // namespace

TEST_CASE(
    "rays through lenses in elements meet the surfaces where tracing says, and are stopped where it does") {
    const TemporaryFolder folder;
    write_text(folder / "doublet.txt",
               "wavelengths 587.5618\n"
               "61.5 10 N-BK7 40 -0.6 1e-7 -2e-10\n-44.6 2.5 N-SF5 40\n-129.9 3 air 40\n0 90 air 30 stop\n");
    write_text(folder / "folded.seq",  // a lens, a mirror at 45 degrees, a window
               "RDM;EPD 20;SO 0 1e11\nS 80 6 NBK7_SCHOTT\nS -80 25\nS 0 -10 REFL\nADE 45; BEN\n"
               "S 0 -4 NBK7_SCHOTT\nS 0 -20\nSI 0 0\n");
    check_rays(source_path(double_gauss), 0.03, 0);
    check_rays(source_path(double_gauss), 0.03, 0.12);
    check_rays(folder / "doublet.txt", 0.018, 0.02);
    check_rays(folder / "folded.seq", 0.0095, 0);
}

TEST_CASE(
    "the film behind a double Gauss gets from an even sky what its clear pupil lets through, pixel by "
    "pixel") {
    SceneBuilder s = camera({4, 2});
    s.environment(1);
    RenderPlan plan;
    plan.width = 4, plan.height = 2, plan.passes = 4096, plan.seeds = 8;
    const Estimates e = render_estimates(s.import(), plan);
    const Prescription back = reversed(read_prescription(source_path(double_gauss)));
    const LensTracer tracer(back, 587.6);
    Random random(5);
    for (uint32_t x = 0; x < 2; ++x) {  // the other half is the same
        constexpr int rays = 100000;
        double sum = 0;
        for (int i = 0; i < rays; ++i) {
            const glm::dvec3 point(36 * ((x + random(0, 1)) / 4 - 0.5), 24 * (random(0, 1) / 2 - 0.5),
                                   -film_distance);
            const double r = disk_radius * std::sqrt(random(0, 1)), turn = 2 * M_PI * random(0, 1);
            const glm::dvec3 through(r * std::cos(turn), r * std::sin(turn), 0);
            const glm::dvec3 d = glm::normalize(through - point);
            if (tracer.trace({through, d}).passes()) sum += std::pow(d.z, 4);
        }
        const double expected =
            sum / rays * M_PI * disk_radius * disk_radius / (film_distance * film_distance);
        double mean = 0;
        for (uint32_t y = 0; y < 2; ++y) mean += 0.25 * (e.at(x, y, 1) + e.at(3 - x, y, 1));
        MESSAGE("column ", x, ": ", mean, " lx, expected ", expected);
        CHECK(mean == doctest::Approx(expected).epsilon(0.006));
    }
}

TEST_CASE("the picture of a lamp that a lens throws is the same by all algorithms") {
    SceneBuilder s = camera({6, 4});
    s.shape({{"class", "disk"}, {"radius", 0.012}}, s.black_emitter(100), at(0.004, 0.003, -0.06));
    s.shape({{"class", "rectangle"}, {"size", {0.1, 0.1}}}, s.lambertian({0.6, 0.5, 0.4}), at(0, 0, -0.08));
    Comparison c;
    c.width = 24, c.height = 16, c.backward = 256, c.forward = 512, c.bidirectional = 128;
    c.largest_error = 0.01;
    check_against_backward(s, c);
}

TEST_CASE("without ghosts a lens loses nothing, with them what its surfaces reflect") {
    const auto flux = [](bool ghosts) {
        SceneBuilder s;
        const json plate = {{{"thickness", 0.01}, {"ior", 1.52}, {"semi_diameter", 0.02}},
                            {{"semi_diameter", 0.02}}};
        s.placed("element", {{"class", "lens_system"}, {"surfaces", plate}, {"ghosts", ghosts}}, at(0, 0, 0));
        s.placed("light", {{"class", "collimated"}, {"radius", 0.01}, {"power", 1}},
                 {{0, 0, -0.05}, {0, 1, 0, 0}});
        s.placed("receiver", {{"class", "illuminance"}, {"size", {1, 1}}, {"resolution", {1, 1}}},
                 {{0, 0, 0.05}, {1, 0, 0, 0}});
        RenderPlan plan;
        plan.width = plan.height = 1, plan.algorithm = Algorithm::forward, plan.forward_paths = 20000;
        plan.passes = 1, plan.seeds = 8;
        return window_mean(render_estimates(s.import(), plan));
    };
    CHECK(flux(false).mean == doctest::Approx(1).epsilon(1e-6));
    const auto with = flux(true);
    CHECK(std::abs(with.mean - 0.918318) < 4 * with.standard_error);
}
