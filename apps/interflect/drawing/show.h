#pragma once

#include <CLI/CLI.hpp>

#include "interflect/render.h"
#include "interflect/solution.h"

namespace interflect::command {

/// Quantity that --show draws.
enum class Shown {
    light,              ///< Radiance that the camera sees.
    mesh,               ///< Radiance with the borders of elements.
    irradiance,         ///< Luminance of the irradiance H.
    importance,         ///< Importance psi.
    direct_importance,  ///< Importance v directly from the cameras, a part of psi.
    level,              ///< Number of divisions of the patch.
    rays,               ///< Number of rays started on the leaf, per area.
    error,              ///< Relative standard error of the irradiance.
};

/// Adds the option --show.
void add_show(CLI::App& app, Shown& shown);

/// Whether the picture shows a number of each element, in false colours.
constexpr bool is_quantity(Shown shown) { return shown != Shown::light && shown != Shown::mesh; }

/// Draws a quantity of the elements. @throws InputError if the solution lacks it.
QuantityPicture show_quantity(Shown shown, const SolvedScene& solved, const RayCaster& ray_caster, const View& view,
                              const PictureOptions& options, const Monitor& monitor);

/// Returns the name and unit of a quantity.
std::string label_of(Shown shown);

}  // namespace interflect::command
