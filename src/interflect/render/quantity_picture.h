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

/// Number per element, and how to display it.
struct Quantity {
    std::string name;               ///< "irradiance". ASCII, like the unit.
    std::string unit;               ///< "lm/m^2"; empty for a pure number.
    std::span<const float> values;  ///< One per element; only leaves are used.
    Spacing spacing = Spacing::logarithmic;

    /// Label in a legend and in ImageMetadata::quantity: "irradiance [lm/m^2]".
    std::string label() const { return unit.empty() ? name : name + " [" + unit + "]"; }
};

struct QuantityPicture {
    Image values;       ///< To measure: mean over the surfaces in each pixel, in all channels; 0 without surfaces.
    Image shown;        ///< To display with a legend (legend.h): false colours; escaped rays are black.
    ColourScale scale;  ///< Fitted to the values in the picture.
    std::int64_t non_finite_pixels = 0;  ///< In either image; 8-bit files show them in magenta.
    bool interrupted = false;            ///< Stopped by the caller; the remaining pixels are 0.
};

/// Draws each leaf in the false colour of its value, without shading.
/// @param forest    Made for `scene`, like `ray_caster`.
/// @return          The same bits for the same seed and any number of threads.
/// @throws InputError as render() does.
QuantityPicture render_quantity(const Scene& scene, const ElementForest& forest, const RayCaster& ray_caster,
                                const View& view, const Quantity& quantity, const CameraSampling& sampling,
                                const Monitor& monitor = {});

}  // namespace interflect::detail
