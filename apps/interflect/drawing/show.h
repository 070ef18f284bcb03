#pragma once

#include <CLI/CLI.hpp>

#include "interflect/render.h"
#include "interflect/solution.h"

namespace interflect::command {

enum class Shown {
    light,              ///< Radiance that the camera sees.
    mesh,               ///< Radiance with the borders of elements.
    irradiance,         ///< Luminance of H.
    importance,         ///< psi.
    direct_importance,  ///< v, the part of psi directly from the camera.
    level,              ///< Subdivision level of the leaf.
    rays,               ///< Rays started on the leaf, per area.
    error,              ///< Relative standard error of H.
};

void add_show(CLI::App& app, Shown& shown);

/// Returns whether `shown` is a number per element, drawn in false colours.
constexpr bool is_quantity(Shown shown) { return shown != Shown::light && shown != Shown::mesh; }

/// @throws InputError if the solution lacks the quantity.
QuantityPicture show_quantity(Shown shown, const SolvedScene& solved, const RayCaster& ray_caster, const View& view,
                              const PictureOptions& options, const Monitor& monitor);

/// Returns name and unit for metadata.
std::string label_of(Shown shown);

}  // namespace interflect::command
