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

/// Criterion for smooth surfaces.
struct SmoothingOptions {
    /// Maximum angle between the normals of patches with common shading [degrees]. The default exceeds the 22.5 degrees
    /// between the facets of a sphere or cylinder tessellated by a reader.
    float crease_angle = 30;
};

/// Progress of a picture.
struct PictureProgress {
    std::int64_t rays = 0;  ///< So far.
    double fraction = 0;    ///< Fraction of all rays, in [0, 1].
};

/// Progress reports and early termination of a picture.
struct PictureMonitor {
    /// Called on the calling thread, about every million rays; may be empty.
    std::function<void(const PictureProgress&)> on_progress;
    const std::atomic<bool>* stop = nullptr;  ///< Once true, the work ends within milliseconds.
};

/// Reconstruction of irradiance at points from elements.
enum class Shading {
    flat,    ///< Constant on each leaf.
    smooth,  ///< Interpolated between the leaves of a smooth surface: see SmoothField.
};

struct RenderOptions {
    int width = 1280;  ///< [pixels], >= 1.
    int height = 720;  ///< [pixels], >= 1.
    int samples = 16;  ///< Camera rays per pixel, >= 1; powers of two are stratified best.
    Shading shading = Shading::smooth;
    bool irradiance = false;       ///< Shows H [lux, or W/m^2] instead of L, independent of reflectance.
    SmoothingOptions smoothing{};  ///< For Shading::smooth.
    std::uint64_t seed = 1;        ///< Seed of the ray positions within pixels.
};

/// A picture with counts of its rays.
struct Rendering {
    /// Radiance L = (M + rho H) / pi seen by each pixel, the mean over its square; the sky for escaped rays. [cd/m^2]
    /// if exitance M and irradiance H are photometric [lm/m^2], else [W/(m^2 sr)]. With RenderOptions::irradiance: H,
    /// and 0 for escaped rays.
    Image image;
    std::int64_t rays = 0;
    std::int64_t escaped_rays = 0;
    std::int64_t non_finite_pixels = 0;  ///< Number of pixels with an infinite or NaN value, which `image` keeps.
    bool interrupted = false;            ///< Stopped by the caller; pixels that were not reached are black.
};

/// Renders a view of a solved scene.
/// @param forest      Of the same scene, as is `ray_caster`.
/// @param irradiance  H of every element, in the unit of the materials' exitance; only leaves are used.
/// @return            The same bits for the same seed and any number of threads.
/// @throws InputError for a view that defines no picture, an option out of range, inconsistent sizes, and a forest or a
///         ray caster of another scene.
Rendering render(const Scene& scene, const ElementForest& forest, const RayCaster& ray_caster, const View& view,
                 std::span<const Rgb> irradiance, const RenderOptions& options = {},
                 const PictureMonitor& monitor = {});
/// The same for a solution of the scene.
Rendering render(const Scene& scene, const Solution& solution, const RayCaster& ray_caster, const View& view,
                 const RenderOptions& options = {}, const PictureMonitor& monitor = {});

}  // namespace interflect
