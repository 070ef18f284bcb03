#pragma once

#include <CLI/CLI.hpp>
#include <vector>

#include "interflect/base/files/pending_file.h"
#include "interflect/measure.h"

namespace interflect::command {

/// Ratings of the observers reached: of a grid, in several directions at each point, or of a seat.
struct RatedGrid {
    MeasuringGrid grid;
    std::vector<Observer> observers;
    std::vector<GlareRating> ratings;
    std::size_t missing = 0;  ///< Ratings that were not reached.
    bool is_seat = false;     ///< The first rating belongs to the seat's own line of sight.

    /// Returns the index of the largest of at least one rating.
    std::size_t worst() const;
    /// Returns the index of the rating to report: a seat's own, or worst().
    std::size_t reported() const { return is_seat ? 0 : worst(); }
};

/// Observers of glare.
struct GlarePlaces {
    std::vector<MeasuringGrid> grids;
    std::vector<Observer> seats;
    std::vector<V3f> directions;  ///< Lines of sight at each point, and for the worst direction of each seat.
};

/// Returns the directions both ways along x and y.
std::vector<V3f> usual_directions();

/// Adds `--seat` to a command.
void add_seats(CLI::App& app, std::vector<Observer>& seats);

/// Rates all places with a progress bar. Warns about sources outside the range of UGR.
/// @param solution  The solution, as in rate_glare().
/// @throws Stopped if no observer was reached.
std::vector<RatedGrid> rate_places(const Scene& scene, const Solution* solution, const RayCaster& ray_caster,
                                   const GlarePlaces& places, const MeasuringOptions& options);

void write_ratings(detail::PendingFile& output, const std::vector<RatedGrid>& grids);

/// Prints the worst rating of each grid, the rating of each seat, and their sources.
void print_ratings(const std::vector<RatedGrid>& grids, bool json);

}  // namespace interflect::command
