#include "apps/interflect/measure/probe_glare.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <utility>

#include "apps/interflect/console/messages.h"
#include "apps/interflect/console/path_progress.h"
#include "apps/interflect/console/print_views.h"
#include "apps/interflect/measure/measured_grid.h"
#include "apps/interflect/measure/measuring_places.h"
#include "apps/interflect/processes/signals.h"
#include "apps/interflect/values/csv_file.h"
#include "apps/interflect/values/parse.h"
#include "interflect/core.h"
#include "interflect/exports/records/json_text.h"

namespace interflect::command {

using namespace detail;

namespace {

void warn_of_sources_without_area(const Scene& scene) {
    const auto has_no_area = [](const Luminaire& l) {
        if (const auto* light = std::get_if<MeasuredLight>(&l.kind)) return light->web->opening.is_point();
        return std::holds_alternative<PointLight>(l.kind) || std::holds_alternative<SpotLight>(l.kind);
    };
    const auto count = std::count_if(scene.luminaires.begin(), scene.luminaires.end(), has_no_area);
    if (count > 0) spdlog::warn("{} light sources have no luminous area: their glare is left out", count);
}

/// CIE 117 rates sources of 0.0003 to 0.1 sr.
void warn_of_large_sources(const std::vector<RatedGrid>& grids) {
    constexpr double largest = 0.1;  // [sr]
    const GlareSource* found = nullptr;
    for (const RatedGrid& grid : grids)
        for (const GlareRating& rating : grid.ratings)
            for (const GlareSource& source : rating.sources)
                if (source.is_rated && source.solid_angle > (found ? found->solid_angle : largest)) found = &source;
    if (found)
        spdlog::warn("'{}' fills up to {:.2g} sr: UGR is made for sources of 0.0003 to {} sr (CIE 117)", found->name,
                     found->solid_angle, largest);
}

/// Returns null for an infinite rating, because JSON has no infinity.
Json number_or_null(double rating) { return std::isfinite(rating) ? Json(rating) : Json(nullptr); }

Json to_json(const RatedGrid& g) {
    Json json{{"name", g.grid.name}, {"quantity", "UGR"}, {"points", g.observers.size()}, {"missing", g.missing}};
    if (g.ratings.empty()) return json;
    const GlareRating& rating = g.ratings[g.reported()];
    Json sources = Json::array();
    for (const GlareSource& s : rating.sources)
        sources.push_back({{"name", s.name},
                           {"luminance", s.luminance},
                           {"solid_angle", s.solid_angle},
                           {"position_index", s.position_index},
                           {"glare", s.glare},
                           {"rated", s.is_rated}});
    const Observer& observer = g.observers[g.reported()];
    json.update({{g.is_seat ? "ugr" : "max", number_or_null(rating.ugr)},
                 {"standard_error", number_or_null(rating.standard_error)},
                 {"background_luminance", rating.background_luminance},
                 {"eye", json_of(observer.eye)},
                 {"direction", json_of(observer.line_of_sight)},
                 {"sources", sources}});
    if (g.is_seat)
        json["worst_direction"] = {{"ugr", number_or_null(g.ratings[g.worst()].ugr)},
                                   {"direction", json_of(g.observers[g.worst()].line_of_sight)}};
    return json;
}

void print_source(const char* heading, const GlareSource& s) {
    print_line("  {:17} {}: {:.4g} cd/m2, {:.3g} sr, position index {:.3g}", heading, s.name, s.luminance,
               s.solid_angle, s.position_index);
}

void print_text(const RatedGrid& g) {
    print_line("{}: {}, {} ratings", g.grid.name, text_of(g.grid), g.ratings.size());
    if (g.missing > 0) print_line("  interrupted       {} ratings are missing", g.missing);
    if (g.ratings.empty()) return;
    const GlareRating& rating = g.ratings[g.reported()];
    const Observer& observer = g.observers[g.reported()];
    if (std::isfinite(rating.ugr))
        print_line("  {:17} {:.1f}, standard error {:.2g}", g.is_seat ? "UGR" : "largest UGR", rating.ugr,
                   rating.standard_error);
    else
        print_line("  UGR               no source is seen that CIE 117 rates");
    print_line("  observer          at {}, looking {}", text_of(observer.eye), text_of(observer.line_of_sight));
    if (g.is_seat && g.worst() != g.reported())
        print_line("  worst direction   {:.1f}, looking {}", g.ratings[g.worst()].ugr,
                   text_of(g.observers[g.worst()].line_of_sight));
    print_line("  background        {:.3g} cd/m2", rating.background_luminance);
    constexpr std::size_t max_reported = 5;
    for (std::size_t i = 0; i < std::min(rating.sources.size(), max_reported); ++i)
        print_source(rating.sources[i].is_rated ? "source" : "not rated", rating.sources[i]);
    const auto excluded =
        std::count_if(rating.sources.begin(), rating.sources.end(), [](const GlareSource& s) { return !s.is_rated; });
    if (excluded > 0)
        print_line("  {} of {} sources are not rated: they lie outside of the table of CIE 117 (H/R > 1.9 or T/R > 3)",
                   excluded, rating.sources.size());
}

/// Returns places without ratings.
std::vector<RatedGrid> unrated(const GlarePlaces& places) {
    std::vector<RatedGrid> result;
    for (const MeasuringGrid& grid : places.grids) {
        RatedGrid& rated = result.emplace_back();
        rated.grid = grid;
        for (const Imath::V3d& eye : grid.points)
            for (const V3f& direction : places.directions) rated.observers.push_back({eye, direction});
    }
    for (const Observer& seat : places.seats) {
        RatedGrid& rated = result.emplace_back();
        rated.is_seat = true;
        rated.grid.name = fmt::format("seat {}", result.size() - places.grids.size());
        rated.grid.points = {seat.eye};
        rated.observers = {seat};
        for (const V3f& direction : places.directions)
            if (direction.normalized() != seat.line_of_sight.normalized())
                rated.observers.push_back({seat.eye, direction});
    }
    return result;
}

}  // namespace

std::size_t RatedGrid::worst() const {
    const auto less = [](const GlareRating& a, const GlareRating& b) { return a.ugr < b.ugr; };
    return static_cast<std::size_t>(std::max_element(ratings.begin(), ratings.end(), less) - ratings.begin());
}

std::vector<V3f> usual_directions() { return {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}}; }

