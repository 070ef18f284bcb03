#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "interflect/path_tracer.h"
#include "interflect/ray_caster.h"
#include "interflect/scene.h"
#include "interflect/solve.h"

namespace interflect {

/// The surface that light is measured on. All are small; the cylinders have no ends.
enum class Receiver {
    planar,
    cylindrical,      ///< All around an axis: how faces look, from wherever they are seen (EN 12464-1).
    semicylindrical,  ///< The half of a cylinder that faces one way (CIE 136; EN 13201).
};

/// Where light is measured, and on what.
struct MeasuringPoint {
    Imath::V3d position{0, 0, 0};  ///< World coordinates [m]. On a surface it measures what that surface receives.
    /// Planar: of the plane. Semicylindrical: the way that it faces, but for its part along the axis. Need not be
    /// normalised.
    V3f normal{0, 0, 1};
    Receiver receiver = Receiver::planar;
    V3f axis{0, 0, 1};  ///< Of a cylinder; need not be normalised.
};

/// Irradiance at a measuring point [lux = lm/m^2, or W/m^2].
struct MeasuredIrradiance {
    Rgb direct{0, 0, 0};    ///< Straight from where it is emitted.
    Rgb indirect{0, 0, 0};  ///< Reflected at least once.
    /// Of the sum: of gathering alone, the solution's own error comes on top.
    Rgb standard_error{0, 0, 0};
    float indirect_error = 0;  ///< Standard error of the mean over the channels of `indirect`.
    Rgb sum() const { return direct + indirect; }
    /// Whether enough was traced to tell; false where a measurement was interrupted before.
    bool is_measured() const { return std::isfinite(standard_error.x); }
    float illuminance() const { return luminance(sum()); }                 ///< [lux]
    float illuminance_error() const { return luminance(standard_error); }  ///< Its standard error [lux].
};

/// Measures irradiance by final gathering, see gather(): the way in which each point's light is found is that of a
/// pixel. Cylinders have the mean over their normals (CIE 136).
/// @param solution  Of the same scene, as is `ray_caster`; null: by path tracing alone, see trace_paths().
/// @param options   Of each point; its width and height mean nothing. `until` is a share of the point's irradiance.
/// @return          As many as there are points; those that an interrupted measurement has hardly reached have an
/// infinite
///                  standard error.
/// @throws InputError as gather() does, and for a point, normal or axis that is not finite, or without a direction.
std::vector<MeasuredIrradiance> measure_irradiance(const Scene& scene, const Solution* solution,
                                                   const RayCaster& ray_caster, std::span<const MeasuringPoint> points,
                                                   PathOptions options = {}, const PathMonitor& monitor = {});

}  // namespace interflect
