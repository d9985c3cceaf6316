// What a scene says of the orders of a grating (shaders/surfaces/grating.glsl), checked.
#pragma once
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "host/scene/records.h"

namespace etendue {

constexpr size_t most_grating_orders = 64;      // of one grating
constexpr int greatest_grating_order = 100000;  // to either side

// Twin of struct GratingOrder in shaders/surfaces/grating.glsl.
struct GratingOrder {
    float order = 0;
    SpectrumRef reflected, reflected_below, transmitted;  // parts of the power that comes
};

// [{"order": m, "reflected": value, "reflected_below": value, "transmitted": value}, …], at least one. Order
// 0 is always among the result. Fails where orders repeat, or carry more than comes together.
std::vector<GratingOrder> read_grating_orders(
    const nlohmann::json& value, const SceneDescription& scene, const std::string& where,
    const std::function<uint32_t(const SpectralValue& value, SpectralKind kind)>& spectrum);

// Where the rows of one grating stand among those of all.
GratingOrders append(std::vector<GratingOrder>& all, const std::vector<GratingOrder>& rows);

}  // namespace etendue
