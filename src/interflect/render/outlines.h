#pragma once

#include "interflect/elements/forest.h"
#include "interflect/image.h"
#include "interflect/ray_caster.h"
#include "interflect/render/camera_samples.h"
#include "interflect/scene.h"

namespace interflect::inline detail {

/// How the borders of leaves are drawn.
struct OutlineOptions {
    float width = 1;             ///< [pixels], > 0; lines that slant are up to 1.4 times as wide.
    float opacity = 0.6f;        ///< In [0, 1]: where leaves are smaller than pixels, the picture still shows through.
    Rgb colour{1, 0.35f, 0.0f};  ///< Linear Rec. 709: an orange that is seen on light and on dark.
};

/// Draws the borders of all leaves in sight over a picture of `view`: wherever two places closer than the lines' width
/// show different leaves. So there are lines at silhouettes as well, and none where two pieces of one leaf meet.
/// @param picture  As a display shows it (tone-mapped): linear Rec. 709 in [0, 1]. Its size is the camera's.
/// @param samples  Samples a pixel, >= 1, of three rays each.
/// @return         The same bits for the same seed and any number of threads.
/// @throws InputError as render() does, and for options out of range.
Image draw_outlines(const Image& picture, const Scene& scene, const ElementForest& forest, const RayCaster& ray_caster,
                    const View& view, int samples, std::uint64_t seed, const OutlineOptions& options = {},
                    const PictureMonitor& monitor = {});

}  // namespace interflect::inline detail
