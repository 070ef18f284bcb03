#pragma once

#include <span>
#include <string>

#include "interflect/elements/forest.h"
#include "interflect/image.h"
#include "interflect/image/false_colour.h"
#include "interflect/ray_caster.h"
#include "interflect/render/camera_samples.h"
#include "interflect/scene.h"

namespace interflect::detail {

struct Quantity {
    std::string name;               ///< "irradiance"; ASCII, like the unit.
    std::string unit;               ///< "lm/m^2"; empty for pure numbers.
    std::span<const float> values;  ///< One per element; only leaves are used.
    Spacing spacing = Spacing::logarithmic;

    /// Returns the label for legends and ImageMetadata::quantity: "irradiance [lm/m^2]".
    std::string label() const { return unit.empty() ? name : name + " [" + unit + "]"; }
};

struct QuantityPicture {
    Image values;       ///< Mean over visible surfaces, in all channels; 0 without surfaces.
    Image shown;        ///< False colours, for display with a legend (legend.h); escaped rays are black.
    ColourScale scale;  ///< Fitted to the picture.
    std::int64_t non_finite_pixels = 0;  ///< In either image; magenta in 8-bit files.
    bool interrupted = false;            ///< If so, the remaining pixels are 0.
};

/// Draws leaves in false colours, without shading. The same seed gives the same bits.
/// @throws InputError as render() does.
QuantityPicture render_quantity(const Scene& scene, const ElementForest& forest, const RayCaster& ray_caster,
                                const View& view, const Quantity& quantity, const CameraSampling& sampling,
                                const Monitor& monitor = {});

}  // namespace interflect::detail
