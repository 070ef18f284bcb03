/// @file
/// Pictures of a solution, path tracing as an independent reference, and denoising.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "interflect/image.h"
#include "interflect/ray_caster.h"
#include "interflect/scene.h"
#include "interflect/solution.h"

namespace interflect {

/// Criterion for smooth surfaces.
struct SmoothingOptions {
    /// Maximum angle between the normals of patches with common shading [degrees]. The default exceeds the 22.5 degrees
    /// between the facets of a sphere or cylinder tessellated by a reader.
    float crease_angle = 30;
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
/// @param solution  Of the same scene, as is `ray_caster`.
/// @return          The same bits for the same seed and any number of threads.
/// @throws InputError for a view that defines no picture, an option out of range, and a solution or a ray caster of
///         another scene.
Rendering render(const Scene& scene, const Solution& solution, const RayCaster& ray_caster, const View& view,
                 const RenderOptions& options = {}, const Monitor& monitor = {});

/// Sampling of emitting patches. All three have the same expected value; the two single strategies serve for
/// comparison.
enum class EmitterSampling {
    combined,    ///< Both, by multiple importance sampling with the balance heuristic (Veach and Guibas 1995).
    lights,      ///< Next event estimation alone: patches chosen by LightTree, points uniform on them.
    directions,  ///< Cosine-distributed directions alone, with chance hits of emitting patches.
};

/// Quantity shown on visible surfaces.
enum class PathQuantity {
    radiance,    ///< L = (M + rho H) / pi [cd/m^2 or W/(m^2 sr)].
    irradiance,  ///< H [lux = lm/m^2, or W/m^2], independent of reflectance.
};

struct PathOptions {
    int width = 1280;          ///< [pixels], >= 1.
    int height = 720;          ///< [pixels], >= 1.
    int samples = 64;          ///< Paths per pixel, >= 2; with a target the minimum, see PathTracing.
    int max_samples = 16'384;  ///< Maximum number of paths per pixel with a target, >= samples.
    /// Target of each pixel's relative standard error, >= 0; 0: every pixel gets `samples`. Relative to the larger of
    /// the pixel's radiance and the picture's mean reflected radiance, which relaxes the target for dark pixels.
    double until = 0;
    /// Maximum duration [s], > 0. Every pixel gets two batches of paths, however long they take; later ones are omitted
    /// once it is over.
    double time = std::numeric_limits<double>::infinity();
    PathQuantity quantity = PathQuantity::radiance;
    bool mirrors = true;  ///< Whether the camera sees mirrors (Material::specular_reflectance).
    EmitterSampling emitter_sampling = EmitterSampling::combined;
    int light_walks = 16'384;  ///< For render_instant(): walks from the light sources for a batch of paths, >= 1.
    std::uint64_t seed = 1;
};

/// Reflected light of a subset of a picture's samples.
struct SampledLight {
    Image direct;    ///< Reflected once, in the picture's unit.
    Image indirect;  ///< Reflected more often.
    /// Estimated variance of the channel mean of `direct` and `indirect`, [y * width + x].
    std::vector<float> direct_variance, indirect_variance;
};

/// Components of a picture: means over the samples of each pixel.
struct PictureLayers {
    Image emitted;  ///< Radiance straight from emitters, in the picture's unit.
    /// All other light of the picture.
    SampledLight reflected;
    bool is_indirect_interpolated = false;  ///< By render_hybrid(): indirect light has no noise to remove.
    /// The same for two independent halves of the samples: every other batch, and the rest.
    std::array<SampledLight, 2> halves;
    Image albedo;              ///< Reflectance of the visible surface; 1 in a picture of irradiance.
    Image normal;              ///< Its normal, towards the camera; shorter than 1 if several surfaces are visible.
    Image position;            ///< Its position, relative to the scene's origin [m].
    std::vector<float> depth;  ///< Its distance from the camera [m]; 0 without a hit.
    std::vector<float> level;  ///< Level of the visible element of the solution; 0 in path tracing.
    float pixel_angle = 0;     ///< Angle of a pixel's side at the centre of the picture [rad]; 0 if orthographic.
    float pixel_size = 0;      ///< Side of a pixel in an orthographic picture [m]; else 0.
};

/// A picture with its standard error.
struct PathTracing {
    /// Radiance L = (M + rho H) / pi seen by each pixel, the mean over its square; the sky for escaped rays. In the
    /// units of render(). Unbiased if traced without a solution: the expected value is then exact. Pixels not reached
    /// by an interrupted run are black.
    Image image;
    PictureLayers layers;
    /// Standard error of each pixel and channel, in the same unit, from the spread of independent batches of paths.
    Image standard_error;
    /// Standard error over the larger of the pixel's radiance and the picture's mean reflected radiance (channel
    /// means), root mean square over the pixels; 0 for a picture without light. Infinite if any pixel has fewer than
    /// two batches.
    double relative_error = 0;
    std::int64_t rays = 0;         ///< Camera rays, reflected rays and shadow rays.
    std::int64_t shadow_rays = 0;  ///< Included in `rays`.
    std::int64_t paths = 0;
    std::vector<std::uint32_t> batches;  ///< Batches of paths of each pixel; its standard error needs two.
    std::int64_t escaped_rays = 0;       ///< Camera rays and reflected rays without a hit.
    std::int64_t non_finite_pixels = 0;  ///< Number of pixels with an infinite or NaN value, which `image` keeps.
    bool interrupted = false;
};

/// Path tracing (Kajiya 1986) of a view: an independent reference for the radiosity solver. Surfaces are diffuse; light
/// passes straight through thin glass. Mirrors are followed from the camera only; other mirrored light is lost, as in
/// the solver.
///
/// A path starts at a random point of a pixel's square and continues in cosine-distributed directions until Russian
/// roulette on its throughput ends it. At each vertex an emitting patch is sampled by LightTree and connected by a
/// shadow ray, which counts if RayCaster hits that patch. Reflected rays that hit an emitting patch also count; the
/// balance heuristic weights both. Random numbers are Owen-scrambled Sobol' points.
///
/// Paths are traced in independent batches of a power of two, at least 8 a pixel if `samples` suffices; `samples` is
/// rounded up to whole batches.
///
/// Without a target the estimate is unbiased. With a target, pixels get samples in rounds that at most double their
/// number. The remaining number follows from the relative variance so far, averaged over 7 x 7 pixels because a single
/// pixel's variance is too noisy. The bias is far below the standard error.
///
/// @param ray_caster  Of the same scene.
/// @return            The same bits for the same seed and any number of threads, unless interrupted or out of time.
/// @throws InputError for a view that defines no picture, an option out of range or a ray caster of another scene.
/// Cost: two rays a vertex and, for reflectances about rho, 1 / (1 - rho) vertices a path or a few more; 250 bytes a
/// patch and 600 a pixel.
PathTracing trace_paths(const Scene& scene, const RayCaster& ray_caster, const View& view,
                        const PathOptions& options = {}, const Monitor& monitor = {});

/// Instant radiosity (Keller 1997) without bias (Kollig and Keller 2004): direct light as by trace_paths(), indirect
/// light by shadow rays to virtual lights, which random walks from the light sources leave at their reflections. Paths
/// find the light of near virtual lights, whose contributions are bounded. The expected value equals trace_paths()
/// unless a one-sided face is between a source and a lit surface.
/// @return  The standard error includes the error of the lights: each batch of a pixel has another set.
/// @throws InputError as trace_paths() does, and for options.light_walks below 1.
/// Cost: as trace_paths(), with three more shadow rays at the first vertex and fewer bounces; 0.5 to 4 kB a walk.
PathTracing render_instant(const Scene& scene, const RayCaster& ray_caster, const View& view,
                           const PathOptions& options = {}, const Monitor& monitor = {});

/// Final gathering (Reichert 1992; Jensen 1996): a picture of a solution with the light computed per pixel. At the hits
/// of camera rays, direct light is sampled as by trace_paths(): emitting patches and luminaires in proportion to their
/// unoccluded contribution. Indirect light is gathered by cosine-distributed rays, which end at the radiosity rho H of
/// the element hit. If that element fills too large a solid angle, as in corners, the path continues as in path
/// tracing. Contact shadows are therefore sharp, and the mesh affects only a small fraction of indirect light. For
/// finer elements the picture converges to trace_paths().
/// @param solution  Of the same scene, as is `ray_caster`.
/// @param options   Of path tracing; `samples` are gathered directions per pixel.
/// @return          The standard error excludes the solution's own error.
/// @throws InputError as trace_paths() does, and for a solution of another scene.
PathTracing gather(const Scene& scene, const Solution& solution, const RayCaster& ray_caster, const View& view,
                   const PathOptions& options = {}, const Monitor& monitor = {});

/// Hybrid shading: direct light as by gather(), with more stratification; indirect light interpolated between sparse
/// points that gather 512 directions each (irradiance caching, Ward et al. 1988). Where no point is near, light is
/// gathered.
/// @param options  Of path tracing; `samples` are camera rays per pixel.
/// @return         The standard error excludes indirect light.
/// @throws InputError as gather() does.
PathTracing render_hybrid(const Scene& scene, const Solution& solution, const RayCaster& ray_caster, const View& view,
                          const PathOptions& options = {}, const Monitor& monitor = {});

/// Removes noise from a picture of gather() or trace_paths(): each pixel becomes a weighted mean of its surroundings.
/// Direct and indirect light are filtered separately, as irradiance, which keeps reflectances, textures and emitters
/// sharp. A neighbour counts if it lies in the pixel's tangent plane and its light differs by no more than noise
/// explains, which preserves shadow borders (non-local means, Buades et al. 2005, with estimated variance as in
/// Rousselle et al. 2012). Weights of one half of the samples come from the other half, which preserves the mean
/// despite bright outliers. The result is biased where the light varies by less than its noise.
/// @return  The picture, in the same unit.
Image denoise(const PictureLayers& layers);

}  // namespace interflect
