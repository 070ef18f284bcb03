#pragma once

#include "interflect/render.h"

namespace interflect::command {

/// Time since the process began [s].
double seconds_of_process();

/// Predicted duration of drawing a picture [s].
struct DrawingTime {
    double least = 0;      ///< For two batches of paths per pixel.
    double finishing = 0;  ///< Filtering noise and writing.

    double total() const { return least + finishing; }
};

/// Predicts the time of a picture from a smaller one. Within 20% for hybrid shading of 1280 x 720 pixels in three
/// offices and a maze.
/// @param options  Of the full picture.
DrawingTime predict_time_of_paths(const Scene& scene, const Solution& solution, const RayCaster& ray_caster,
                                  const View& view, const PictureOptions& options, bool filters);
DrawingTime predict_time_of_elements(const Scene& scene, const Solution& solution, const RayCaster& ray_caster,
                                     const View& view, const PictureOptions& options);

/// Drawing takes at most this share of the time that is left.
constexpr double largest_drawing_share = 0.8;

/// Returns the part of `left` [s] that solving leaves to drawing: half of it for paths, whose noise more samples
/// reduce, within the limits of the prediction.
double reserved_for(const DrawingTime& predicted, bool is_refined, double left);

}  // namespace interflect::command
