#pragma once

#include <span>
#include <string>

#include "interflect/elements/forest.h"
#include "interflect/image.h"
#include "interflect/plots.h"
#include "interflect/ray_caster.h"
#include "interflect/render/pictures/camera_samples.h"
#include "interflect/scene.h"

namespace interflect::detail {

struct Quantity {
    std::string name;               ///< ASCII, as is `unit`.
    std::string unit;               ///< Such as "lm/m^2"; empty for pure numbers.
    std::span<const float> values;  ///< One per element; only leaves are used.
    Spacing spacing = Spacing::logarithmic;

    std::string label() const { return unit.empty() ? name : name + " [" + unit + "]"; }
};

/// Draws leaves without shading.
/// @throws InputError as render() does.
QuantityPicture render_quantity(const Scene& scene, const ElementForest& forest, const RayCaster& ray_caster,
                                const View& view, const Quantity& quantity, const CameraSampling& sampling,
                                const Monitor& monitor = {});

}  // namespace interflect::detail
