#include "interflect/solution.h"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "interflect/core.h"
#include "interflect/elements/dimmed_irradiance.h"
#include "interflect/solver/light/group_light.h"
#include "interflect/solver/light/materials.h"
#include "interflect/solver/light/patch_light.h"

namespace interflect {

using namespace detail;

void dim(Scene& scene, Solution& solution, const std::string& group, float factor) {
    SourceGroups groups = source_groups(scene);
    // source_groups() omits a group "other" that is dimmed to 0.
    if (!groups.empty()) groups.names = solution.group_names;
    const std::size_t g = groups.index_of(group);
    if (!(factor >= 0 && std::isfinite(factor)))
        throw InputError(fmt::format("light group '{}': expected a factor of 0 or more, not {}", group, factor));
    std::vector<float> factors(groups.size(), 1);
    factors[g] = factor;
    if (solution.undimmed_light.empty()) solution.undimmed_light = patch_light(scene, solution.irradiance);
    scene = dimmed(scene, groups, factors);
    for (Rgb& h : solution.groups[g]) h *= factor;
    if (!solution.direct.empty())
        for (Rgb& h : solution.direct[g]) h *= factor;
    replace_irradiance(solution, sum_of(solution.groups));
}

}  // namespace interflect
