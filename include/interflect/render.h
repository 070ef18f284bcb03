#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <span>

#include "interflect/image.h"
#include "interflect/ray_caster.h"
#include "interflect/scene.h"
#include "interflect/solve.h"

namespace interflect::inline detail {
class ElementForest;
}  // namespace interflect::inline detail

namespace interflect {

/// What counts as one smooth surface.
struct SmoothingOptions {
    /// Patches whose normals differ by more than this do not shade into each other [degrees]. The default is wider than
    /// the 22.5 degrees between the facets of a sphere or cylinder that a reader has tessellated.
    float crease_angle = 30;
};

/// Progress of a picture.
struct PictureProgress {
    std::int64_t rays = 0;  ///< So far.
    double fraction = 0;    ///< Of all rays, in [0, 1].
};

/// How a caller watches the progress of a picture, and ends it early.
struct PictureMonitor {
    /// Called from the calling thread, about every million rays; may be empty.
    std::function<void(const PictureProgress&)> on_progress;
    const std::atomic<bool>* stop = nullptr;  ///< Once true, what is under way is left in milliseconds.
};

/// How irradiance is reconstructed at points from that of elements.
enum class Shading {
    flat,    ///< Every leaf has one irradiance.
    smooth,  ///< Interpolated between the leaves of a smooth surface: see SmoothField.
};

struct RenderOptions {
    int width = 1280;                   ///< [pixels], >= 1.
    int height = 720;                   ///< [pixels], >= 1.
    int samples = 16;                   ///< Camera rays a pixel, >= 1; powers of two are stratified best.
    Shading shading = Shading::smooth;  ///< See Shading.
    bool irradiance = false;            ///< Draw H [lux, or W/m^2] in place of L, whatever the surfaces reflect.
    SmoothingOptions smoothing{};       ///< For Shading::smooth.
    std::uint64_t seed = 1;             ///< Of the rays' places within their pixels.
};

/// A picture with counts of its rays.
struct Rendering {
    /// Radiance L = (M + rho H) / pi of what each pixel sees, the mean over its square; where rays escape, the sky.
    /// [cd/m^2] where exitance M and irradiance H are photometric [lm/m^2], else [W/(m^2 sr)]. With
    /// RenderOptions::irradiance H, and 0 where rays escape.
    Image image;
    std::int64_t rays = 0;
    std::int64_t escaped_rays = 0;
    std::int64_t non_finite_pixels = 0;  ///< They keep their value (infinite or not a number) in `image`.
    bool interrupted = false;            ///< Stopped by the caller: pixels that were not reached are black.
};

/// Renders what `view` sees of a solved scene.
/// @param forest      Of the same scene, as is `ray_caster`.
/// @param irradiance  H of every element, in the unit of the materials' exitance; only those of leaves count.
/// @return            The same bits for the same seed and any number of threads.
/// @throws InputError for a view that defines no picture, an option out of range, sizes that disagree, and a forest or
///         a ray caster of another scene.
Rendering render(const Scene& scene, const ElementForest& forest, const RayCaster& ray_caster, const View& view,
                 std::span<const Rgb> irradiance, const RenderOptions& options = {},
                 const PictureMonitor& monitor = {});
/// The same of a solution of the scene.
Rendering render(const Scene& scene, const Solution& solution, const RayCaster& ray_caster, const View& view,
                 const RenderOptions& options = {}, const PictureMonitor& monitor = {});

}  // namespace interflect
