#include "host/scene/grating_orders.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "host/error.h"
#include "host/scene/spectral_value.h"

namespace etendue {
namespace {

using nlohmann::json;

// Parts of the power that orders carry together, at each wavelength and in each channel.
struct Shares {
    SpectralTable spectrum;
    glm::dvec3 rgb{0};

    void add(const SpectralValue& value) {
        const SpectralTable table = value.as_table(SpectralKind::factor);
        for (size_t i = 0; i < table.values.size(); ++i) spectrum.values[i] += table.values[i];
        rgb += glm::dvec3(value.rgb);
    }
    // Colours stand for smooth spectra, whose sums are near to those of the colours.
    double greatest() const { return std::max({spectrum.greatest() - 0.02, rgb.x, rgb.y, rgb.z}); }
};

SpectralValue share(const json& order, const char* name, const SceneDescription& scene,
                    const std::string& where) {
    const std::string at = where + "/" + name;
    const SpectralValue value = spectral_value(order[name], scene, at, SpectralKind::factor);
    for (const float x : {value.least(), value.greatest()})
        if (!(x >= 0 && x <= 1))
            fail_input("{}: {} is out of range; allowed: numbers, colours or spectra in [0, 1]",
                       message_place(scene, at), x);
    return value;
}

}  // namespace

std::vector<GratingOrder> read_grating_orders(
    const json& value, const SceneDescription& scene, const std::string& where,
    const std::function<uint32_t(const SpectralValue& value, SpectralKind kind)>& spectrum) {
    const std::string form =
        "a list of {\"order\", \"reflected\", \"reflected_below\", \"transmitted\"}, at least one";
    if (!value.is_array() || value.empty()) fail_input("{}: allowed: {}", message_place(scene, where), form);
    if (value.size() > most_grating_orders)
        fail_input("{}: {} orders; allowed: at most {}", message_place(scene, where), value.size(),
                   most_grating_orders);
    Shares from_above, from_below;
    std::vector<GratingOrder> rows;
    for (size_t i = 0; i < value.size(); ++i) {
        const std::string at = fmt::format("{}/{}", where, i), place = message_place(scene, at);
        const json& order = value[i];
        if (!order.is_object()) fail_input("{}: allowed: {}", place, form);
        for (const auto& [name, unused] : order.items())
            if (name != "order" && name != "reflected" && name != "reflected_below" && name != "transmitted")
                fail_input("{}/{}: unknown; allowed: order, reflected, reflected_below, transmitted", place,
                           name);
        if (!order.contains("order") || !order["order"].is_number_integer() ||
            std::abs(order["order"].get<double>()) > greatest_grating_order)
            fail_input("{}/order: allowed: a whole number from -{} to {}", place, greatest_grating_order,
                       greatest_grating_order);
        GratingOrder row;
        row.order = order["order"].get<float>();
        for (const GratingOrder& other : rows)
            if (other.order == row.order)
                fail_input("{}/order: {} stands there twice; allowed: each order once", place, row.order);
        const auto given = [&](const char* name) {
            return order.contains(name) ? share(order, name, scene, at) : SpectralValue{};
        };
        const SpectralValue reflected = given("reflected"), transmitted = given("transmitted");
        const SpectralValue below = order.contains("reflected_below") ? given("reflected_below") : reflected;
        from_above.add(reflected), from_above.add(transmitted);
        from_below.add(below), from_below.add(transmitted);
        const auto ref = [&](const SpectralValue& v) {
            return SpectrumRef{v.rgb, spectrum(v, SpectralKind::factor)};
        };
        row.reflected = ref(reflected), row.reflected_below = ref(below), row.transmitted = ref(transmitted);
        rows.push_back(row);
    }
    for (const auto& [sums, side] : {std::pair(from_above, "the side of the normal"), {from_below, "below"}})
        if (sums.greatest() > 1 + 1e-5)
            fail_input("{}: orders carry {:.4g} of the light from {} together; allowed: at most 1",
                       message_place(scene, where), sums.greatest(), side);
    if (std::none_of(rows.begin(), rows.end(), [](const GratingOrder& row) { return row.order == 0; })) {
        const SpectrumRef none{glm::vec3(0), spectrum(SpectralValue{}, SpectralKind::factor)};
        rows.push_back({0, none, none, none});
    }
    return rows;
}

GratingOrders append(std::vector<GratingOrder>& all, const std::vector<GratingOrder>& rows) {
    all.insert(all.end(), rows.begin(), rows.end());
    return {uint32_t(all.size() - rows.size()), uint32_t(rows.size())};
}

}  // namespace etendue
