#pragma once

#include <string>
#include <vector>

#include "interflect/measure.h"
#include "interflect/scene.h"
#include "tests/support/form_factors.h"
#include "tests/validation/report.h"

namespace interflect::testing_support {

/// Placement of a case in the world: rotated about (1, 2, 3), scaled, and translated.
struct Placement {
    std::string name;
    double turn = 0;  ///< [degrees]
    double scale = 1;
    V3d origin{0, 0, 0};  ///< [m]

    V3d direction(const V3d& d) const;
    V3d point(const V3d& p) const { return origin + direction(p) * scale; }
    /// Transforms a scene with its origin at 0 and no lights except point lights.
    Scene scene(Scene original) const;
    MeasuringPoint measuring_point(const V3d& position, const V3d& normal) const;
};

/// Unchanged, rotated, at map coordinates of a thousand kilometres, and scaled to a thousandth.
extern const std::vector<Placement> placements;

/// Computes the illuminance at points, gathered from a solution of `rays` rays (hsrr) with `samples` samples a point
/// [lx].
std::vector<Estimate> measured(const Scene& scene, const std::vector<MeasuringPoint>& points,
                               std::int64_t rays = 10'000, int samples = 1024);

/// Computes the same by path tracing alone.
std::vector<Estimate> traced(const Scene& scene, const std::vector<MeasuringPoint>& points, int samples);

/// Computes the mean illuminance of patches, area-weighted, from the solution (hsrr) [lx].
Estimate solved(const Scene& scene, std::uint32_t first_patch, std::uint32_t patches, std::int64_t rays = 100'000);

}  // namespace interflect::testing_support
