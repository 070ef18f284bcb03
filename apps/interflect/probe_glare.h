#pragma once

#include <span>
#include <vector>

#include "interflect/base/pending_file.h"
#include "interflect/measure.h"

namespace interflect::command {

/// Ratings at the points of a grid, in several directions, without those not reached.
struct RatedGrid {
    MeasuringGrid grid;
    std::vector<Observer> observers;
    std::vector<GlareRating> ratings;
    std::size_t missing = 0;  ///< Ratings that were not reached.

    /// Returns the index of the largest of at least one rating.
    std::size_t worst() const;
};

/// Rates all grids with a progress bar. Warns about sources outside the range of UGR.
/// @param solution  As in rate_glare().
/// @throws Stopped if no observer was reached.
std::vector<RatedGrid> rate_grids(const Scene& scene, const Solution* solution, const RayCaster& ray_caster,
                                  const std::vector<MeasuringGrid>& grids, std::span<const V3f> directions,
                                  const MeasuringOptions& options);

void write_ratings(detail::PendingFile& output, const std::vector<RatedGrid>& grids);

/// Prints the worst rating of each grid and its sources.
void print_ratings(const std::vector<RatedGrid>& grids, bool json);

}  // namespace interflect::command
