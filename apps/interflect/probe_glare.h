#pragma once

#include <span>
#include <vector>

#include "interflect/base/pending_file.h"
#include "interflect/glare.h"
#include "interflect/measuring_grid.h"

namespace interflect::command {

/// Ratings of observers at the points of a grid, who look in several directions; of those that were reached.
struct RatedGrid {
    MeasuringGrid grid;
    std::vector<Observer> observers;
    std::vector<GlareRating> ratings;
    std::size_t missing = 0;  ///< Ratings that were not reached.

    /// Index of the largest rating; there is one.
    std::size_t worst() const;
};

/// Rates what is seen from all grids, with a progress bar, and warns of sources that UGR is not made for.
/// @param solution  As in rate_glare().
/// @throws Stopped if no observer was reached.
std::vector<RatedGrid> rate_grids(const Scene& scene, const Solution* solution, const RayCaster& ray_caster,
                                  const std::vector<MeasuringGrid>& grids, std::span<const V3f> directions,
                                  const PathOptions& options);

/// A table of all ratings.
void write_ratings(PendingFile& output, const std::vector<RatedGrid>& grids);

/// A summary to stdout: the worst rating of each grid and what causes it.
void print_ratings(const std::vector<RatedGrid>& grids, bool json);

}  // namespace interflect::command
