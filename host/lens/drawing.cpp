#include "host/lens/drawing.h"

#include <algorithm>

#include "host/error.h"
#include "host/html.h"

namespace etendue {
namespace {

constexpr double width = 1000, margin = 40;  // px
const char* const colours[] = {"#1f6fb4", "#d1592a", "#2a8f4f", "#8a4fb0", "#b3861b", "#4b5563"};

using Line = std::vector<glm::dvec2>;  // z and y in the frame of the first surface, mm

struct Section {
    const Prescription& p;
    std::vector<FrameChange> frames;

    glm::dvec2 place(size_t surface, const glm::dvec3& point) const {
        const glm::dvec3 world = frames[surface].turn * point + frames[surface].shift;
        return {world.z, world.y};
    }
    // How far a surface is drawn from the middle of its aperture.
    double half_height(size_t surface) const {
        const LensAperture& a = p.surfaces[surface].aperture;
        const double half = std::min(a.semi_diameter, a.half_size.y);
        return std::isfinite(half) ? half : 0;
    }
    // From `from` to `to`, as parts of the half height.
    Line profile(size_t surface, double from, double to) const {
        const LensSurface& s = p.surfaces[surface];
        Line line;
        constexpr int steps = 48;
        for (int i = 0; i <= steps; ++i) {
            const double y = s.aperture.center.y + half_height(surface) * (from + (to - from) * i / steps);
            const double reach = std::min(s.shape.reach(), 1e300), inside = std::clamp(y, -reach, reach);
            line.push_back(place(surface, {0, inside, s.shape.sag(0, inside)}));
        }
        return line;
    }
    // Of the glass between two surfaces: the smaller one goes on as a plane to the height of the larger one.
    Line glass(size_t a, size_t b) const {
        Line outline = profile(a, -1, 1), back = profile(b, 1, -1);
        const double larger = std::max(half_height(a), half_height(b));
        const auto corner = [&](size_t surface, double side) {
            const LensSurface& s = p.surfaces[surface];
            return place(surface, {0, s.aperture.center.y + side * larger,
                                   s.shape.sag(0, s.aperture.center.y + side * half_height(surface))});
        };
        const Line above = {corner(a, 1), corner(b, 1)}, below = {corner(b, -1), corner(a, -1)};
        outline.insert(outline.end(), above.begin(), above.end());
        outline.insert(outline.end(), back.begin(), back.end());
        outline.insert(outline.end(), below.begin(), below.end());
        return outline;
    }
};

struct DrawnRay {
    Line line;
    size_t field;
};

std::vector<DrawnRay> drawn_rays(const Section& section, const ParaxialFigures& figures, size_t count,
                                 double lead) {
    const Prescription& p = section.p;
    const LensTracer tracer(p, p.primary_nm());
    std::vector<DrawnRay> drawn;
    for (size_t f = 0; f < p.fields.size(); ++f) {
        const FieldRays rays(p, figures, p.fields[f]);
        for (size_t i = 0; i < count; ++i) {
            const LensRay start = rays.ray({0, count == 1 ? 0 : 2.0 * double(i) / double(count - 1) - 1});
            const TracedRay traced = tracer.trace(start);
            const glm::dvec3 from =
                start.position - start.direction * (std::min(lead, p.object_distance) / start.direction.z);
            DrawnRay ray{{{from.z, from.y}}, f};
            const size_t end =
                traced.stopped ? std::min(*traced.stopped + 1, traced.points.size()) : traced.points.size();
            for (size_t s = 0; s < end; ++s)
                if (!p.surfaces[s].frame_change)
                    ray.line.push_back(section.place(s, traced.points[s].position));
            drawn.push_back(ray);
        }
    }
    return drawn;
}

double round_length(double mm) {  // 1, 2 or 5 times a power of ten, at most so long
    const double power = std::pow(10, std::floor(std::log10(mm)));
    return (mm >= 5 * power ? 5 : mm >= 2 * power ? 2 : 1) * power;
}

class Drawing {
  public:
    explicit Drawing(const std::vector<Line>& lines) : low_(infinite), high_(-infinite) {
        for (const Line& line : lines)
            for (const glm::dvec2& point : line)
                if (std::isfinite(point.x + point.y))
                    low_ = glm::min(low_, point), high_ = glm::max(high_, point);
        const glm::dvec2 size = glm::max(high_ - low_, glm::dvec2(1e-6));
        scale_ = std::min((width - 2 * margin) / size.x, (800 - 2 * margin) / size.y);
        height_ = size.y * scale_ + 2 * margin + 50;
    }
    void add(const Line& line, const std::string& style, bool is_closed = false) {
        if (line.size() < 2) return;
        body_ += fmt::format("<path style=\"{}\" d=\"", style);
        for (size_t i = 0; i < line.size(); ++i)
            body_ +=
                fmt::format("{}{:.2f} {:.2f}", i == 0 ? "M" : "L", margin + (line[i].x - low_.x) * scale_,
                            margin + 24 + (high_.y - line[i].y) * scale_);
        body_ += is_closed ? "Z\"/>\n" : "\"/>\n";
    }
    void write(double x, double y, const std::string& words, const std::string& style = "") {
        body_ += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" style=\"{}\">{}</text>\n", x, y, style,
                             escaped(printable(words)));
    }
    void add_scale() {
        const double mm = round_length(150 / scale_), y = height_ - 16;
        body_ += fmt::format("<path style=\"stroke:#333\" d=\"M{0} {1}V{2}H{3:.2f}V{1}\"/>\n", margin, y - 5,
                             y, margin + mm * scale_);
        write(margin + mm * scale_ + 8, y, fmt::format("{:g} mm", mm));
    }
    double height() const { return height_; }
    std::string text() const {
        return fmt::format(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" width=\"{0:.0f}\" "
            "height=\"{1:.0f}\">\n"
            "<style>path{{fill:none;stroke-width:1}}text{{font:13px sans-serif;fill:#333}}</style>\n"
            "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n{2}</svg>\n",
            width, height_, body_);
    }

