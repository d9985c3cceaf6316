#include "host/geometry/bezier_pieces.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "host/error.h"
#include "host/geometry/bernstein.h"

namespace etendue {
namespace {

using glm::dvec3;
using glm::dvec4;
using nlohmann::json;

constexpr int most_cuts = 7;          // of each side, in halves
constexpr double widest_cone = 0.25;  // rad, half its angle
constexpr size_t most_pieces = 1 << 20;

HomogeneousNet read_net(const json& value, const std::string& place) {
    if (!value.is_array() || value.size() != 16)
        fail_input("{}: allowed: 16 points [x, y, z] or [x, y, z, weight], or a list of such patches", place);
    HomogeneousNet net;
    for (size_t i = 0; i < 16; ++i) {
        const json& point = value[i];
        const std::string at = fmt::format("{}/{}", place, i);
        const auto is_number = [](const json& x) { return x.is_number() && std::abs(x.get<double>()) < 1e9; };
        if (!point.is_array() || point.size() < 3 || point.size() > 4 ||
            !std::ranges::all_of(point, is_number))
            fail_input("{}: allowed: [x, y, z] or [x, y, z, weight], numbers within 1e9", at);
        const double weight = point.size() == 4 ? point[3].get<double>() : 1;
        if (!(weight > 1e-9))
            fail_input("{}/3: {} is out of range; allowed: a weight above 1e-9", at, weight);
        net[i / 4][i % 4] = weight * dvec4(point[0], point[1], point[2], 1);
    }
    return net;
}

// At half of a curve: what lies before and behind.
void halve(const std::array<dvec4, 4>& c, std::array<dvec4, 4>& before, std::array<dvec4, 4>& behind) {
    const dvec4 ab = 0.5 * (c[0] + c[1]), bc = 0.5 * (c[1] + c[2]), cd = 0.5 * (c[2] + c[3]),
                abc = 0.5 * (ab + bc), bcd = 0.5 * (bc + cd), middle = 0.5 * (abc + bcd);
    before = {c[0], ab, abc, middle}, behind = {middle, bcd, cd, c[3]};
}

HomogeneousNet transposed(const HomogeneousNet& net) {
    HomogeneousNet result;
    for (size_t j = 0; j < 4; ++j)
        for (size_t i = 0; i < 4; ++i) result[i][j] = net[j][i];
    return result;
}

std::array<HomogeneousPatch, 2> halves(const HomogeneousPatch& patch, bool along_v) {
    const HomogeneousNet net = along_v ? transposed(patch.points) : patch.points;
    std::array<HomogeneousPatch, 2> result{patch, patch};
    for (size_t j = 0; j < 4; ++j) halve(net[j], result[0].points[j], result[1].points[j]);
    if (along_v)
        for (HomogeneousPatch& half : result) half.points = transposed(half.points);
    const double middle = 0.5 * (patch.domain[along_v] + patch.domain[along_v + 2]);
    result[0].domain[along_v + 2] = result[1].domain[along_v] = middle;
    return result;
}

dvec3 place_of(const dvec4& p) { return dvec3(p) / p.w; }

struct Extent {
    dvec3 lo{std::numeric_limits<double>::infinity()}, hi{-std::numeric_limits<double>::infinity()};
    void grow(const HomogeneousNet& net) {
        for (const auto& row : net)
            for (const dvec4& p : row) lo = glm::min(lo, place_of(p)), hi = glm::max(hi, place_of(p));
    }
};

// Derivatives of a rational patch H / W: du = A / W², with A = Hu W - H Wu.
struct Derivatives {
    Bernstein<dvec3> h{3, 3};
    Bernstein<double> w{3, 3};
    Bernstein<dvec3> a, b;  // of u and v

    explicit Derivatives(const HomogeneousNet& net, const dvec3& origin) : Derivatives(fill(net, origin)) {}

    // Bounds of |duu|, |duv|, |dvv|, across the axis and along it: duu = (Au W - 2 A Wu) / W³.
    void second(const dvec3& axis, dvec3& along, dvec3& out) const {
        double least = w.coefficients[0];
        for (const double x : w.coefficients) least = std::min(least, x);
        const auto bound = [&](int i, const Bernstein<dvec3>& p) {
            along[i] = out[i] = 0;
            for (const dvec3& x : p.coefficients) {
                const double part = glm::dot(x, axis);
                out[i] = std::max(out[i], std::abs(part) / (least * least * least));
                along[i] = std::max(along[i], glm::length(x - part * axis) / (least * least * least));
            }
        };
        bound(0, product_difference(derivative_u(a), w, a, derivative_u(w), 2));
        bound(1, product_difference(derivative_v(a), w, a, derivative_v(w), 2));
        bound(2, product_difference(derivative_v(b), w, b, derivative_v(w), 2));
    }

