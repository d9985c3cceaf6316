#include "host/scene/grating_table.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <set>

#include "host/error.h"
#include "host/scene/scene_files.h"
#include "host/text_lines.h"

namespace etendue {
namespace {

using nlohmann::json;

constexpr size_t most_numbers = 1 << 24;
const char* const members[] = {"order",        "side",      "wavelength", "angle",
                               "polarization", "reflected", "transmitted"};
const char* const sides[] = {"above", "below"};
const char* const kinds[] = {"reflected", "transmitted"};
const char* const polarizations[] = {"s", "p"};

// A row, for one wavelength at most. -1 and NaN: it says nothing of that.
struct Row {
    std::string place;
    int order = 0, side = -1, polarization = -1;
    double wavelength = NAN, angle = NAN;
    double parts[2] = {NAN, NAN};
};

double in_range(const json& value, const std::string& place, double lo, double hi, const char* what) {
    const double number = value.is_number() ? value.get<double>() : NAN;
    if (!(number >= lo && number <= hi)) fail_input("{}: allowed: {}", place, what);
    return number;
}

int one_of(const json& row, const char* name, const char* const (&words)[2], const std::string& place) {
    if (!row.contains(name)) return -1;
    for (int i = 0; i < 2; ++i)
        if (row[name] == words[i]) return i;
    fail_input("{}/{}: is {}; allowed: {}, {}", place, name, row[name].dump(), words[0], words[1]);
}

void add_rows(const json& row, const std::string& place, std::vector<Row>& rows) {
    if (!row.is_object()) fail_input("{}: allowed: an object with {}", place, fmt::join(members, ", "));
    for (const auto& [name, unused] : row.items())
        if (std::ranges::find(members, name) == std::end(members))
            fail_input("{}/{}: unknown; allowed: {}", place, name, fmt::join(members, ", "));
    if (!row.contains("order") || !row["order"].is_number_integer() ||
        std::abs(row["order"].get<double>()) > greatest_grating_order)
        fail_input("{}/order: allowed: a whole number from -{} to {}", place, greatest_grating_order,
                   greatest_grating_order);
    if (!row.contains("reflected") && !row.contains("transmitted"))
        fail_input("{}: has no efficiency; allowed: reflected, transmitted or both", place);
    Row read{place, row["order"], one_of(row, "side", sides, place),
             one_of(row, "polarization", polarizations, place)};
    if (row.contains("angle"))
        read.angle =
            in_range(row["angle"], place + "/angle", -M_PI / 2, M_PI / 2, "numbers from -pi/2 to pi/2");
    const json nm = row.value("wavelength", json());
    const size_t count = nm.is_array() ? nm.size() : 1;
    for (size_t i = 0; i < count; ++i) {
        const auto item = [&](const json& value) -> const json& { return nm.is_array() ? value[i] : value; };
        if (!nm.is_null())
            read.wavelength = in_range(item(nm), place + "/wavelength", 1, 1e6, "numbers from 1 to 1e6 (nm)");
        for (int k = 0; k < 2; ++k) {
            if (!row.contains(kinds[k])) continue;
            const json& part = row[kinds[k]];
            if (nm.is_array() && (!part.is_array() || part.size() != count))
                fail_input("{}/{}: allowed: as many numbers as wavelengths, {}", place, kinds[k], count);
            read.parts[k] =
                in_range(item(part), fmt::format("{}/{}", place, kinds[k]), 0, 1, "numbers from 0 to 1");
        }
        rows.push_back(read);
    }
}

void add_file(const std::filesystem::path& file, std::vector<Row>& rows) {
    std::ifstream stream(file, std::ios::binary);
    if (!stream) fail_input("{}: cannot be read", file.string());
    const TextLines text = text_lines(file.string(), std::string(std::istreambuf_iterator<char>(stream), {}));
    std::vector<std::string> names;
    for (size_t line = 0; line < text.lines.size(); ++line) {
        if (text.lines[line].empty() || text.lines[line][0] == '#') continue;
        std::vector<std::string> cells;
        for (size_t at = 0; at <= text.lines[line].size();) {
            const size_t end = std::min(text.lines[line].find(',', at), text.lines[line].size());
            cells.emplace_back(trimmed(std::string_view(text.lines[line]).substr(at, end - at)));
            at = end + 1;
        }
        if (names.empty()) {
            names = cells;
            continue;
        }
        if (cells.size() != names.size())
            text.fail(line, "has {} cells; allowed: {}, as the first line", cells.size(), names.size());
        json row = json::object();
        for (size_t i = 0; i < cells.size(); ++i) {
            double number = 0;
            if (cells[i].empty()) continue;
            if (!parse_number(cells[i], number))
                row[names[i]] = cells[i];
            else if (number == std::round(number) && std::abs(number) < 1e9)
                row[names[i]] = int(number);
            else
                row[names[i]] = number;
        }
        add_rows(row, fmt::format("{}: line {}", file.string(), line + 1), rows);
    }
}

// Numbers while they are filled: NaN where nothing was said.
class Grid {
  public:
    Grid(const std::vector<Row>& rows, const std::string& place) : place_(place) {
        std::set<int> orders{0};
        std::set<double> wavelengths, angles;
        for (const Row& row : rows) {
            orders.insert(row.order);
            if (!std::isnan(row.wavelength)) wavelengths.insert(row.wavelength);
            if (!std::isnan(row.angle)) angles.insert(row.angle);
        }
        orders_.assign(orders.begin(), orders.end());
        wavelengths_.assign(wavelengths.begin(), wavelengths.end());
        angles_.assign(angles.begin(), angles.end());
        if (wavelengths_.empty()) wavelengths_ = {550};
        if (angles_.empty()) angles_ = {0};
        if (orders_.size() > most_grating_orders)
            fail_input("{}: {} orders; allowed: at most {}", place, orders_.size(), most_grating_orders);
        const size_t count = orders_.size() * 4 * block();
        if (count > most_numbers)
            fail_input("{}: {} values; allowed: at most {}", place, count, most_numbers);
        parts_.assign(count, NAN);
        for (const Row& row : rows) fill(row);
        complete();
    }