  private:
    glm::dvec2 low_, high_;
    double scale_, height_;
    std::string body_;
};

std::string field_name(const Prescription& p, const LensField& field) {
    const std::string unit = p.field_kind == Prescription::FieldKind::angle ? "°" : " mm";
    const std::string y = fmt::format("{:.4g}{}", field.value.y, unit);
    return field.value.x == 0 ? y : fmt::format("{:.4g}{}, {}", field.value.x, unit, y);
}

}  // namespace

std::string lens_drawing(const Prescription& p, const ParaxialFigures& figures, size_t ray_count) {
    const Section section{p, lens_frames(p)};
    std::vector<Line> everything;
    for (size_t i = 0; i < p.surfaces.size(); ++i)
        if (!p.surfaces[i].frame_change) everything.push_back(section.profile(i, -1, 1));
    glm::dvec2 low(infinite), high(-infinite);
    for (const Line& line : everything)
        for (const glm::dvec2& point : line) low = glm::min(low, point), high = glm::max(high, point);
    const std::vector<DrawnRay> rays =
        drawn_rays(section, figures, ray_count, 0.12 * glm::length(high - low));
    for (const DrawnRay& ray : rays) everything.push_back(ray.line);

    Drawing drawing(everything);
    drawing.add({{-1e6, 0}, {1e6, 0}}, "stroke:#999;stroke-width:.6;stroke-dasharray:12 3 2 3");
    std::optional<size_t> front;  // of glass that is not yet closed
    for (size_t i = 0; i < p.surfaces.size(); ++i) {
        if (p.surfaces[i].frame_change) continue;
        if (front && !p.surfaces[*front].glass.is_air() && i + 1 < p.surfaces.size())
            drawing.add(section.glass(*front, i), "fill:#cfe3f2;fill-opacity:.7;stroke:#35607f", true);
        front = i;
    }
    for (const DrawnRay& ray : rays)
        drawing.add(ray.line,
                    fmt::format("stroke:{};stroke-width:.7", colours[ray.field % std::size(colours)]));
    for (size_t i = 0; i < p.surfaces.size(); ++i) {
        const LensSurface& s = p.surfaces[i];
        if (s.frame_change) continue;
        const double inner =
            section.half_height(i) > 0 ? s.aperture.inner_radius / section.half_height(i) : 0;
        const bool is_image = i + 1 == p.surfaces.size();
        const char* style = s.is_mirror ? "stroke:#222;stroke-width:2.5"
                            : is_image  ? "stroke:#222;stroke-width:1.5"
                                        : "stroke:#35607f";
        if (s.is_mirror || s.grating || is_image || !(s.glass == p.glass_before(i))) {
            if (inner > 0)
                drawing.add(section.profile(i, -1, -inner), style),
                    drawing.add(section.profile(i, inner, 1), style);
            else
                drawing.add(section.profile(i, -1, 1), style);
        }
        if (i == p.stop)
            drawing.add(section.profile(i, 1, 1.25), "stroke:#000;stroke-width:3"),
                drawing.add(section.profile(i, -1, -1.25), "stroke:#000;stroke-width:3");
    }
    drawing.write(margin, 24, p.title.empty() ? std::filesystem::path(p.file).filename().string() : p.title,
                  "font-weight:bold");
    drawing.add_scale();
    double x = width - margin;
    for (size_t f = p.fields.size(); f-- > 0;) {
        drawing.write(x, drawing.height() - 16, field_name(p, p.fields[f]),
                      fmt::format("text-anchor:end;fill:{}", colours[f % std::size(colours)]));
        x -= 75;
    }
    return drawing.text();
}

}  // namespace etendue