  private:
    struct Filled {
        Bernstein<dvec3> h{3, 3};
        Bernstein<double> w{3, 3};
    };
    static Filled fill(const HomogeneousNet& net, const dvec3& origin) {
        Filled filled;
        for (int j = 0; j < 4; ++j)
            for (int i = 0; i < 4; ++i) {
                const dvec4& p = net[size_t(j)][size_t(i)];
                filled.h.at(i, j) = dvec3(p) - p.w * origin, filled.w.at(i, j) = p.w;
            }
        return filled;
    }
    explicit Derivatives(Filled f)
        : h(f.h),
          w(f.w),
          a(product_difference(derivative_u(h), w, h, derivative_u(w))),
          b(product_difference(derivative_v(h), w, h, derivative_v(w))) {}
};

// What directions lie in, and how far they turn along u and v. Derivatives at a border that is a point count
// for nothing.
struct Cone {
    dvec3 axis{0};
    double angle = 0, turn_u = 0, turn_v = 0;  // rad; half the cone's

    explicit Cone(const Bernstein<dvec3>& p) {
        double greatest = 0;
        for (const dvec3& x : p.coefficients) greatest = std::max(greatest, glm::length(x));
        const auto counts = [&](const dvec3& x) { return glm::length(x) > 1e-7 * greatest; };
        for (const dvec3& x : p.coefficients)
            if (counts(x)) axis += glm::normalize(x);
        if (!(glm::length(axis) > 0)) {
            angle = turn_u = turn_v = 3;
            return;
        }
        axis = glm::normalize(axis);
        const auto between = [](const dvec3& x, const dvec3& y) {
            return std::atan2(glm::length(glm::cross(x, y)), glm::dot(x, y));
        };
        for (const dvec3& x : p.coefficients)
            if (counts(x)) angle = std::max(angle, between(x, axis));
        for (int j = 0; j <= p.degree_v; ++j)
            for (int i = 0; i <= p.degree_u; ++i) {
                if (!counts(p.at(i, j))) continue;
                const dvec3 &beside = p.at(std::min(i + 1, p.degree_u), j),
                            &above = p.at(i, std::min(j + 1, p.degree_v));
                if (counts(beside)) turn_u = std::max(turn_u, between(p.at(i, j), beside));
                if (counts(above)) turn_v = std::max(turn_v, between(p.at(i, j), above));
            }
    }
};

glm::dvec4 cubic_basis(double x) {
    const double y = 1 - x;
    return {y * y * y, 3 * x * y * y, 3 * x * x * y, x * x * x};
}

// The cubic through the values at Gauss' four points, in Bernstein's form: its integral is Gauss' quadrature.
const std::array<double, 4> gauss_points = {0.0694318442029737, 0.3300094782075719, 0.6699905217924281,
                                            0.9305681557970263};
glm::dmat4 through_gauss_points() {
    glm::dmat4 values;
    for (int i = 0; i < 4; ++i) values[i] = cubic_basis(gauss_points[size_t(i)]);
    return glm::inverse(glm::transpose(values));
}

// |du x dv|, column by column along u.
glm::dmat4 area_density(const HomogeneousNet& net) {
    static const glm::dmat4 solve = through_gauss_points();
    glm::dmat4 values;  // [point along u][point along v]
    for (int k = 0; k < 4; ++k)
        for (int l = 0; l < 4; ++l) {
            const double x = gauss_points[size_t(k)], y = gauss_points[size_t(l)];
            const auto slope = [](double s) {
                const double r = 1 - s;
                return 3.0 * dvec4(-r * r, r * (r - 2 * s), s * (2 * r - s), s * s);
            };
            dvec4 h(0), hu(0), hv(0);
            for (int j = 0; j < 4; ++j)
                for (int i = 0; i < 4; ++i) {
                    const dvec4& p = net[size_t(j)][size_t(i)];
                    h += cubic_basis(x)[i] * cubic_basis(y)[j] * p;
                    hu += slope(x)[i] * cubic_basis(y)[j] * p;
                    hv += cubic_basis(x)[i] * slope(y)[j] * p;
                }
            const dvec3 du = (dvec3(hu) - hu.w * place_of(h)) / h.w,
                        dv = (dvec3(hv) - hv.w * place_of(h)) / h.w;
            values[k][l] = glm::length(glm::cross(du, dv));
        }
    return solve * values * glm::transpose(solve);
}

BezierPiece piece_of(const HomogeneousPatch& patch, const Cone& u, const Cone& v, const Extent& hull,
                     const dvec3& origin, const Derivatives& derivatives) {
    BezierPiece piece{};
    double weight = 0, radius = 0;
    for (const auto& row : patch.points)
        for (const dvec4& p : row)
            weight += p.w / 16, radius = std::max(radius, glm::length(place_of(p) - origin));
    for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 4; ++i) {
            const dvec4& p = patch.points[size_t(j)][size_t(i)];
            piece.rows[j][i] = glm::vec4(glm::dvec4(dvec3(p) - p.w * origin, p.w) / weight);
        }
    piece.area_density = glm::mat4(area_density(patch.points));
    piece.origin = glm::vec3(origin), piece.radius = float(radius * 1.00001);
    // Closer than the hull: that of sixteenths.
    Extent extent;
    for (const HomogeneousPatch& half : halves(patch, false))
        for (const HomogeneousPatch& quarter : halves(half, false))
            for (const HomogeneousPatch& low : halves(quarter, true))
                for (const HomogeneousPatch& part : halves(low, true)) extent.grow(part.points);
    const dvec3 slack(4e-7 * radius + 1e-7 * glm::length(origin));
    piece.lo = glm::vec3(glm::max(extent.lo, hull.lo) - slack),
    piece.hi = glm::vec3(glm::min(extent.hi, hull.hi) + slack);
    const dvec3 normal = glm::cross(u.axis, v.axis);
    piece.axis = glm::length(normal) > 1e-6 ? glm::vec3(glm::normalize(normal)) : glm::vec3(0, 0, 1);
    dvec3 along, out;
    derivatives.second(dvec3(piece.axis), along, out);
    piece.second_along = glm::vec3(along * 1.00001), piece.second_out = glm::vec3(out * 1.00001);
    piece.domain = glm::vec4(patch.domain);
    return piece;
}

void cut(const HomogeneousPatch& patch, int cuts_u, int cuts_v, std::vector<BezierPiece>& out) {
    Extent hull;
    hull.grow(patch.points);
    const dvec3 origin = glm::dvec3(glm::vec3(0.5 * (hull.lo + hull.hi)));
    const Derivatives derivatives(patch.points, origin);
    const Cone u(derivatives.a), v(derivatives.b);
    const double between = std::acos(std::clamp(std::abs(glm::dot(u.axis, v.axis)), 0.0, 1.0));
    const bool is_flat = std::max(u.angle, v.angle) <= widest_cone && u.angle + v.angle <= 0.5 * between;
    const bool may_u = cuts_u < most_cuts, may_v = cuts_v < most_cuts;
    if (is_flat || (!may_u && !may_v)) {
        out.push_back(piece_of(patch, u, v, hull, origin, derivatives));
        return;
    }
    const bool along_v = may_v && (!may_u || std::max(u.turn_v, v.turn_v) > std::max(u.turn_u, v.turn_u));
    for (const HomogeneousPatch& half : halves(patch, along_v))
        cut(half, cuts_u + !along_v, cuts_v + along_v, out);
}

}  // namespace