    GratingEfficiencies result(bool polarizes) const {
        GratingEfficiencies table{
            orders_, {}, uint32_t(wavelengths_.size()), uint32_t(angles_.size()), polarizes};
        for (const double nm : wavelengths_) table.numbers.push_back(float(nm));
        for (const double angle : angles_) table.numbers.push_back(float(std::sin(angle)));
        for (const double part : parts_) table.numbers.push_back(float(part));
        for (size_t order = 0; order < orders_.size(); ++order)
            for (size_t side = 0; side < 2; ++side)
                for (size_t i = 0; i < block(); ++i)
                    table.transmits |= parts_[(order * 4 + side * 2 + 1) * block() + i] > 0;
        return table;
    }

  private:
    size_t block() const { return angles_.size() * wavelengths_.size() * 2; }
    size_t index(size_t order, size_t side, size_t kind, size_t angle, size_t nm, size_t polarization) const {
        return (order * 4 + side * 2 + kind) * block() + (angle * wavelengths_.size() + nm) * 2 +
               polarization;
    }

    void fill(const Row& row) {
        const auto order = size_t(std::ranges::find(orders_, row.order) - orders_.begin());
        for (size_t side = 0; side < 2; ++side)
            for (size_t kind = 0; kind < 2; ++kind)
                for (size_t angle = 0; angle < angles_.size(); ++angle)
                    for (size_t nm = 0; nm < wavelengths_.size(); ++nm)
                        for (size_t polarization = 0; polarization < 2; ++polarization) {
                            const bool is_meant =
                                (row.side < 0 || row.side == int(side)) &&
                                (row.polarization < 0 || row.polarization == int(polarization)) &&
                                (std::isnan(row.angle) || row.angle == angles_[angle]) &&
                                (std::isnan(row.wavelength) || row.wavelength == wavelengths_[nm]);
                            if (!is_meant || std::isnan(row.parts[kind])) continue;
                            double& part = parts_[index(order, side, kind, angle, nm, polarization)];
                            if (!std::isnan(part))
                                fail_input(
                                    "{}: order {}, {} from {} at {:g} nm and {:g} rad, {}, stands there "
                                    "twice",
                                    row.place, row.order, kinds[kind], sides[side], wavelengths_[nm],
                                    angles_[angle], polarizations[polarization]);
                            part = row.parts[kind];
                        }
    }

