#pragma once

#include <cstdint>
#include <vector>

#include <ImathBox.h>

#include "interflect/ray_caster.h"
#include "interflect/solver/state/solver_state.h"

namespace interflect::detail {

struct OutdoorLine {
    Ray light;          ///< From the surface point, in the direction of the light.
    std::uint32_t sun;  ///< Index of the sun; `none` for skies.
    double importance;  ///< Weighted power received per PartAlong::brightness.
};

/// Finds nested boxes in which weighted lines converge, such as windows.
std::vector<Imath::Box3f> find_targets(const std::vector<OutdoorLine>& lines, const std::vector<double>& weights,
                                       const Imath::Box3f& scene_box);

/// Sets targets and part importance; has no effect without full importance or outdoor light.
/// @return  Lines of outdoor light to important surfaces.
std::vector<OutdoorLine> aim_outdoor_light(SolverState& state);

}  // namespace interflect::detail
