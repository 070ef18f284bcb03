#pragma once

#include <CLI/CLI.hpp>

#include "interflect/render/camera_samples.h"
#include "interflect/render/quantity_picture.h"
#include "interflect/solution_file.h"

namespace interflect::command {

/// What a picture shows.
enum class Shown {
    light,              ///< What the camera sees.
    mesh,               ///< The same, with the borders of the elements.
    irradiance,         ///< H, luminance of.
    importance,         ///< psi.
    direct_importance,  ///< v, the part of psi straight from the camera.
    level,              ///< How often a patch was divided to get to the leaf.
    rays,               ///< That started on a leaf, per area.
    error,              ///< Estimated standard error of H, relative.
};

/// Adds --show.
void add_show(CLI::App& app, Shown& shown);

/// Whether it is a number that each element has, to be drawn in false colours.
constexpr bool is_quantity(Shown shown) { return shown != Shown::light && shown != Shown::mesh; }

/// A picture of such a number. @throws InputError where the solution does not have it.
QuantityPicture show_quantity(Shown shown, const SolvedScene& solved, const RayCaster& ray_caster, const View& view,
                              const CameraSampling& sampling, const PictureMonitor& monitor);

/// Its name and unit, for the metadata of a picture.
std::string label_of(Shown shown);

}  // namespace interflect::command
