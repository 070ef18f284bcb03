#include "apps/interflect/report/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "apps/interflect/console/print_views.h"
#include "apps/interflect/console/progress.h"
#include "apps/interflect/measure/measuring_places.h"
#include "apps/interflect/report/figures.h"
#include "apps/interflect/report/html.h"
#include "apps/interflect/values/percent.h"
#include "interflect/measure.h"

namespace interflect::command {

namespace {

constexpr const char* page_style = R"(
@page { size: A4; margin: 14mm 15mm; }
:root { --ink: #1d2430; --soft: #5c6675; --line: #d5dae1; --accent: #1b6f6a; }
* { box-sizing: border-box; }
body { font: 10.5pt/1.45 "Helvetica Neue", Helvetica, Arial, "Liberation Sans", sans-serif; color: var(--ink);
       max-width: 190mm; margin: 10mm auto; padding: 0 5mm; background: #fff; }
header { border-bottom: 2.5pt solid var(--accent); padding-bottom: 3mm; margin-bottom: 5mm; }
h1 { font-size: 21pt; line-height: 1.15; margin: 0 0 1mm; font-weight: 600; }
h2 { font-size: 13pt; margin: 8mm 0 2.5mm; font-weight: 600; color: var(--accent); break-after: avoid; }
p { margin: 0 0 2.5mm; } .soft, figcaption, footer { color: var(--soft); } .soft { font-size: 9.5pt; }
table { border-collapse: collapse; width: 100%; margin: 0 0 4mm; font-variant-numeric: tabular-nums; font-size: 9.5pt; }
th { text-align: right; font-weight: 600; color: var(--soft); border-bottom: 1pt solid var(--ink); padding: 1mm 1.5mm;
     vertical-align: bottom; }
td { text-align: right; border-bottom: 0.5pt solid var(--line); padding: 1mm 1.5mm; } tr { break-inside: avoid; }
th.name, td.name { text-align: left; overflow-wrap: anywhere; } .key { display: grid; gap: 3mm; margin: 0 0 4mm;
     grid-template-columns: repeat(auto-fit, minmax(34mm, 1fr)); }
.key div { border-left: 2pt solid var(--accent); padding: 0.5mm 0 0.5mm 2.5mm; } .key b { display: block; font-size: 15pt;
     font-weight: 600; line-height: 1.2; } .key span { color: var(--soft); font-size: 9pt; }
figure { margin: 0 0 5mm; break-inside: avoid; } figure svg, figure img { width: 100%; height: auto; display: block; }
figure.plan svg { max-height: 205mm; } figcaption { font-size: 9pt; margin-top: 1.5mm; }
.pair { display: grid; grid-template-columns: 1fr 1fr; gap: 4mm; align-items: start; }
footer { border-top: 0.5pt solid var(--line); margin-top: 8mm; padding-top: 2mm; font-size: 8.5pt; }
@media print { body { margin: 0; padding: 0; max-width: none; } section.sheet { break-before: page; } }
)";

std::string file_name(const std::string& path) { return html_text(std::filesystem::path(path).filename().string()); }

/// Returns a row of a table, whose first `names` cells are names and whose others are numbers.
std::string row(const std::vector<std::string>& cells, std::size_t names = 1, const char* tag = "td") {
    std::string text = "<tr>";
    for (std::size_t i = 0; i < cells.size(); ++i)
        text += fmt::format("<{0}{1}>{2}</{0}>", tag, i < names ? " class=\"name\"" : "", cells[i]);
    return text + "</tr>\n";
}

std::string table(const char* id, const std::vector<std::string>& heads, const std::string& rows,
                  std::size_t names = 1) {
    return fmt::format("<table id=\"{}\">\n<thead>{}</thead>\n<tbody>\n{}</tbody>\n</table>\n", id,
                       row(heads, names, "th"), rows);
}

/// Formats lux or lumens: three digits or whole numbers.
std::string number(double value) {
    if (!std::isfinite(value)) return "–";
    return std::abs(value) >= 100 ? fmt::format("{:.0f}", value) : fmt::format("{:.3g}", value);
}

std::string header(const ReportContent& content, const SolvedScene& solved) {
    return fmt::format("<header>\n<h1>{}</h1>\n<p class=\"soft\">Lighting report · scene {} · {}</p>\n</header>\n",
                       html_text(content.title), file_name(solved.scene.name), html_text(content.date));
}

std::string key_figure(const std::string& value, const std::string& meaning) {
    return fmt::format("<div><b>{}</b><span>{}</span></div>\n", value, meaning);
}

double floor_area(const ReportContent& content) {
    double area = 0;
    for (const PlanarArea& room : content.rooms) area += room.area;
    return area;
}

std::string key_figures(const ReportContent& content) {
    std::string text = "<div class=\"key\">\n";
    for (std::size_t i = 0; i < std::min<std::size_t>(content.rooms.size(), 2); ++i) {
        const IlluminanceSummary s = summarise(content.areas[i].measured);
        text += key_figure(number(s.mean) + " lx", "mean, " + html_text(content.areas[i].grid.name));
        text += key_figure(fmt::format("{:.2f}", s.uniformity()), "U<sub>0</sub>, " + html_text(content.rooms[i].name));
    }
    double flux = 0;
    for (const LightFacts& light : content.facts.lights)
        if (!light.far_away) flux += light.flux;
    text += key_figure(number(flux) + " lm", "luminous flux of all luminaires");
    if (!content.glare.empty()) {
        double worst = -std::numeric_limits<double>::infinity();
        for (const RatedGrid& g : content.glare)
            if (!g.ratings.empty()) worst = std::max(worst, g.ratings[g.reported()].ugr);
        text += key_figure(std::isfinite(worst) ? fmt::format("{:.1f}", worst) : "–", "largest UGR");
    }
    return text + "</div>\n";
}

std::string results(const ReportContent& content) {
    std::string rows;
    std::vector<std::string> heads = {
        "Measuring area",       "Points",        "Spacing [m]",   "E<sub>mean</sub> [lx]", "E<sub>min</sub> [lx]",
        "E<sub>max</sub> [lx]", "U<sub>0</sub>", "U<sub>d</sub>", "Std. error [lx]",       "Solution’s [lx]"};
    if (content.exterior) heads.push_back("Daylight factor");
    std::size_t enclosed = 0;
    for (const MeasuredGrid& area : content.areas) {
        const IlluminanceSummary s = summarise(area.measured, area.solution_error);
        const MeasuringGrid& grid = area.grid;
        std::string spacing = "–";
        if (grid.columns > 0) spacing = fmt::format("{:.2f} × {:.2f}", grid.column_spacing, grid.row_spacing);
        enclosed += grid.enclosed;
        std::vector<std::string> cells = {html_text(grid.name),
                                          fmt::format("{}", s.points),
                                          spacing,
                                          number(s.mean),
                                          number(s.min),
                                          number(s.max),
                                          fmt::format("{:.2f}", s.uniformity()),
                                          fmt::format("{:.2f}", s.diversity()),
                                          fmt::format("{:.2g}", s.mean_error),
                                          fmt::format("{:.2g}", s.mean_solution_error)};
        if (content.exterior) cells.push_back(percent(s.mean / *content.exterior));
        rows += row(cells);
    }
    return "<h2>Illuminance</h2>\n" + table("results", heads, rows) +
           fmt::format(
               "<p class=\"soft\">U<sub>0</sub> = E<sub>min</sub>/E<sub>mean</sub>, U<sub>d</sub> = "
               "E<sub>min</sub>/E<sub>max</sub>. Grids by EN 12464-1, p = 0.2 · 5<sup>log<sub>10</sub> d</sup> "
               "m unless told otherwise. The standard error is that of the mean, from sampling at the "
               "points; the error of the solution comes on top of it.{}{}</p>\n",
               enclosed > 0 ? fmt::format(" {} points inside furniture are left out.", enclosed) : "",
               content.exterior
                   ? fmt::format(" Daylight factors are relative to {} lx outside.", number(*content.exterior))
                   : "");
}

std::string glare_row(const RatedGrid& g, std::size_t rating, const std::string& name) {
    const Observer& observer = g.observers[rating];
    const double ugr = g.ratings[rating].ugr;
    return row({name, fmt::format("{}", g.ratings.size()),
                std::isfinite(ugr) ? fmt::format("{:.1f}", ugr) : "no source is rated", text_of(observer.eye),
                text_of(observer.line_of_sight), number(g.ratings[rating].background_luminance)});
}

std::string glare(const ReportContent& content) {
    if (content.glare.empty()) return {};
    std::string rows, sources;
    for (const RatedGrid& g : content.glare) {
        if (g.ratings.empty()) continue;
        const GlareRating& rating = g.ratings[g.reported()];
        rows += glare_row(g, g.reported(), html_text(g.grid.name));
        if (g.is_seat && g.worst() != g.reported())
            rows += glare_row(g, g.worst(), html_text(g.grid.name) + ", worst direction");
        constexpr std::size_t max_reported = 4;
        for (std::size_t i = 0; i < std::min(rating.sources.size(), max_reported); ++i) {
            const GlareSource& s = rating.sources[i];
            sources += row(
                {html_text(g.grid.name), html_text(s.name) + (s.is_rated ? "" : " (not rated)"), number(s.luminance),
                 fmt::format("{:.3g}", s.solid_angle), fmt::format("{:.2f}", s.position_index)},
                2);
        }
    }
    return "<h2>Glare</h2>\n" +
           table("glare", {"Observers", "Ratings", "UGR", "Eye [m]", "Looking", "L<sub>b</sub> [cd/m²]"}, rows) +
           (sources.empty() ? ""
                            : table("glare-sources", {"Observers", "Source", "L [cd/m²]", "ω [sr]", "p"}, sources, 2)) +
           "<p class=\"soft\">Unified Glare Rating by CIE 117: UGR = 8 log<sub>10</sub>(0.25/L<sub>b</sub> Σ L²ω/p²). "
           "Grids show the largest rating of observers that look along ±x and ±y. Sources outside of the standard's "
           "table of position indices (H/R > 1.9 or T/R > 3) are not rated.</p>\n";
}

std::string rooms(const ReportContent& content) {
    const Imath::Box3d& box = content.facts.bounds;
    std::string rows;
    for (std::size_t i = 0; i < content.rooms.size(); ++i) {
        const MeasuringGrid& grid = content.areas[i].grid;
        rows += row({html_text(content.rooms[i].name), fmt::format("{:.2f}", content.rooms[i].area),
                     fmt::format("{:.2f} × {:.2f}", grid.columns * grid.column_spacing, grid.rows * grid.row_spacing)});
    }
    return fmt::format("<p>The scene extends over {:.2f} × {:.2f} × {:.2f} m.</p>\n", box.size().x, box.size().y,
                       box.size().z) +
           table("rooms", {"Floor", "Area [m²]", "Measured [m]"}, rows);
}

std::string lights(const ReportContent& content) {
    std::string rows;
    for (const LightFacts& light : content.facts.lights) {
        rows += row({html_text(light.name), html_text(light.kind), fmt::format("{}", light.count),
                     light.far_away ? "–" : number(light.flux), light.luminance ? number(*light.luminance) : "–"},
                    2);
    }
    const PowerBalance& balance = content.facts.balance;
    return table("lights", {"Light source", "Kind", "Number", "Flux [lm]", "Luminance [cd/m²]"}, rows, 2) +
           fmt::format(
               "<p>Balance: {} lm emitted = {} lm absorbed + {} lm escaped ({:+.2f}%). Emitted flux over the "
               "floor's area: {} lm/m².</p>\n",
               number(luminance(balance.emitted)), number(luminance(balance.absorbed)),
               number(luminance(balance.escaped)), 100 * balance.relative_difference(),
               number(luminance(balance.emitted) / floor_area(content)));
}

std::string surfaces(const ReportContent& content) {
    constexpr std::size_t max_reported = 24;
    std::string rows;
    const std::vector<SurfaceFacts>& all = content.facts.surfaces;
    for (std::size_t i = 0; i < std::min(all.size(), max_reported); ++i)
        rows += row({html_text(all[i].material.empty() ? "(unnamed)" : all[i].material),
                     fmt::format("{:.2f}", all[i].area), fmt::format("{:.2f}", all[i].reflectance),
                     all[i].transmittance > 0 ? fmt::format("{:.2f}", all[i].transmittance) : "–",
                     all[i].specular_reflectance > 0 ? fmt::format("{:.2f}", all[i].specular_reflectance) : "–"});
    const std::string others = all.size() > max_reported ? fmt::format("<p class=\"soft\">And {} smaller ones.</p>\n",
                                                                       all.size() - max_reported)
                                                         : std::string();
    return table("surfaces", {"Material", "Area [m²]", "Reflectance ρ", "Transmittance τ", "Mirrored"}, rows) + others;
}

std::string plans(const ReportContent& content) {
    return "<section class=\"sheet\">\n<h2>Plan</h2>\n<figure class=\"plan\">\n" + illuminance_figure(content.plan) +
           fmt::format(
               "<figcaption>Horizontal illuminance at z = {:.3g} m, isolines in lux; outlines of the objects that lie "
               "lower than {:.3g} m.</figcaption>\n</figure>\n</section>\n",
               content.working_plane, content.working_plane + 1) +
           "<section class=\"sheet\">\n<h2>Values</h2>\n<figure class=\"plan\">\n" +
           values_figure(content.plan, {content.areas.data(), content.rooms.size()}) +
           "<figcaption>Illuminance at the measuring points [lx].</figcaption>\n</figure>\n</section>\n";
}

std::string pictures(const ReportContent& content) {
    if (content.pictures.empty()) return {};
    std::string text = "<section class=\"sheet\">\n<h2>Views</h2>\n";
    for (const ReportPicture& p : content.pictures)
        text += fmt::format(
            "<figure>\n<div class=\"pair\"><img alt=\"{0}\" src=\"{1}\"><img alt=\"{0}, illuminance\" "
            "src=\"{2}\"></div>\n<figcaption>View “{0}”, and illuminance of the visible surfaces [lx]."
            "</figcaption>\n</figure>\n",
            html_text(p.view), data_url(p.picture), data_url(p.illuminance));
    return text + "</section>\n";
}

std::string method(const ReportContent& content, const SolvedScene& solved) {
    const Solution& solution = solved.solution;
    std::string text = "<h2>Method</h2>\n<p>Interreflection between diffuse surfaces by stochastic radiosity ";
    text += fmt::format("(method {}, seed {}", html_text(solution.options.method.name), solution.options.seed);
    if (!solution.iterations.empty()) {
        const IterationReport& last = solution.iterations.back();
        text += fmt::format(", {} rays, {} elements", magnitude(static_cast<double>(last.rays)), last.elements);
        if (std::isfinite(last.error_estimate))
            text += "; estimated relative error of the elements " + text_of_error(last);
    }
    text += fmt::format(
        "){}. Illuminance at points is gathered from this solution: direct light is sampled from the "
        "sources, indirect light along {} directions per point; the standard errors are those of "
        "this sampling. The errors of the solution are estimated by path tracing at up to 256 points. Pictures: {} "
        "directions a pixel, filtered. Surfaces are taken as diffuse, "
        "light passes straight through thin glass, and light that mirrors reflect is not counted. "
        "The scene has the maintenance factors.</p>\n",
        solution.interrupted ? ", interrupted" : "", content.samples, content.picture_samples);
    return text;
}

}  // namespace

std::string report_page(const ReportContent& content, const SolvedScene& solved) {
    return fmt::format(
               "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" "
               "content=\"width=device-width, initial-scale=1\">\n<title>{}</title>\n<style>{}</style>\n</head>\n"
               "<body>\n",
               html_text(content.title), page_style) +
           header(content, solved) + key_figures(content) + results(content) + glare(content) +
           "<h2>Rooms and light sources</h2>\n" + rooms(content) + lights(content) + plans(content) +
           pictures(content) + "<section>\n<h2>Surfaces</h2>\n" + surfaces(content) + method(content, solved) +
           fmt::format("</section>\n<footer>Interflect {} · solution by version {} · {}</footer>\n</body>\n</html>\n",
                       INTERFLECT_VERSION,
                       solved.interflect_version.empty() ? "unknown" : html_text(solved.interflect_version),
                       html_text(content.date));
}

}  // namespace interflect::command