    // What nothing is said of carries nothing; what something is said of, all must be.
    void complete() {
        for (size_t order = 0; order < orders_.size(); ++order)
            for (size_t k = 0; k < 4; ++k) {
                double* first = &parts_[(order * 4 + k) * block()];
                const auto is_missing = [](double part) { return std::isnan(part); };
                if (std::all_of(first, first + block(), is_missing)) std::fill(first, first + block(), 0.0);
                const auto at = size_t(std::find_if(first, first + block(), is_missing) - first);
                if (at == block()) continue;
                fail_input(
                    "{}: order {}, {} from {}: nothing at {:g} nm and {:g} rad, {}; allowed: values at all "
                    "wavelengths and angles of the table",
                    place_, orders_[order], kinds[k % 2], sides[k / 2],
                    wavelengths_[at / 2 % wavelengths_.size()], angles_[at / 2 / wavelengths_.size()],
                    polarizations[at % 2]);
            }
        for (size_t side = 0; side < 2; ++side)
            for (size_t angle = 0; angle < angles_.size(); ++angle)
                for (size_t nm = 0; nm < wavelengths_.size(); ++nm)
                    for (size_t polarization = 0; polarization < 2; ++polarization) {
                        double sum = 0;
                        for (size_t order = 0; order < orders_.size(); ++order)
                            for (size_t kind = 0; kind < 2; ++kind)
                                sum += parts_[index(order, side, kind, angle, nm, polarization)];
                        if (sum > 1 + 1e-5)
                            fail_input(
                                "{}: orders carry {:.4g} of the light from {} at {:g} nm and {:g} rad, {}, "
                                "together; allowed: at most 1",
                                place_, sum, sides[side], wavelengths_[nm], angles_[angle],
                                polarizations[polarization]);
                    }
    }

    std::string place_;
    std::vector<int> orders_;
    std::vector<double> wavelengths_, angles_, parts_;
};

}  // namespace

GratingEfficiencies read_grating_table(const json& value, const SceneDescription& scene,
                                       const std::string& where) {
    const std::string place = message_place(scene, where);
    std::vector<Row> rows;
    if (value.is_object() && value.size() == 1 && value.contains("file") && value["file"].is_string()) {
        add_file(named_file(scene, value["file"].get<std::string>()), rows);
    } else {
        if (!value.is_array())
            fail_input("{}: allowed: a list of rows, or {{\"file\": name of a CSV file}}", place);
        for (size_t i = 0; i < value.size(); ++i) add_rows(value[i], fmt::format("{}/{}", place, i), rows);
    }
    if (rows.empty()) fail_input("{}: has no rows; allowed: at least one", place);
    const bool polarizes = std::ranges::any_of(rows, [](const Row& row) { return row.polarization >= 0; });
    return Grid(rows, place).result(polarizes);
}

GratingTable append(std::vector<GratingOrder>& orders, std::vector<float>& numbers,
                    const GratingEfficiencies& table) {
    std::vector<GratingOrder> rows;
    for (const int order : table.orders) rows.push_back({float(order), {}, {}, {}});
    const auto first = uint32_t(numbers.size());
    numbers.insert(numbers.end(), table.numbers.begin(), table.numbers.end());
    return {first, table.wavelengths, table.sines, table.polarizes, table.transmits, append(orders, rows)};
}

}  // namespace etendue