void add_seats(CLI::App& app, std::vector<Observer>& seats) {
    add_each(app, "--seat", seats, parse_observer,
             "An observer of glare: the eye [m] and the way that it looks; may be repeated")
        ->type_name("X,Y,Z:X,Y,Z");
}

std::vector<RatedGrid> rate_places(const Scene& scene, const Solution* solution, const RayCaster& ray_caster,
                                   const GlarePlaces& places, const MeasuringOptions& options) {
    warn_of_sources_without_area(scene);
    std::vector<RatedGrid> result = unrated(places);
    std::vector<Observer> observers;
    std::vector<MeasuringPoint> eyes;
    for (const RatedGrid& grid : result) {
        observers.insert(observers.end(), grid.observers.begin(), grid.observers.end());
        for (const Imath::V3d& eye : grid.grid.points) eyes.push_back({eye, {}, Receiver::cylindrical});
    }
    warn_of_misplaced_points(scene, ray_caster, eyes, {});
    std::vector<GlareRating> ratings;
    SharedLight shared_light(scene, solution);
    with_path_progress(shared_light, [&](const Monitor& monitor) {
        ratings = rate_glare(scene, solution, ray_caster, observers, options, monitor);
    });
    std::size_t next = 0, lost = 0;
    for (RatedGrid& rated : result) {
        const std::vector<Observer> asked = std::exchange(rated.observers, {});
        for (const Observer& observer : asked) {
            GlareRating& rating = ratings[next++];
            const bool is_rated = std::isfinite(rating.standard_error);
            if (!is_rated || (rated.is_seat && rated.missing > 0)) {
                ++rated.missing;
                continue;
            }
            rated.observers.push_back(observer);
            rated.ratings.push_back(std::move(rating));
        }
        lost += rated.missing;
    }
    if (lost > 0 && lost == observers.size()) throw Stopped("stopped before any observer's glare was rated");
    if (lost > 0) spdlog::warn("{} of {} ratings were not found before the end", lost, observers.size());
    warn_of_large_sources(result);
    return result;
}

void write_ratings(PendingFile& output, const std::vector<RatedGrid>& grids) {
    CsvFile file(output, "x [m],y [m],z [m],direction x,direction y,direction z,UGR,standard error,Lb [cd/m^2],area");
    for (const RatedGrid& g : grids)
        for (std::size_t i = 0; i < g.ratings.size(); ++i) {
            const auto& [eye, sight] = g.observers[i];
            const GlareRating& r = g.ratings[i];
            file.add_line(fmt::format("{:.10g},{:.10g},{:.10g},{:.6g},{:.6g},{:.6g},{:.5g},{:.3g},{:.5g},{}", eye.x,
                                      eye.y, eye.z, sight.x, sight.y, sight.z, r.ugr, r.standard_error,
                                      r.background_luminance, csv_field(g.grid.name)));
        }
    file.commit();
}

void print_ratings(const std::vector<RatedGrid>& grids, bool json) {
    Json areas = Json::array();
    for (const RatedGrid& grid : grids) {
        if (json)
            areas.push_back(to_json(grid));
        else
            print_text(grid);
    }
    if (json) std::cout << json_text({{"interrupted", is_stop_requested()}, {"areas", areas}}, 2) << '\n';
}

}  // namespace interflect::command
