#pragma once

#include <optional>

#include "interflect/denoise.h"
#include "interflect/render.h"

namespace interflect::command {

/// Time since the process began [s].
double seconds_of_process();

/// Predicted duration of drawing a picture [s].
struct DrawingTime {
    double least = 0;      ///< Time with least_samples per pixel.
    double finishing = 0;  ///< Time of filtering noise and writing.
    int reduction = 1;     ///< Above 1, of preview(): PreviewOptions::reduction.

    static constexpr int least_samples = 2;
    double total() const { return least + finishing; }
    /// Returns the even number of samples that every pixel of hybrid shading can get within a time [s]: two to eight.
    int samples_within(double seconds) const;
};

/// Predicts the time of a picture from a smaller one. Within 25% for hybrid shading of 960 x 540 pixels in three
/// offices and a corridor.
/// @param options  Options of the full picture.
/// @param limit    Maximum time [s]. If hybrid shading exceeds it, the prediction is for a preview with the smallest
///                 reduction within the limit, at most largest_reduction.
DrawingTime predict_time_of_paths(const Scene& scene, const Solution& solution, const RayCaster& ray_caster,
                                  const View& view, const PictureOptions& options, std::optional<Denoiser> denoiser,
                                  double limit);
constexpr int largest_reduction = 4;
/// Predicts the time of flat or smooth shading from a smaller picture.
DrawingTime predict_time_of_elements(const Scene& scene, const Solution& solution, const RayCaster& ray_caster,
                                     const View& view, const PictureOptions& options);

/// Drawing takes at most this share of the time that is left.
constexpr double largest_drawing_share = 0.9;

/// Returns the part of `left` [s] that is reserved for drawing: the predicted time, at most largest_drawing_share. If
/// more samples refine the picture, it is at least three quarters, as in the default run of an office.
double reserved_for(const DrawingTime& predicted, bool is_refined, double left);

}  // namespace interflect::command