std::vector<HomogeneousPatch> read_bezier_patches(const json& value, const std::string& place) {
    const bool is_one = value.is_array() && !value.empty() && value[0].is_array() && !value[0].empty() &&
                        value[0][0].is_number();
    if (is_one) return {{read_net(value, place)}};
    if (!value.is_array() || value.empty()) read_net(value, place);
    std::vector<HomogeneousPatch> patches;
    for (size_t i = 0; i < value.size(); ++i) {
        const std::string at = fmt::format("{}/{}", place, i);
        if (!value[i].is_object()) {
            patches.push_back({read_net(value[i], at)});
            continue;
        }
        for (const auto& [key, unused] : value[i].items())
            if (key != "points" && key != "uv") fail_input("{}/{}: unknown; allowed: points, uv", at, key);
        patches.push_back({read_net(value[i].value("points", json()), at + "/points")});
        if (!value[i].contains("uv")) continue;
        const json& uv = value[i]["uv"];
        if (!uv.is_array() || uv.size() != 4 ||
            !std::ranges::all_of(uv, [](const json& x) { return x.is_number(); }))
            fail_input("{}/uv: allowed: [u0, v0, u1, v1]", at);
        patches.back().domain = {uv[0], uv[1], uv[2], uv[3]};
    }
    return patches;
}

std::vector<BezierPiece> cut_bezier_patches(const std::vector<HomogeneousPatch>& patches,
                                            const std::string& place) {
    std::vector<BezierPiece> pieces;
    float greatest = 0;
    for (size_t i = 0; i < patches.size(); ++i) {
        const size_t first = pieces.size();
        cut(patches[i], 0, 0, pieces);
        double area = 0, extent = 0;
        const auto is_empty = [&](const BezierPiece& p) {
            double sum = 0;
            for (int k = 0; k < 4; ++k)
                for (int l = 0; l < 4; ++l) sum += double(p.area_density[k][l]) / 16;
            area += sum, extent = std::max(extent, double(p.radius));
            return !(sum > 1e-12 * p.radius * p.radius);
        };
        pieces.erase(std::remove_if(pieces.begin() + ptrdiff_t(first), pieces.end(), is_empty), pieces.end());
        if (!(area > 1e-12 * extent * extent))
            fail_input("{}: patch {} has no area; allowed: points that do not lie on a line", place, i);
        if (pieces.size() > most_pieces)
            fail_input("{}: makes more than {} pieces; allowed: fewer or smoother patches", place,
                       most_pieces);
    }
    for (const BezierPiece& p : pieces) greatest = std::max(greatest, p.radius);
    // Of points whose sums have up to 30 rounded terms, to the length.
    constexpr float epsilon = 0x1p-24f;
    for (BezierPiece& p : pieces) p.slack = 32 * 1.75f * epsilon * greatest;
    return pieces;
}

}  // namespace etendue
