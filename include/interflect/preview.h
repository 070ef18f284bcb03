/// @file
/// Pictures in a fraction of the time of a final one.
#pragma once

#include "interflect/denoise.h"
#include "interflect/image.h"
#include "interflect/ray_caster.h"
#include "interflect/render.h"
#include "interflect/scene.h"
#include "interflect/solution.h"

namespace interflect {

struct PreviewOptions {
    /// Light is traced for one in reduction x reduction pixels; at least 1, and need not be whole.
    double reduction = 4;
    Denoiser denoiser = Denoiser::automatic;  ///< Filter of this light.

    /// Returns the number of camera rays of each pixel, which find its surfaces.
    int camera_rays() const;
};

/// Draws a view quickly, for people who wait for a better picture.
///
/// A picture of fewer pixels is drawn by hybrid shading with two samples and filtered. Camera rays of every pixel then
/// find the surfaces; the irradiance of each is interpolated between pixels of the smaller picture that show the same
/// surface (joint bilateral upsampling, Kopf et al. 2007). Shadow rays of every pixel find the light of suns. So
/// outlines, textures, lamps and shadows of suns are sharp; other shadows are blurred over about `reduction` pixels, as
/// is all behind glass that also reflects. A surface that the smaller picture misses shows the light of its elements.
/// The error is not estimated.
///
/// @param options  Its size, `quantity`, `mirrors` and `seed`. @param solution  Of the same scene, as is `ray_caster`.
/// @return  Without layers and standard error. The same bits for any number of threads, unless interrupted; then parts
///          of the image may be black.
/// @throws InputError as render() and denoise() do, and for a reduction below 1.
Rendering preview(const Scene& scene, const Solution& solution, const RayCaster& ray_caster, const View& view,
                  const PictureOptions& options, const PreviewOptions& preview_options = {},
                  const Monitor& monitor = {});

}  // namespace interflect
