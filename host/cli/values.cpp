#include "host/cli/values.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace etendue {

uint64_t parse_count(const std::string& text, const char* option, uint64_t least, uint64_t most) {
    uint64_t value = 0;
    auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (failure != std::errc() || end != text.data() + text.size() || value < least || value > most)
        fail_input("{} {}: must be a whole number from {} to {}", option, text, least, most);
    return value;
}

double parse_moment(const std::string& text) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !(value >= 0 && value <= 1e9))
        fail_input("--at {}: must be a number from 0 to 1e9, in seconds", text);
    return value;
}

double parse_positive(const std::string& text, const char* option, const char* unit) {
    double value = 0;
    auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (failure != std::errc() || end != text.data() + text.size() || !(value > 0) || !std::isfinite(value))
        fail_input("{} {}: must be a number above 0{}", option, text, unit);
    return value;
}

PassCount parse_passes(const std::string& text) {
    constexpr uint64_t most = uint64_t(1) << 31;
    const size_t colon = text.find(':');
    if (colon == std::string::npos) return {0, parse_count(text, "--passes", 1, most), false};
    const uint64_t first = parse_count(text.substr(0, colon), "--passes, first", 0, most - 1),
                   end = parse_count(text.substr(colon + 1), "--passes, end", 1, most);
    if (first >= end) fail_input("--passes {}: A:B are passes A to B - 1, so B must be above A", text);
    return {first, end - first, true};
}

ImageSize parse_size(const std::string& text) {
    size_t cross = text.find_first_of("xX");
    if (cross == std::string::npos)
        fail_input("--size {}: must be WIDTHxHEIGHT in pixels, as in 640x480", text);
    return {uint32_t(parse_count(text.substr(0, cross), "--size, width", 1, 65536)),
            uint32_t(parse_count(text.substr(cross + 1), "--size, height", 1, 65536))};
}

uint64_t parse_mebibytes(const std::string& text, const char* option) {
    return parse_count(text, option, 1, 1 << 20) << 20;
}

Algorithm parse_algorithm(const std::string& text, const char* option) {
    return parse_choice<Algorithm>(text, option,
                                   {{"auto", Algorithm::automatic},
                                    {"backward", Algorithm::backward},
                                    {"forward", Algorithm::forward},
                                    {"bidirectional", Algorithm::bidirectional}});
}

std::vector<Algorithm> parse_algorithms(const std::string& text, const char* option) {
    std::vector<Algorithm> algorithms;
    for (size_t begin = 0, end = 0; end != std::string::npos; begin = end + 1) {
        end = text.find(',', begin);
        const std::string name = text.substr(begin, end - begin);
        algorithms.push_back(parse_algorithm(name, option));
        if (std::count(algorithms.begin(), algorithms.end(), algorithms.back()) > 1)
            fail_input("{}: {} is named twice", option, name);
    }
    return algorithms;
}

ColorMode parse_color(const std::string& text) {
    return parse_choice<ColorMode>(
        text, "--color",
        {{"auto", ColorMode::automatic}, {"rgb", ColorMode::rgb}, {"spectral", ColorMode::spectral}});
}

PolarizationMode parse_polarization(const std::string& text) {
    return parse_choice<PolarizationMode>(text, "--polarization",
                                          {{"auto", PolarizationMode::automatic},
                                           {"on", PolarizationMode::on},
                                           {"off", PolarizationMode::off}});
}

SampleSequence parse_sampler(const std::string& text) {
    return parse_choice<SampleSequence>(
        text, "--sampler", {{"sobol", SampleSequence::sobol}, {"independent", SampleSequence::independent}});
}

Schedule parse_schedule(const std::string& text) {
    return parse_choice<Schedule>(text, "--schedule",
                                  {{"auto", Schedule::automatic},
                                   {"fused", Schedule::fused},
                                   {"wavefront", Schedule::wavefront},
                                   {"by-class", Schedule::by_class}});
}

double parse_forward_paths(const std::string& text, Algorithm algorithm) {
    const double paths = parse_positive(text, "--forward-paths", "");
    if (algorithm == Algorithm::automatic || algorithm == Algorithm::backward)
        fail_input("--forward-paths: goes with --algorithm forward or bidirectional, not with {}",
                   algorithm_name(algorithm));
    return paths;
}

double parse_exposure(const std::string& text) {
    const double sign = text.starts_with("-") ? -1 : 1;
    const std::string size = text.substr(text.starts_with("-") || text.starts_with("+"));
    double value = 0;
    const auto [end, error] = std::from_chars(size.data(), size.data() + size.size(), value);
    if (size.empty() || error != std::errc() || end != size.data() + size.size() || !(value <= 32) ||
        value < 0)
        fail_input("--exposure {}: allowed: a number from -32 to 32", text);
    return sign * value;
}

}  // namespace etendue
