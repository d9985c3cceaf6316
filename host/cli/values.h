// Values of options from their text. CLI11's own conversions take NaN, hexadecimal and trailing characters
// for numbers. All fail with one line that names the option.
#pragma once
#include "host/options.h"
#include "host/error.h"

namespace etendue {

uint64_t parse_count(const std::string& text, const char* option, uint64_t least, uint64_t most);
// Of --passes: N, the first ones, or A:B, from A to B - 1.
struct PassCount {
    uint64_t first = 0, count = 0;
    bool is_range = false;
};
PassCount parse_passes(const std::string& text);
uint64_t parse_mebibytes(const std::string& text, const char* option);  // the bytes
double parse_moment(const std::string& text);                           // of --at, seconds from 0 on
double parse_positive(const std::string& text, const char* option, const char* unit);
ImageSize parse_size(const std::string& text);  // of --size
Algorithm parse_algorithm(const std::string& text, const char* option);
std::vector<Algorithm> parse_algorithms(const std::string& text, const char* option);  // with commas between
ColorMode parse_color(const std::string& text);                                        // of --color, …
PolarizationMode parse_polarization(const std::string& text);
SampleSequence parse_sampler(const std::string& text);
Schedule parse_schedule(const std::string& text);
// Of --forward-paths, which goes with algorithms that have them.
double parse_forward_paths(const std::string& text, Algorithm algorithm);
double parse_exposure(const std::string& text);

template <class Choice>
Choice parse_choice(const std::string& text, const char* option,
                    std::initializer_list<std::pair<const char*, Choice>> choices) {
    std::string allowed;
    for (const auto& [name, value] : choices) {
        if (text == name) return value;
        allowed += allowed.empty() ? name : std::string(", ") + name;
    }
    fail_input("{} {}: not available; allowed: {}", option, text, allowed);
}

}  // namespace etendue
