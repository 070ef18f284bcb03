#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "interflect/path_tracer.h"
#include "interflect/ray_caster.h"
#include "interflect/scene.h"
#include "interflect/solve.h"

namespace interflect {

/// Real spherical harmonics of degree 0, 1 and 2 in a unit direction, orthonormal over the sphere: Y00, Y1-1, Y10, Y11,
/// Y2-2, Y2-1, Y20, Y21, Y22, with the signs of Ramamoorthi and Hanrahan 2001 (Y1-1, Y10, Y11 grow with y, z, x).
std::array<float, 9> spherical_harmonics(const V3f& direction);

/// Irradiance of small surfaces at a point, as a function of their normal.
struct IrradianceProbe {
    /// E_lm [lm/m^2 or W/m^2]: the coefficients of radiance times pi, 2 pi / 3 and pi / 4 for degree 0, 1 and 2, the
    /// convolution with the cosine (Ramamoorthi and Hanrahan 2001, Eq. 9). The omitted higher degrees are at most 9% of
    /// the irradiance from one direction.
    std::array<Rgb, 9> coefficients;
    /// Inside a solid or in the dark: more than a quarter of all directions hit the back of a one-sided face, or no
    /// light arrives. Exclude from interpolation.
    bool is_inside = false;

    IrradianceProbe() { coefficients.fill(Rgb(0)); }
    /// Irradiance for a unit normal. May be slightly negative for light from few directions.
    Rgb irradiance(const V3f& normal) const;
};

struct ProbeOptions {
    float spacing = 1;  ///< Maximum grid spacing [m]; > 0.
    int rays = 2048;    ///< Per probe, 8 to 2^20; rounded up to 2 n^2.
    std::uint64_t seed = 1;
};

/// Probes at the centres of equal cells that fill the scene's bounding box.
struct ProbeGrid {
    Imath::V3d first{0, 0, 0};            ///< Position of the lowest probe, in world coordinates [m].
    Imath::V3d step{0, 0, 0};             ///< Distance of neighbours along each axis [m].
    std::array<int, 3> count{};           ///< Along each axis.
    std::vector<IrradianceProbe> probes;  ///< x fastest, then y, then z.
};
/// Maximum number of probes of one grid.
inline constexpr std::int64_t most_probes = 1'000'000;

/// Computes probes for the light of a solution. Rays from each probe follow a randomly rotated product quadrature of
/// the sphere and return the radiance (M + rho H) / pi of the surface hit, smoothly shaded, or of the sky. Panes of
/// glass are transparent, mirrors black. Unoccluded light sources other than surfaces are added exactly.
/// @param ray_caster  Of the same scene, as is `solution`.
/// @return            The same bits for any number of threads.
/// @throws InputError for an option out of range, more than most_probes, or another scene; Stopped if `monitor` ends
///         it.
/// Cost: about 2 rays a direction and probe.
ProbeGrid irradiance_probes(const Scene& scene, const Solution& solution, const RayCaster& ray_caster,
                            const ProbeOptions& options = {}, const PathMonitor& monitor = {});

}  // namespace interflect
