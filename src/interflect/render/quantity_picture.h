#pragma once

#include <span>
#include <string>

#include "interflect/elements/forest.h"
#include "interflect/image.h"
#include "interflect/image/false_colour.h"
#include "interflect/ray_caster.h"
#include "interflect/render/camera_samples.h"
#include "interflect/scene.h"

namespace interflect::inline detail {

/// A number for each element, and how it is shown.
struct Quantity {
    std::string name;               ///< ASCII, as is the unit: "irradiance".
    std::string unit;               ///< "lm/m^2"; empty for a pure number.
    std::span<const float> values;  ///< One an element; only those of leaves count.
    Spacing spacing = Spacing::logarithmic;

    /// Name and unit as a legend and ImageMetadata::quantity have them: "irradiance [lm/m^2]".
    std::string label() const { return unit.empty() ? name : name + " [" + unit + "]"; }
};

/// A picture of a quantity.
struct QuantityPicture {
    Image values;  ///< In all three channels: the mean over what a pixel sees, 0 where that is nothing. To measure.
    Image shown;   ///< In false colours, what escapes black. To look at, with a legend (legend.h).
    ColourScale scale;                   ///< Fitted to the values in the picture.
    std::int64_t non_finite_pixels = 0;  ///< Not finite in either image; files of 8 bits show them magenta.
    bool interrupted = false;            ///< Stopped by the caller: pixels that were not reached show nothing.
};

/// Draws each leaf in the false colour of its value, without shading.
/// @param forest    Of the same scene, as is `ray_caster`.
/// @return          The same bits for the same seed and any number of threads.
/// @throws InputError as render() does.
QuantityPicture render_quantity(const Scene& scene, const ElementForest& forest, const RayCaster& ray_caster,
                                const View& view, const Quantity& quantity, const CameraSampling& sampling,
                                const PictureMonitor& monitor = {});

}  // namespace interflect::inline detail
