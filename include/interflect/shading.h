/// @file
/// Ways to compute the light of pixels, texels, vertices and measuring points: labels and default numbers of samples.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace interflect {

/// Method that computes light at a point of a surface. All but `path` and `instant` use a solution.
enum class Shading {
    /// Irradiance of the solution, constant on each leaf.
    flat,
    /// Irradiance of the solution, interpolated between the leaves of a smooth surface: continuous, linear on triangles
    /// and bilinear on quadrilaterals.
    smooth,
    /// Direct light by shadow rays, with unoccluded light as a control variate: unbiased for any number of
    /// samples. Indirect light is interpolated between sparse points that gather 128 to 1,024 directions each
    /// (irradiance caching, Ward et al. 1988); where no point is near, it is gathered. Biased by the error of the
    /// solution from the second bounce on, and by interpolation. The standard error includes the noise of the points
    /// and an estimate of the error of interpolation, not the solution's own error.
    hybrid,
    /// Final gathering (Reichert 1992; Jensen 1996). Direct light is sampled as by `path`: emitting patches and
    /// luminaires in proportion to their unoccluded contribution. Indirect light is gathered by cosine-distributed
    /// rays, which end at the radiosity rho H of the element hit. If that element fills too large a solid angle, as in
    /// corners, the path continues as in path tracing. Contact shadows are therefore sharp, and the mesh affects only a
    /// small fraction of indirect light. For finer elements the light converges to path tracing. Unbiased for any
    /// number of samples except for the error of the solution from the second bounce on, which the standard error
    /// excludes.
    gather,
    /// Path tracing (Kajiya 1986), an independent reference for the radiosity solver. Surfaces are diffuse; light
    /// passes straight through thin glass. Mirrors are followed from the camera only; other mirrored light is lost, as
    /// in the solver. A path continues in cosine-distributed directions until Russian roulette on its throughput ends
    /// it. At each vertex an emitting patch is sampled by its estimated unoccluded irradiance (Conty and Kulla 2018)
    /// and connected by a shadow ray, which counts if RayCaster hits that patch. Reflected rays that hit an emitting
    /// patch also count; the balance heuristic weights both. Random numbers are Owen-scrambled Sobol' points. Unbiased
    /// for any number of samples.
    path,
    /// Instant radiosity (Keller 1997) without bias (Kollig and Keller 2004). Direct light as by `path`, indirect light
    /// by shadow rays to virtual lights, which random walks from the light sources leave at their reflections. The
    /// contributions of near virtual lights are bounded; paths add the missing light. The expected value is that of
    /// path tracing, unless a one-sided face is between a source and a lit surface. The standard error includes the
    /// error of the lights: each batch of a pixel has another set.
    instant,
};

/// Labels of Shading in its order, as on the command line and in Python.
inline constexpr std::array shading_labels{"flat", "smooth", "hybrid", "gather", "path", "instant"};

constexpr const char* label(Shading shading) { return shading_labels[static_cast<std::size_t>(shading)]; }

/// Whether the light comes from a solution.
constexpr bool needs_solution(Shading shading) { return shading != Shading::path && shading != Shading::instant; }

/// Whether paths sample the light, which therefore has noise and a standard error.
constexpr bool traces_paths(Shading shading) { return shading != Shading::flat && shading != Shading::smooth; }

/// Default numbers of samples by use; 0: the shading is not available for that use.
struct DefaultSamples {
    int pixel = 0;   ///< Camera rays or paths.
    int texel = 0;   ///< Points where direct light is sampled, or gathered directions; 1: the centre of the texel.
    int vertex = 0;  ///< As for a texel, but more, because a vertex affects a larger surface.
    int point = 0;   ///< Paths of a measuring point.
};

/// Default numbers of samples of Shading in its order.
inline constexpr std::array<DefaultSamples, 6> default_samples{{
    {.pixel = 16},                                            // flat
    {.pixel = 16, .texel = 1, .vertex = 1},                   // smooth
    {.pixel = 32, .texel = 128, .vertex = 64},                // hybrid
    {.pixel = 16, .texel = 64, .vertex = 64, .point = 4096},  // gather
    {.pixel = 64, .point = 4096},                             // path
    {.pixel = 64},                                            // instant
}};

/// Default maximum number of samples of a pixel or measuring point with a target.
inline constexpr int default_max_samples = 16'384;

/// A use of light: a member of DefaultSamples, such as &DefaultSamples::texel.
using LightUse = int DefaultSamples::*;

/// Shadings that are available for a use, in the order of Shading.
std::vector<Shading> available_shadings(LightUse use);

/// Returns `samples`, or the default number if it is 0.
/// @throws InputError that lists the available shadings if this one is not available for the use.
int require_samples(Shading shading, LightUse use, int samples = 0);

/// Returns the shading with this label. @throws InputError that lists the available ones if it is not among them.
Shading find_shading(const std::string& text, LightUse use);

}  // namespace interflect
