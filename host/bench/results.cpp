#include "host/bench/results.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "host/error.h"
#include "host/image/atomic_file.h"
#include "host/image/compare.h"

namespace etendue {
namespace {

constexpr const char* header =
    "scene,algorithm,seed,passes,seconds,rays_backward,rays_shadow,rays_forward,relmse,relmse_measured,bias";

std::string read_text(const std::filesystem::path& path) {
    const auto bytes = read_whole_file(path);
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::vector<std::string> split(const std::string& text, char separator) {
    std::vector<std::string> parts;
    size_t begin = 0;
    for (size_t end; (end = text.find(separator, begin)) != std::string::npos; begin = end + 1)
        parts.push_back(text.substr(begin, end - begin));
    parts.push_back(text.substr(begin));
    return parts;
}

// The fields of a row in turn; anything but a number where one belongs makes the row unreadable.
struct Row {
    std::vector<std::string> fields;
    size_t next = 0;
    bool readable = true;

    std::string word() { return next < fields.size() ? fields[next++] : (readable = false, std::string()); }
    template <class Number>
    void number(Number& value) {
        const std::string text = word();
        const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
        readable = readable && failure == std::errc() && end == text.data() + text.size();
    }
};

BenchPoint parse_point(const std::string& line, const std::filesystem::path& path, size_t line_number) {
    Row row{split(line, ',')};
    BenchPoint p;
    p.scene = row.word(), p.algorithm = row.word();
    row.number(p.seed), row.number(p.passes), row.number(p.seconds);
    row.number(p.rays_backward), row.number(p.rays_shadow), row.number(p.rays_forward);
    row.number(p.relmse), row.number(p.relmse_measured), row.number(p.bias);
    if (!row.readable || row.next != row.fields.size())
        fail_input("{}: line {} is not a point of a bench; its columns are {}", path.string(), line_number,
                   header);
    return p;
}

}  // namespace

double rays(const BenchPoint& p) { return double(p.rays_backward + p.rays_shadow + p.rays_forward); }

Reference average_reference(const Image& a, const Image& b) {
    Reference reference;
    reference.image = a;
    for (size_t i = 0; i < a.values.size(); ++i)
        reference.image.values[i] = float(0.5 * (double(a.values[i]) + double(b.values[i])));
    remove_channels(reference.image, "error.");
    reference.relmse = compare_images(a, reference.image).relmse;
    return reference;
}

void compare_with_reference(const Image& image, const Reference& reference, BenchPoint& point) {
    const Comparison comparison = compare_images(image, reference.image, "the image", "the reference", 0);
    point.relmse_measured = comparison.relmse;
    point.relmse = comparison.relmse - reference.relmse;
    point.bias = comparison.bias;
}

void write_results(const std::filesystem::path& folder, const BenchResults& results) {
    std::string csv = std::string(header) + "\n";
    for (const BenchPoint& p : results.points)
        csv += fmt::format("{},{},{},{},{:.6g},{},{},{},{:.6g},{:.6g},{:.6g}\n", p.scene, p.algorithm, p.seed,
                           p.passes, p.seconds, p.rays_backward, p.rays_shadow, p.rays_forward, p.relmse,
                           p.relmse_measured, p.bias);
    nlohmann::json scenes = nlohmann::json::array();
    for (const BenchScene& s : results.scenes)
        scenes.push_back({{"name", s.name},
                          {"file", s.file},
                          {"device", s.device},
                          {"reference", s.reference},
                          {"reference_relmse", s.reference_relmse},
                          {"width", s.width},
                          {"height", s.height},
                          {"notes", s.notes}});
    write_atomically(folder / "bench.json", nlohmann::json{{"scenes", scenes}}.dump(2) + "\n");
    write_atomically(folder / "bench.csv", csv);
}

BenchResults read_results(const std::filesystem::path& folder) {
    const auto csv = folder / "bench.csv", json = folder / "bench.json";
    BenchResults results;
    const std::vector<std::string> lines = split(read_text(csv), '\n');
    if (lines.front() != header)
        fail_input("{}: not the points of a bench; its first line is {}", csv.string(), header);
    for (size_t i = 1; i < lines.size(); ++i)
        if (!lines[i].empty()) results.points.push_back(parse_point(lines[i], csv, i + 1));
    try {
        const auto document = nlohmann::json::parse(read_text(json));
        for (const auto& s : document.at("scenes"))
            results.scenes.push_back({s.at("name"), s.at("file"), s.at("device"), s.at("reference"),
                                      s.at("width"), s.at("height"), s.at("reference_relmse"),
                                      s.at("notes").get<std::vector<std::string>>()});
    } catch (const nlohmann::json::exception& e) {
        fail_input("{}: not the scenes of a bench: {}", json.string(), e.what());
    }
    return results;
}

std::vector<BenchCurve> curves(const BenchResults& results, const BenchScene& scene) {
    std::vector<BenchCurve> all;
    std::vector<std::map<uint64_t, std::vector<const BenchPoint*>>> points;  // by passes
    for (const BenchPoint& p : results.points) {
        if (p.scene != scene.name) continue;
        const auto found =
            std::find_if(all.begin(), all.end(), [&](auto& curve) { return curve.algorithm == p.algorithm; });
        const size_t at = size_t(found - all.begin());
        if (found == all.end()) all.emplace_back().algorithm = p.algorithm, points.emplace_back();
        points[at][p.passes].push_back(&p);
    }
    for (size_t i = 0; i < all.size(); ++i) {
        BenchCurve& curve = all[i];
        std::vector<double> passes, seconds, errors, biases, weights;
        double all_rays = 0, all_seconds = 0;
        for (const auto& [count, renders] : points[i]) {
            BenchLevel level;
            level.passes = double(count);
            for (const BenchPoint* p : renders) {
                level.seconds += p->seconds / double(renders.size());
                level.rays += rays(*p) / double(renders.size());
                level.relmse += p->relmse / double(renders.size());
                all_rays += rays(*p), all_seconds += p->seconds;
                biases.push_back(p->bias), weights.push_back(double(count));
            }
            if (!(level.relmse > 0) || level.relmse < scene.reference_relmse) {
                ++curve.left_out;
                continue;
            }
            curve.levels.push_back(level);
            for (const BenchPoint* p : renders) {
                if (!(p->relmse > 0)) continue;
                passes.push_back(std::log10(level.passes));
                seconds.push_back(std::log10(std::max(p->seconds, 1e-9)));
                errors.push_back(std::log10(p->relmse));
            }
        }
        curve.by_passes = fit_line(passes, errors);
        curve.by_seconds = fit_line(seconds, errors);
        curve.bias = weighted_mean(biases, weights);
        curve.rays_per_second = all_seconds > 0 ? all_rays / all_seconds : 0;
    }
    return all;
}

}  // namespace etendue
