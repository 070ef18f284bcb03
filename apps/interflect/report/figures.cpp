#include "apps/interflect/report/figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "apps/interflect/report/html.h"
#include "interflect/plots.h"

namespace interflect::command {

using namespace detail;

namespace {

// Lengths in a figure, whose longer side is figure_side.
constexpr double figure_side = 1000, dimension_space = 46, legend_space = 92, font_size = 15;

struct Frame {
    const ReportPlan& plan;
    double unit;  // length in the figure per metre
    double width, height;

    explicit Frame(const ReportPlan& p)
        : plan(p),
          unit(figure_side / std::max(p.high.x - p.low.x, p.high.y - p.low.y)),
          width(unit * (p.high.x - p.low.x)),
          height(unit * (p.high.y - p.low.y)) {}
    double x(double world) const { return unit * (world - plan.low.x); }
    double y(double world) const { return unit * (plan.high.y - world); }
};

std::string colour_text(const Rgb& linear) {
    const std::array<std::uint8_t, 3> bytes = srgb_bytes(linear);
    return fmt::format("#{:02x}{:02x}{:02x}", bytes[0], bytes[1], bytes[2]);
}

std::string text(double x, double y, const char* anchor, const std::string& words, double size = font_size) {
    return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" font-size=\"{:.1f}\">{}</text>\n", x, y,
                       anchor, size, words);
}

/// Returns 1, 2 or 5 times a power of ten, at most a quarter of the plan's width [m].
double bar_length(const ReportPlan& plan) {
    const double longest = (plan.high.x - plan.low.x) / 4, power = std::pow(10, std::floor(std::log10(longest)));
    for (const double factor : {5.0, 2.0})
        if (factor * power <= longest) return factor * power;
    return power;
}

/// Starts a figure: the picture, with a scale bar and dimensions below. @param free_height  Free height below these.
std::string begin(const Frame& frame, const Image& picture, double free_height) {
    const double below = frame.height + dimension_space;
    std::string svg = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {:.1f} {:.1f}\" font-family=\"Helvetica, Arial, "
        "'Liberation Sans', sans-serif\" fill=\"#1d2430\">\n<image x=\"0\" y=\"0\" width=\"{:.1f}\" height=\"{:.1f}\" "
        "href=\"{}\"/>\n",
        frame.width, below + free_height, frame.width, frame.height, data_url(picture));
    const double bar = bar_length(frame.plan), y = frame.height + 14;
    svg += fmt::format("<path d=\"M1 {0:.1f}v8h{1:.1f}v-8\" fill=\"none\" stroke=\"#1d2430\" stroke-width=\"1.5\"/>\n",
                       y, frame.unit * bar);
    svg += text(frame.unit * bar + 8, y + 9, "start", fmt::format("{:g} m", bar));
    svg +=
        text(frame.width, y + 9, "end",
             fmt::format("{:.2f} × {:.2f} m; x to the right, y up", frame.plan.floor_size.x, frame.plan.floor_size.y));
    return svg;
}

std::string legend(const Frame& frame) {
    constexpr int stops = 17, max_values = 9;
    const double top = frame.height + dimension_space + 22, right = frame.width - 2;
    std::string svg = "<linearGradient id=\"colours\">\n";
    for (int i = 0; i < stops; ++i) {
        const float t = static_cast<float>(i) / (stops - 1);
        svg += fmt::format("<stop offset=\"{:.4f}\" stop-color=\"{}\"/>\n", t, colour_text(false_colour(t)));
    }
    svg += "</linearGradient>\n" + text(2, top - 8, "start", "Illuminance [lx]");
    svg += fmt::format("<rect x=\"2\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"20\" fill=\"url(#colours)\"/>\n", top,
                       right - 2);
    for (const float value : round_values(frame.plan.scale, max_values)) {
        const double t = frame.plan.scale.position(value), x = 2 + t * (right - 2);
        svg += fmt::format("<path d=\"M{:.1f} {:.1f}v6\" stroke=\"#1d2430\" stroke-width=\"1.2\"/>\n", x, top + 20);
        svg += text(x, top + 42, t < 0.02 ? "start" : t > 0.98 ? "end" : "middle", fmt::format("{:g}", value));
    }
    return svg;
}

}  // namespace

std::string illuminance_figure(const ReportPlan& plan) {
    const Frame frame(plan);
    return begin(frame, plan.illuminance, legend_space) + legend(frame) + "</svg>\n";
}

std::string values_figure(const ReportPlan& plan, std::span<const MeasuredGrid> areas) {
    constexpr double widest_digits = 2.6;         // width of four digits and a gap, in font heights
    constexpr double smallest = 7, largest = 19;  // font sizes
    const Frame frame(plan);
    Image pale = plan.outlines;
    for (Rgb& pixel : pale.pixels) pixel = Rgb(0.45f) + pixel * 0.55f;
    std::string svg = begin(frame, pale, 0);
    for (const MeasuredGrid& area : areas) {
        const double size = std::min(largest, frame.unit * area.grid.column_spacing / widest_digits);
        for (std::size_t i = 0; i < area.measured.size(); ++i) {
            const double x = frame.x(area.grid.points[i].x), y = frame.y(area.grid.points[i].y);
            if (size < smallest)
                svg += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"1.5\"/>\n", x, y);
            else
                svg += text(x, y + 0.35 * size, "middle", fmt::format("{:.0f}", area.measured[i].illuminance()), size);
        }
    }
    return svg + "</svg>\n";
}

}  // namespace interflect::command
