/// @file
/// Pictures of a scene.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "interflect/image.h"
#include "interflect/plots.h"
#include "interflect/ray_caster.h"
#include "interflect/scene.h"
#include "interflect/shading.h"
#include "interflect/solution.h"

namespace interflect {

/// Quantity shown on visible surfaces.
enum class PictureQuantity {
    radiance,    ///< L = (M + rho H) / pi [cd/m^2 or W/(m^2 sr)].
    irradiance,  ///< H [lux = lm/m^2, or W/m^2], independent of reflectance.
};

/// Criterion for smooth surfaces.
struct SmoothingOptions {
    /// Maximum angle between the normals of patches with common shading [degrees]. The default exceeds the 22.5 degrees
    /// between the facets of a sphere or cylinder tessellated by a reader.
    float crease_angle = 30;
};

/// Options of render(). The options for paths have no effect unless traces_paths() holds for the shading.
struct PictureOptions {
    int width = 1280;  ///< [pixels], >= 1.
    int height = 720;  ///< [pixels], >= 1.
    Shading shading = Shading::hybrid;
    /// Number of camera rays per pixel, >= 1, or of paths, >= 2; the minimum if there is a target or a time limit.
    /// Powers of two are stratified best. 0: the number in default_samples.
    int samples = 0;
    int max_samples = default_max_samples;  ///< Maximum number of paths per pixel with a target, >= samples.
    /// Target of the picture's relative error (Rendering::relative_error), >= 0; 0: every pixel gets `samples`
    /// paths, in hybrid shading fewer where the error of its neighbours is below 6%.
    double until = 0;
    /// Maximum duration of tracing paths [s], > 0. Every pixel gets two batches, however long they take; later ones are
    /// omitted once it is over.
    double time = std::numeric_limits<double>::infinity();
    PictureQuantity quantity = PictureQuantity::radiance;
    /// Whether the camera sees mirrors (Material::specular_reflectance). Flat and smooth shading show none.
    bool mirrors = true;
    SmoothingOptions smoothing{};  ///< For Shading::smooth.
    int light_walks = 16'384;      ///< For Shading::instant: number of walks from the light sources per batch, >= 1.
    std::uint64_t seed = 1;
};

/// Reflected light of a subset of a picture's samples.
struct SampledLight {
    Image direct;    ///< Light reflected once, in the picture's unit.
    Image indirect;  ///< Light reflected more than once.
    /// Estimated variance of `direct` and `indirect`, the mean over the channels, [y * width + x].
    std::vector<float> direct_variance, indirect_variance;
};

/// Components of a picture: means over the samples of each pixel.
struct PictureLayers {
    Image emitted;  ///< Radiance straight from emitters, in the picture's unit.
    /// All other light of the picture.
    SampledLight reflected;
    bool is_indirect_interpolated = false;  ///< True for Shading::hybrid, whose indirect light has no noise to remove.
    /// Light of two independent halves of the samples.
    std::array<SampledLight, 2> halves;
    Image albedo;    ///< Reflectance of the visible surface; 1 in a picture of irradiance.
    Image normal;    ///< Normal of the visible surface, towards the camera; shorter than 1 as a mean of several.
    Image position;  ///< Position of the visible surface, relative to the scene's origin [m].
    std::vector<float> depth;  ///< Distance of the visible surface from the camera [m]; 0 without a hit.
    std::vector<float> level;  ///< Level of the visible element, from some of the samples; 0 without one.
    float pixel_angle = 0;     ///< Angle of a pixel's side at the centre of the picture [rad]; 0 if orthographic.
    float pixel_size = 0;      ///< Side of a pixel in an orthographic picture [m]; else 0.
};

/// A picture with its components, its standard error and counts of its rays.
struct Rendering {
    /// Radiance L = (M + rho H) / pi seen by each pixel, the mean over its square; the sky for escaped rays. [cd/m^2]
    /// if exitance M and irradiance H are photometric [lm/m^2], else [W/(m^2 sr)]. In a picture of irradiance: H, and 0
    /// for escaped rays. Pixels not reached by an interrupted run are black.
    Image image;
    PictureLayers layers;  ///< Empty in flat and smooth shading, as are `standard_error` and `batches`.
    /// Standard error of each pixel and channel, in the same unit, from the spread of independent samples.
    Image standard_error;
    /// Root mean square over the pixels of their relative standard errors (channel means). The error of a pixel is
    /// relative to the largest of: the mean radiance of the 48 pixels around, the mean emitted radiance of the pixel
    /// and the eight around it, and the picture's mean reflected radiance. 0 for a picture without light. Infinite if
    /// any pixel has fewer than two batches; NaN in flat and smooth shading.
    double relative_error = std::numeric_limits<double>::quiet_NaN();
    std::int64_t rays = 0;               ///< Camera rays, reflected rays and shadow rays.
    std::int64_t shadow_rays = 0;        ///< Number of shadow rays, which are included in `rays`.
    std::int64_t paths = 0;              ///< Number of paths; 0 in flat and smooth shading.
    std::vector<std::uint32_t> batches;  ///< Batches of paths of each pixel; its standard error needs two.
    std::int64_t escaped_rays = 0;       ///< Camera rays and reflected rays without a hit.
    std::int64_t non_finite_pixels = 0;  ///< Number of pixels with an infinite or NaN value, which `image` keeps.
    bool interrupted = false;            ///< Whether the caller stopped it.
};

/// Draws a view of a solved scene by any Shading.
///
/// The samples of a pixel form two independent halves. Without a target, in all shadings except hybrid, every pixel
/// gets `samples`, rounded up to whole batches. With a target, and in hybrid shading, the number of samples follows
/// from the noise of the pixels around it, not from its own, which would bias it; later rounds multiply all numbers by
/// a common factor.
///
/// @param solution  Of the same scene, as is `ray_caster`.
/// @return          The same bits for the same seed and any number of threads, unless interrupted or out of time.
/// @throws InputError for a view that defines no picture, an option out of range, and a solution or a ray caster of
///         another scene.
/// Cost: flat and smooth shading trace a ray per sample; others trace two rays per vertex of a path, and take 250 bytes
/// per patch and 760 per pixel. Paths have two vertices in gathering, and about 1 / (1 - rho) or a few more in path
/// tracing, for reflectances about rho. Instant radiosity traces three more shadow rays at the first vertex and fewer
/// bounces, and takes 0.5 to 4 kB per walk.
Rendering render(const Scene& scene, const Solution& solution, const RayCaster& ray_caster, const View& view,
                 const PictureOptions& options = {}, const Monitor& monitor = {});

/// Draws a view of a scene without a solution, by Shading::path or instant.
/// @throws InputError as above, and for a shading that needs a solution.
Rendering render(const Scene& scene, const RayCaster& ray_caster, const View& view, const PictureOptions& options,
                 const Monitor& monitor = {});

/// A quantity of the elements of a solution.
enum class ElementQuantity {
    irradiance,         ///< Luminance of H [lm/m^2 or W/m^2].
    importance,         ///< Importance psi [1/m^2].
    direct_importance,  ///< Its part v directly from the cameras [1/m^2].
    level,              ///< Number of divisions of the patch.
    rays,               ///< Number of rays started, per area [1/m^2].
    error,              ///< Relative standard error of the luminance of H.
};

/// Returns the name and unit, such as "irradiance [lm/m^2]".
std::string label(ElementQuantity quantity);

/// A picture of numbers.
struct QuantityPicture {
    Image values;  ///< Means of the quantity over visible surfaces; 0 without surfaces.
    Image shown;   ///< The values in false colours; escaped rays are black.
    ColourScale scale;
    std::int64_t non_finite_pixels = 0;  ///< Number of pixels that are infinite or NaN in either image.
    bool interrupted = false;            ///< Whether the caller stopped it; the remaining pixels are 0.
};

/// Draws a number of the visible elements, without shading, in false colours. The scale is fitted to the visible
/// values, and logarithmic except for levels.
/// @param options  Its size, `samples` >= 1 and `seed`.
/// @throws InputError as render() does, and for importance of a solution without views.
QuantityPicture draw_quantity(const Scene& scene, const Solution& solution, const RayCaster& ray_caster,
                              const View& view, ElementQuantity quantity, const PictureOptions& options,
                              const Monitor& monitor = {});

/// Draws the borders and silhouettes of visible elements over a tone-mapped picture.
/// @param picture  Drawn from `view`. @param samples  Rays per pixel for the lines, >= 1.
/// @throws InputError as render() does.
Image draw_mesh(const Image& picture, const Scene& scene, const Solution& solution, const RayCaster& ray_caster,
                const View& view, int samples, std::uint64_t seed = 1, const Monitor& monitor = {});

/// Predicts the peak memory of tracing the paths of a picture [bytes], in addition to scene, ray caster and solution.
/// Measured with 1.4 million emitting patches.
std::size_t path_memory(std::size_t patches, const PictureOptions& options);

}  // namespace interflect
