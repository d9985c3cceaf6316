#include "host/lights/emission_map.h"

#include <algorithm>
#include <cmath>

namespace etendue {
namespace {

constexpr uint32_t none = 0xFFFFFFFFu;
constexpr double texels_a_cell = 3;  // along its longest edge: measure_emission takes four rows of points
constexpr uint64_t most_cells = 1 << 19;  // of all lights, before any is looked at more closely
constexpr uint32_t most_refined = 250000;
constexpr double tolerance = 0.0004;     // relative variance
constexpr double even_variance = 0.002;  // relative; a cell whose parts differ by no more is even
constexpr int most_levels = 21;

using Measure = std::function<std::vector<EmissionSample>(const std::vector<EmissionCell>&)>;

struct Cell {
    EmissionCell place;
    double area;            // times the light's weight
    double mean = 0;        // of what EmissionSample says,
    double value = 0;       //   and what it is sampled in proportion to, per area
    double error = 0;       // what it adds to the variance of sampling, times the integral
    uint32_t parts = none;  // the first of four, one behind the other
};

class Builder {
  public:
    explicit Builder(const Measure& measure) : measure_(measure) {}

    // All cells of a light down to a level; measure_from() must follow. Returns the whole.
    uint32_t add(const EmissionRequest& request, int levels) {
        const uint32_t root = uint32_t(cells_.size());
        cells_.push_back({{request.primitive, request.texels < 0 ? 0.0f : 1.0f, {}}, request.weight});
        for (uint32_t begin = root, end = root + 1; levels > 0; --levels) {
            for (uint32_t i = begin; i < end; ++i) split(i);
            begin = end, end = uint32_t(cells_.size());
        }
        return root;
    }

    void measure_from(uint32_t first) {
        std::vector<EmissionCell> asked;
        for (uint32_t i = first; i < cells_.size(); ++i)
            if (cells_[i].parts == none) asked.push_back(cells_[i].place);
        const std::vector<EmissionSample> found = measure_(asked);
        auto sample = found.begin();
        for (uint32_t i = first; i < cells_.size(); ++i) {
            Cell& c = cells_[i];
            if (c.parts != none) continue;
            c.mean = sample->mean;
            c.value = std::max(c.mean, 0.5 * double(sample->greatest));
            if (c.value > 0) c.error = c.area * (sample->mean_square / c.value + c.value - 2 * c.mean);
            ++sample;
        }
    }

    void refine() {
        for (uint32_t left = most_refined; left >= 4;) {
            double sum = 0, error = 0;
            std::vector<std::pair<double, uint32_t>> worst;
            for (uint32_t i = 0; i < cells_.size(); ++i) {
                const Cell& c = cells_[i];
                if (c.parts != none) continue;
                sum += c.area * c.mean, error += c.error;
                if (c.error > 0 && std::abs(c.place.size) > std::exp2(-most_levels))
                    worst.push_back({c.error, i});
            }
            if (worst.empty() || error <= tolerance * sum) return;
            std::sort(worst.begin(), worst.end(), std::greater());
            const uint32_t first = uint32_t(cells_.size());
            double gone = 0;
            for (const auto& [e, i] : worst) {
                if (gone > 0.9 * error || left < 4) break;
                split(i), gone += e, left -= 4;
            }
            measure_from(first);
        }
    }

    // Sums up the parts of a cell, and forgets them where they are alike.
    void close(uint32_t index) {
        Cell& c = cells_[index];
        if (c.parts == none) return;
        double square = 0;
        bool even = true;
        c.mean = c.value = 0;
        for (uint32_t i = c.parts; i < c.parts + 4; ++i) {
            close(i);
            c.mean += cells_[i].mean / 4, c.value += cells_[i].value / 4;
            square += cells_[i].value * cells_[i].value / 4;
            even = even && cells_[i].parts == none;
        }
        if (even && square - c.value * c.value <= even_variance * c.value * c.value) c.parts = none;
    }

    uint32_t write(uint32_t index, std::vector<EmissionNode>& nodes) const {
        const Cell& c = cells_[index];
        if (c.parts == none) return none;
        const uint32_t place = uint32_t(nodes.size());
        nodes.emplace_back();
        for (int k = 0; k < 4; ++k) {
            const uint32_t node = write(c.parts + k, nodes);
            nodes[place].parts[k] = node;
            nodes[place].shares[k] = float(cells_[c.parts + k].value / (4 * c.value));
        }
        return place;
    }

    double mean(uint32_t index) const { return cells_[index].mean; }

    void find_lit(uint32_t index, EmissionMaps::Lit& lit) const {
        const Cell& c = cells_[index];
        if (!(c.value > 0)) return;
        if (c.parts != none) {
            for (uint32_t i = c.parts; i < c.parts + 4; ++i) find_lit(i, lit);
            return;
        }
        const glm::vec2 end = c.place.corner + c.place.size;
        lit.lo = glm::min(lit.lo, glm::min(c.place.corner, end));
        lit.hi = glm::max(lit.hi, glm::max(c.place.corner, end));
    }

  private:
    void split(uint32_t index) {
        const Cell c = cells_[index];
        const float half = 0.5f * c.place.size;
        cells_[index].parts = uint32_t(cells_.size()), cells_[index].error = 0;
        for (int k = 0; k < 4; ++k) {
            EmissionCell place = c.place;
            place.size = k == 3 ? -half : half;
            place.corner += half * glm::vec2(k == 1 || k == 3, k >= 2);
            cells_.push_back({place, c.area / 4});
        }
    }

    const Measure& measure_;
    std::vector<Cell> cells_;
};

}  // namespace

EmissionMaps build_emission_maps(std::span<const EmissionRequest> requests, const Measure& measure) {
    std::vector<int> levels;
    for (const EmissionRequest& r : requests)
        levels.push_back(
            int(std::clamp(std::ceil(std::log2(std::max(r.texels, 1.0) / texels_a_cell)), 0.0, 16.0)));
    const auto cells = [&] {
        uint64_t sum = 0;
        for (int level : levels) sum += uint64_t(1) << 2 * level;
        return sum;
    };
    while (cells() > std::max<uint64_t>(most_cells, requests.size()))
        for (int& level : levels) level = std::max(level - 1, 0);

    Builder builder(measure);
    std::vector<uint32_t> wholes;
    for (size_t i = 0; i < requests.size(); ++i) wholes.push_back(builder.add(requests[i], levels[i]));
    builder.measure_from(0);
    builder.refine();
    EmissionMaps maps;
    for (uint32_t whole : wholes) {
        builder.close(whole);
        maps.roots.push_back({builder.write(whole, maps.nodes), float(builder.mean(whole))});
        maps.lit.push_back({glm::vec2(1), glm::vec2(0)});
        builder.find_lit(whole, maps.lit.back());
    }
    return maps;
}

}  // namespace etendue
