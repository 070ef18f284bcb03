#pragma once

#include <cstddef>
#include <vector>

#include "interflect/ranks.h"
#include "interflect/render.h"
#include "interflect/render/rays/path_plan.h"

namespace interflect::detail {

/// A call of rank 0 for light of the common scene and solution, which the other ranks repeat in share_light().
struct LightOrder {
    enum class Kind {
        picture,          ///< trace_picture()
        instant_picture,  ///< trace_instant_picture()
        gauges,           ///< hybrid_irradiance()
        direct_gauges,    ///< direct_irradiance()
        group,            ///< share_light() with light_of_group().
        end,              ///< Ends share_light().
    };
    Kind kind = Kind::end;
    PictureOptions options{};         ///< Options of the paths.
    bool is_known = false;            ///< Whether paths end at the solution.
    bool is_interpolated = false;     ///< Value of KnownIrradiance::is_interpolated.
    bool has_direct_sunlight = true;  ///< Value of PathPlan::has_direct_sunlight.
    std::size_t group = 0;            ///< Index of the light group, for Kind::group.
};

/// Sends an order from rank 0 to the other ranks. On other ranks, or without `ranks`, it has no effect.
/// @param start  Start of the paths.
void give_order(Ranks* ranks, LightOrder order, const PathStart& start = {});

struct ReceivedOrder {
    LightOrder order;
    PathStart start;            // refers to `gauges`
    std::vector<Gauge> gauges;  // gauges at measuring points, texels or vertices
};

/// Waits for an order of rank 0. Called in the other ranks.
ReceivedOrder receive_order(Ranks& ranks);

}  // namespace interflect::detail
