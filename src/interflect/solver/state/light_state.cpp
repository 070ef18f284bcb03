#include "interflect/solver/state/light_state.h"

#include <algorithm>
#include <cstddef>

#include "interflect/base/memory/address_space.h"
#include "interflect/base/threads/parallel.h"
#include "interflect/solver/deposit/contributions.h"

namespace interflect::detail {

namespace {

/// Returns the capacity of the forest. It exceeds max_elements by the new elements of one or two seconds, because a
/// step may create more elements than it keeps. It takes at most half of the free address space.
std::size_t forest_capacity(const Scene& scene, const SolveOptions& options) {
    constexpr std::size_t largest = 0xfffffff0u, excess = std::size_t{1} << 26;
    const std::size_t groups = std::min(scene.light_groups.size() + 1, max_light_groups);
    const std::size_t per_element = ElementForest::reserved_per_element +
                                    ContributionSums::reserved_per_element(scene.light_groups.empty() ? 0 : groups);
    if (!options.method.refines) return scene.patches.size();
    if (!options.method.is_stochastic) return options.refinement.max_elements;  // these methods never exceed it
    const std::size_t fitting = free_address_space() / 2 / per_element;
    return std::min(largest, options.refinement.max_elements +
                                 std::min(excess, fitting - std::min(fitting, options.refinement.max_elements)));
}

/// Returns the power of the sources [lm or W]. It is summed over patches, so it does not depend on their elements, and
/// a resumed run, whose elements exist from the beginning, has the same bits.
RgbD emitted_power(const RunInputs& inputs, const ElementForest& forest) {
    const auto of_patches = [&](std::size_t begin, std::size_t end) {
        RgbD sum(0);
        for (PatchIndex patch(begin); patch < end; ++patch)
            sum += RgbD(inputs.materials.exitance(patch)) * static_cast<double>(forest.area(patch));
        return sum;
    };
    return parallel_sum(forest.patch_count(), elements_per_task, RgbD(0), of_patches) + inputs.emission.total_power();
}

V3f centre_of(const ElementForest& forest, ElementIndex element) {
    const PatchGeometry& geometry = forest.geometry(forest.patch(element));
    return geometry.point(forest.cell(element).centre(geometry.is_triangle()));
}

}  // namespace

LightState::LightState(const RunInputs& inputs, const SolveOptions& options)
    : forest(std::make_shared<ElementForest>(inputs.scene, forest_capacity(inputs.scene, options))),
      history(forest->patch_count()),
      noise(inputs.scene.patches.size()) {
    solution.forest = forest;
    solution.options = options;
    solution.irradiance.assign(forest->size(), Rgb(0, 0, 0));
    solution.groups.assign(inputs.groups.size(), solution.irradiance);
    solution.group_names = inputs.groups.names;
    solution.dimming.assign(inputs.groups.size(), 1);
    solution.emitted_power = emitted_power(inputs, *forest);
}

void set_sources(RunInputs& inputs, LightState& light, const Scene& lit) {
    inputs.lit = &lit;
    inputs.materials = Materials(lit, inputs.ray_caster);
    inputs.materials.grow(*light.forest);
    inputs.emission = Emission(lit, inputs.targets);
    light.solution.emitted_power = emitted_power(inputs, *light.forest);
}

GroupRadiosity group_radiosity(const RunInputs& inputs, const LightState& light, const GroupLight& irradiance,
                               bool emits) {
    if (inputs.groups.empty()) return {};
    return {&inputs.groups, &irradiance, &light.solution.dimming, emits};
}

RgbD radiated_power(const RunInputs& inputs, const LightState& light) {
    return radiated_power(*light.forest, Radiosity(inputs.materials, light.solution.irradiance)) +
           inputs.emission.total_power();
}

bool refines_by_variance(const SolveOptions& o) {
    return o.method.refines && o.method.follows_variance && !o.experimental.one_bounce &&
           o.refinement.criterion != RefinementCriterion::power;
}

float min_area(const RunInputs& inputs, const LightState& light, ElementIndex element) {
    const PatchIndex patch = light.forest->patch(element);
    const std::vector<float>& view_importance = light.solution.view_importance;
    const bool is_seen = !view_importance.empty() && view_importance[patch] > 0;
    return inputs.element_floor.min_area(centre_of(*light.forest, element), light.forest->geometry(patch).normal(),
                                         is_seen);
}

float pixel_area(const RunInputs& inputs, const LightState& light, ElementIndex element) {
    const V3f normal = light.forest->geometry(light.forest->patch(element)).normal();
    return inputs.element_floor.pixel_area(centre_of(*light.forest, element), normal);
}

}  // namespace interflect::detail
