#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <vector>

#include "interflect/image.h"
#include "interflect/ray_caster.h"
#include "interflect/scene.h"

namespace interflect {

/// How a path finds the emitting patches. All three have the same expected value; the two parts exist to be compared.
enum class EmitterSampling {
    combined,    ///< Both, by multiple importance sampling with the balance heuristic (Veach and Guibas 1995).
    lights,      ///< Next event estimation alone: patches chosen by LightTree, points uniform on them.
    directions,  ///< Cosine-distributed directions alone, which hit an emitting patch by chance.
};

/// What a picture shows of the surfaces that it sees.
enum class PathQuantity {
    radiance,    ///< L = (M + rho H) / pi [cd/m^2 or W/(m^2 sr)].
    irradiance,  ///< H [lux = lm/m^2, or W/m^2], whatever their reflectance.
};

struct PathOptions {
    int width = 1280;          ///< [pixels], >= 1.
    int height = 720;          ///< [pixels], >= 1.
    int samples = 64;          ///< Paths a pixel, >= 2: that many without a target, else the least; see PathTracing.
    int max_samples = 16'384;  ///< Most paths a pixel where there is a target, >= samples.
    /// Target of each pixel's relative standard error, >= 0; 0: none, every pixel gets `samples`. Relative to the
    /// pixel's radiance, but at least to the picture's mean reflected radiance: dark pixels need not be exact.
    double until = 0;
    PathQuantity quantity = PathQuantity::radiance;
    bool mirrors = true;  ///< Whether the camera sees Material::specular_reflectance, which reflects no other light.
    EmitterSampling emitter_sampling = EmitterSampling::combined;
    std::uint64_t seed = 1;
};

/// Progress of a picture.
struct PathProgress {
    std::int64_t rays = 0;      ///< So far, of all kinds.
    double fraction = 0;        ///< Of the work foreseen so far, in [0, 1]; a target not yet reached foresees more.
    double relative_error = 0;  ///< PathTracing::relative_error of a recent state; NaN if the work has none.
};

/// How a caller watches the progress of a picture, and ends it early.
struct PathMonitor {
    /// Called from the calling thread, about every quarter million paths.
    std::function<void(const PathProgress&)> on_progress;
    const std::atomic<bool>* stop = nullptr;  ///< Once true, what is under way is finished in milliseconds.
};

/// Thrown by work that PathMonitor::stop ends before it has a usable result. The message names the missing part.
class Stopped : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// Light of some of a picture's samples.
struct SampledLight {
    Image direct;    ///< Reflected once, in the picture's unit.
    Image indirect;  ///< Reflected more often.
    /// Estimated variance of the mean over the channels of `direct` and `indirect`, [y * width + x].
    std::vector<float> direct_variance, indirect_variance;
};

/// What a picture is made of: means over the samples of each pixel.
struct PictureLayers {
    Image emitted;  ///< Radiance that comes straight from where it is emitted, in the picture's unit.
    /// Beside what is emitted all light of the picture.
    SampledLight reflected;
    /// The same of every other batch of samples and of the rest: independent of each other.
    std::array<SampledLight, 2> halves;
    Image albedo;              ///< Reflectance of what is seen; 1 in a picture of irradiance.
    Image normal;              ///< Its normal, towards the eye; shorter than 1 where several are seen.
    Image position;            ///< Where it is, relative to the scene's origin [m].
    std::vector<float> depth;  ///< Its distance from the eye [m]; 0 where nothing is hit.
    std::vector<float> level;  ///< Of the solution's element that is seen; 0 in path tracing.
    float pixel_angle = 0;     ///< That a pixel's side fills in the middle of the picture [rad]; 0 where orthographic.
    float pixel_size = 0;      ///< Of a pixel's side in an orthographic picture [m]; else 0.
};

/// A picture with its standard error.
struct PathTracing {
    /// Radiance L = (M + rho H) / pi of what each pixel sees, the mean over its square; black where rays escape. In the
    /// units of render(). No approximation: the expected value is the exact solution's. A pixel that an interrupted run
    /// has not reached is black.
    Image image;
    PictureLayers layers;
    /// Of each pixel and channel, in the same unit: from the spread of batches of paths, which are independent.
    Image standard_error;
    /// Standard error over the larger of the pixel's radiance and the picture's mean reflected radiance (means over
    /// the channels), root mean square over the pixels; 0 for a picture without light. Infinite where a pixel has fewer
    /// than two batches of paths.
    double relative_error = 0;
    std::int64_t rays = 0;         ///< Camera rays, reflected rays and shadow rays.
    std::int64_t shadow_rays = 0;  ///< Of these.
    std::int64_t paths = 0;
    std::vector<std::uint32_t> batches;  ///< Of paths, of each pixel; its standard error needs two.
    std::int64_t escaped_rays = 0;       ///< Camera rays and reflected rays that hit nothing.
    std::int64_t non_finite_pixels = 0;  ///< They keep their value (infinite or not a number) in `image`.
    bool interrupted = false;
};

/// Path tracing (Kajiya 1986) of what `view` sees: an estimate of the picture that shares nothing with the radiosity
/// solver, to compare it with. Surfaces are diffuse; all light goes straight through thin glass, and mirrors are
/// followed from the camera alone: other light that they reflect is lost, as in the solver.
///
/// A path starts at a random point of a pixel's square and goes on in cosine-distributed directions; Russian roulette
/// by throughput ends it, never a number of bounces. At each vertex an emitting patch is chosen by LightTree and joined
/// by a shadow ray, which counts where RayCaster answers with that patch. A reflected ray that hits an emitting patch
/// counts too; the balance heuristic weighs the two. Random numbers are Owen-scrambled Sobol' points.
///
/// Paths come in batches of a power of two, at least 8 batches a pixel where there are as many samples; `samples` is
/// rounded up to whole batches. Each batch has points of its own, independent of the other batches.
///
/// Without a target the estimate is unbiased. With one, pixels get samples in rounds that at most double their number.
/// The samples that a pixel still needs follow from the relative variance of all samples so far, averaged over the 7 x
/// 7 pixels around it: the noise of one pixel's own variance neither stops nor prolongs its sampling. The bias that
/// remains is far below the standard error; without a target there is none.
///
/// @param ray_caster  Of the same scene.
/// @return            The same bits for the same seed and any number of threads, unless interrupted.
/// @throws InputError for a view that defines no picture, an option out of range or a ray caster of another scene.
/// Cost: two rays a vertex and, for reflectances about rho, 1 / (1 - rho) vertices a path or a few more; 250 bytes a
/// patch and 600 a pixel.
PathTracing trace_paths(const Scene& scene, const RayCaster& ray_caster, const View& view,
                        const PathOptions& options = {}, const PathMonitor& monitor = {});

}  // namespace interflect
