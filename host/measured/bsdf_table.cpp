// Tables of our own: JSON, described in scenes/FORMAT.md ("Measured surfaces").
//
// On the device x = sin² theta takes the place of the angles: there light that falls evenly from everywhere
// does so evenly, so that interpolated values of f are sampled exactly with the cosine, and what is constant
// stays so.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "host/error.h"
#include "host/image/atomic_file.h"
#include "host/measured/maps.h"
#include "host/shallow_json.h"

namespace etendue {
namespace {

using nlohmann::json;

constexpr int most_levels = 16;         // of nested arrays; a table has five
constexpr double most_reflected = 1.1;  // of the light: noise and coarse tables may give a little too much

class TableReader {
  public:
    explicit TableReader(const std::filesystem::path& path) : file_(path.string()) {
        const std::vector<std::byte> bytes = read_whole_file(path);
        const auto* text = reinterpret_cast<const char*>(bytes.data());
        const std::optional<json> table = parse_shallow_json({text, bytes.size()}, most_levels);
        if (!table) fail_input("{}: not a table of a measured surface: it is not JSON", file_);
        table_ = *table;
        if (!table_.is_object()) fail_input("{}: /: allowed: an object", file_);
        static const std::vector<std::string> names = {"description", "theta_i",    "theta_r",     "phi",
                                                       "wavelengths", "reflection", "transmission"};
        for (const auto& [name, value] : table_.items())
            if (std::find(names.begin(), names.end(), name) == names.end())
                fail_input(
                    "{}: /{}: unknown; allowed: description, theta_i, theta_r, phi, wavelengths, reflection, "
                    "transmission",
                    file_, json(name).dump(-1, ' ', true, json::error_handler_t::replace));
    }

    MeasuredBsdf read() {
        theta_i_ = list("theta_i", 0, 90), theta_r_ = list("theta_r", 0, 90), phi_ = list("phi", 0, 360);
        if (phi_.front() != 0 || (phi_.back() != 180 && phi_.back() != 360))
            fail_input("{}: /phi: allowed: from 0 to 180, or to 360", file_);
        if (table_.contains("wavelengths")) wavelengths_ = list("wavelengths", 1, 1e6);
        const bool reflects = table_.contains("reflection"), transmits = table_.contains("transmission");
        if (!reflects && !transmits)
            fail_input("{}: /: allowed: at least one of reflection and transmission", file_);
        channels_ = wavelengths_.empty() ? 3 : wavelengths_.size();
        lay_out_grid();

        MeasuredBsdf bsdf;
        std::vector<double> slices;
        for (const double angle : theta_i_) slices.push_back(square_of_sine(angle));
        const double one_azimuth[] = {0};
        bsdf.ref.kind = 1u << measured_symmetry | (transmits ? measured_transmits : 0u);
        bsdf.ref.theta_first = add_numbers(bsdf, slices), bsdf.ref.theta_count = uint32_t(slices.size());
        bsdf.ref.phi_first = add_numbers(bsdf, one_azimuth), bsdf.ref.phi_count = 1;
        bsdf.ref.swept_first = add_numbers(bsdf, columns_), bsdf.ref.turn_first = add_numbers(bsdf, rows_);
        std::vector<float> values;
        add_side("reflection", values);
        if (transmits) add_side("transmission", values);
        std::vector<float> means(values.size() / channels_, 0.0f);
        for (size_t i = 0; i < values.size(); ++i) means[i / channels_] += values[i] / float(channels_);
        bsdf.ref.density = add_map(bsdf, means, columns_, rows_, false);
        check_energy(bsdf, transmits);
        add_channels(bsdf, values, wavelengths_);
        return bsdf;
    }

  private:
    static double square_of_sine(double degrees) {
        const double sine = std::sin(degrees * std::numbers::pi / 180);
        return degrees == 90 ? 1 : sine * sine;
    }

    std::vector<double> list(const std::string& name, double lo, double hi) const {
        const auto found = table_.find(name);
        if (found == table_.end() || !found->is_array() || found->empty() || found->size() > most_map_points)
            fail_input("{}: /{}: allowed: an array of 1 to {} numbers", file_, name, most_map_points);
        std::vector<double> numbers;
        for (const json& v : *found) {
            const double x = v.is_number() ? v.get<double>() : -1;
            if (!(x >= lo && x <= hi) || (!numbers.empty() && !(x > numbers.back())))
                fail_input("{}: /{}/{}: allowed: numbers that rise, in [{}, {}]", file_, name, numbers.size(),
                           lo, hi);
            numbers.push_back(x);
        }
        return numbers;
    }

