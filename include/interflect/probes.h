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

/// The light around a point, as what any small surface there receives.
struct IrradianceProbe {
    /// E_lm [lm/m^2 or W/m^2]: those of radiance times pi, 2 pi / 3 and pi / 4 for degree 0, 1 and 2, the convolution
    /// with the cosine (Ramamoorthi and Hanrahan 2001, Eq. 9). Even degrees above 2 are left out, which makes at most
    /// 9% of what a lamp of one direction causes.
    std::array<Rgb, 9> coefficients;
    /// Behind faces or in the dark: more than a quarter of all directions meet a one-sided face from its back, or no
    /// light arrives. Not to be interpolated from.
    bool is_inside = false;

    IrradianceProbe() { coefficients.fill(Rgb(0)); }
    /// Of a surface with this unit normal. Where the light comes from few directions it may be slightly negative.
    Rgb irradiance(const V3f& normal) const;
};

struct ProbeOptions {
    float spacing = 1;  ///< Of the grid, at most [m]; > 0.
    int rays = 2048;    ///< From each probe, 8 to 2^20; rounded up to 2 n^2.
    std::uint64_t seed = 1;
};

/// Probes at the middles of equal cells that fill the scene's bounding box.
struct ProbeGrid {
    Imath::V3d first{0, 0, 0};            ///< Of the lowest probe, in world coordinates [m].
    Imath::V3d step{0, 0, 0};             ///< Between neighbours, along each axis [m].
    std::array<int, 3> count{};           ///< Along each axis.
    std::vector<IrradianceProbe> probes;  ///< x fastest, then y, then z.
};
/// Of one grid.
inline constexpr std::int64_t most_probes = 1'000'000;

/// Measures the light of a solution within the scene. From each probe rays go along the nodes of a product quadrature
/// of the sphere, rotated at random, and bring the radiance (M + rho H) / pi of what they meet, smooth as pictures show
/// it, or of the sky; panes of glass let them through, mirrors count as black. Light sources that are no surfaces are
/// added exactly, where nothing hides them.
/// @param ray_caster  Of the same scene, as is `solution`.
/// @return            The same bits for any number of threads.
/// @throws InputError for an option out of range, more than most_probes, or another scene.
/// Stopped where `monitor` ends it.
/// Cost: about 2 rays a direction and probe.
ProbeGrid irradiance_probes(const Scene& scene, const Solution& solution, const RayCaster& ray_caster,
                            const ProbeOptions& options = {}, const PathMonitor& monitor = {});

}  // namespace interflect
