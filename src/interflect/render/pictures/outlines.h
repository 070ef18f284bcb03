#pragma once

#include "interflect/elements/forest.h"
#include "interflect/image.h"
#include "interflect/ray_caster.h"
#include "interflect/render/pictures/camera_samples.h"
#include "interflect/scene.h"

namespace interflect::detail {

struct OutlineOptions {
    float width = 1;             ///< Width of a line [pixels], > 0.
    float opacity = 0.6f;        ///< In [0, 1].
    Rgb colour{1, 0.35f, 0.0f};  ///< Linear Rec. 709.
};

/// Draws borders and silhouettes of visible leaves.
/// @param picture  Tone-mapped picture in linear Rec. 709, in [0, 1].
/// @param samples  Number of samples per pixel, >= 1.
/// @throws InputError as render() does, and for options out of range.
Image draw_outlines(const Image& picture, const Scene& scene, const ElementForest& forest, const RayCaster& ray_caster,
                    const View& view, int samples, std::uint64_t seed, const OutlineOptions& options = {},
                    const Monitor& monitor = {});

}  // namespace interflect::detail