    // Columns by the angle of the swept direction, out to 0 and 90 degrees; rows once around.
    void lay_out_grid() {
        for (size_t i = 0; i < theta_r_.size(); ++i)
            columns_.push_back(square_of_sine(theta_r_[i])), column_sources_.push_back(i);
        if (columns_.front() > 0)
            columns_.insert(columns_.begin(), 0.0), column_sources_.insert(column_sources_.begin(), 0);
        if (columns_.back() < 1) columns_.push_back(1), column_sources_.push_back(theta_r_.size() - 1);
        for (size_t i = 0; i < phi_.size(); ++i) rows_.push_back(phi_[i] / 360), row_sources_.push_back(i);
        if (phi_.back() == 180)
            for (size_t i = phi_.size() - 1; i-- > 0;)
                rows_.push_back(1 - phi_[i] / 360), row_sources_.push_back(i);
    }

    // A number, [r, g, b], or one number for each wavelength.
    void add_value(const json& value, const std::string& place, std::vector<float>& out) const {
        const auto add = [&](const json& v) {
            const double x = v.is_number() ? v.get<double>() : -1;
            if (!(x >= 0 && x <= 1e9))
                fail_input("{}: {}: {} is no value of a BSDF; allowed: numbers in [0, 1e9], in 1/sr", file_,
                           place, v.dump(-1, ' ', true, json::error_handler_t::replace).substr(0, 40));
            out.push_back(float(x));
        };
        if (value.is_array() && value.size() == channels_)
            for (const json& v : value) add(v);
        else if (!value.is_array() && wavelengths_.empty())
            for (int k = 0; k < 3; ++k) add(value);
        else if (wavelengths_.empty())
            fail_input("{}: {}: allowed: a number or [r, g, b]", file_, place);
        else
            fail_input("{}: {}: allowed: an array of {} numbers, one a wavelength", file_, place, channels_);
    }

    const json& part(const json& array, size_t size, const std::string& place, const char* list_name) const {
        if (!array.is_array() || array.size() != size)
            fail_input("{}: {}: allowed: an array of {}, one for each of {}", file_, place, size, list_name);
        return array;
    }

    // values[theta_i][row][column][channel] of one side; zeros where the table has none.
    void add_side(const std::string& name, std::vector<float>& values) const {
        const size_t grid = rows_.size() * columns_.size() * channels_;
        const auto side = table_.find(name);
        if (side == table_.end()) {
            values.resize(values.size() + theta_i_.size() * grid);
            return;
        }
        part(*side, theta_i_.size(), "/" + name, "theta_i");
        for (size_t i = 0; i < theta_i_.size(); ++i) {
            const std::string place_i = fmt::format("/{}/{}", name, i);
            part((*side)[i], theta_r_.size(), place_i, "theta_r");
            std::vector<float> given;  // [theta_r][phi][channel]
            for (size_t r = 0; r < theta_r_.size(); ++r) {
                const std::string place_r = fmt::format("{}/{}", place_i, r);
                const json& around = part((*side)[i][r], phi_.size(), place_r, "phi");
                for (size_t p = 0; p < phi_.size(); ++p)
                    add_value(around[p], fmt::format("{}/{}", place_r, p), given);
            }
            for (const size_t row : row_sources_)
                for (const size_t column : column_sources_) {
                    const auto at = given.begin() + ptrdiff_t((column * phi_.size() + row) * channels_);
                    values.insert(values.end(), at, at + ptrdiff_t(channels_));
                }
        }
    }

    // The integral of f cos over directions is pi times that over the square.
    void check_energy(const MeasuredBsdf& bsdf, bool transmits) const {
        const MeasuredMap& map = bsdf.ref.density;
        const size_t slice = size_t(map.height) * (map.width + 1);
        for (size_t i = 0; i < theta_i_.size(); ++i) {
            double sum = 0;
            for (size_t side = 0; side < (transmits ? 2 : 1); ++side)
                sum += bsdf.points[map.first + (side * theta_i_.size() + i) * slice + map.height - 1].x;
            if (std::numbers::pi * sum > most_reflected)
                fail_input(
                    "{}: /theta_i/{}: of the light from {} degrees {:.4g} times as much leaves; allowed: at "
                    "most "
                    "all of it, with values of a BSDF in 1/sr",
                    file_, i, theta_i_[i], std::numbers::pi * sum);
        }
    }

    std::string file_;
    json table_;
    std::vector<double> theta_i_, theta_r_, phi_, wavelengths_;
    size_t channels_ = 3;
    std::vector<double> columns_, rows_;                // sin² theta, turns
    std::vector<size_t> column_sources_, row_sources_;  // indices into theta_r and phi
};

}  // namespace

MeasuredBsdf read_bsdf_table(const std::filesystem::path& path) { return TableReader(path).read(); }

}  // namespace etendue
