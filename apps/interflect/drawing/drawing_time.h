#pragma once

#include <optional>

#include "interflect/denoise.h"
#include "interflect/ray_caster.h"
#include "interflect/render.h"
#include "interflect/scene.h"
#include "interflect/solution.h"

namespace interflect::command {

/// Time since the process began [s].
double seconds_of_process();

/// Predicted duration of a picture.
struct DrawingTime {
    static constexpr int min_samples = 2;  ///< Every pixel drawn by paths has at least this number of samples.

    double drawing = 0;    ///< Time with min_samples per pixel if paths are traced [s].
    double finishing = 0;  ///< Time of filtering noise and writing [s].
    double reduction = 1;  ///< Above 1, the picture is a preview() with this PreviewOptions::reduction.

    double total() const { return drawing + finishing; }
    /// Returns the number of samples that hybrid shading can take in every pixel within a time [s]: 2, 4, 6 or 8.
    int samples_within(double seconds) const;
};

/// Largest PreviewOptions::reduction of a predicted preview.
constexpr double largest_reduction = 4;

/// Predicts the time of a picture drawn by paths from the time of a smaller one. The error of the prediction was at
/// most 25% for hybrid shading of 960 x 540 pixels in three offices and a corridor.
///
/// If hybrid shading takes longer than the limit, a preview is predicted. It has the smallest reduction that is within
/// the limit, or largest_reduction.
/// @param options   Options of the full picture.
/// @param denoiser  Filter of the full picture; empty: none.
/// @param limit     Maximum time [s].
DrawingTime predict_time_of_paths(const Scene& scene, const Solution& solution, const RayCaster& ray_caster,
                                  const View& view, const PictureOptions& options, std::optional<Denoiser> denoiser,
                                  double limit);

/// Predicts the time of flat or smooth shading from the time of a smaller picture.
DrawingTime predict_time_of_elements(const Scene& scene, const Solution& solution, const RayCaster& ray_caster,
                                     const View& view, const PictureOptions& options);

/// Maximum share of the remaining time for drawing.
constexpr double largest_drawing_share = 0.9;

/// Returns the part of the remaining time that is reserved for drawing [s]: the predicted time, at most
/// largest_drawing_share.
/// @param takes_more_samples  Whether the picture takes more samples than predicted while time is left. It then
/// receives
///                            at least three quarters of the remaining time, its share of a run of an office without
///                            --time.
/// @param left                Remaining time [s].
double reserved_for(const DrawingTime& predicted, bool takes_more_samples, double left);

}  // namespace interflect::command
