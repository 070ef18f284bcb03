#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "interflect/path_tracer.h"
#include "interflect/ray_caster.h"
#include "interflect/scene.h"
#include "interflect/solve.h"

namespace interflect {

/// Shape of an infinitesimal receiver. Cylinders have no ends.
enum class Receiver {
    planar,
    cylindrical,      ///< All around an axis: the visibility of faces from all directions (EN 12464-1).
    semicylindrical,  ///< The half of a cylinder that faces one direction (CIE 136; EN 13201).
};

/// Position and receiver of a measurement.
struct MeasuringPoint {
    Imath::V3d position{0, 0, 0};  ///< World coordinates [m]. A point on a surface measures its irradiance.
    /// Planar: normal of the plane. Semicylindrical: facing direction, without its part along the axis. Need not be
    /// normalised.
    V3f normal{0, 0, 1};
    Receiver receiver = Receiver::planar;
    V3f axis{0, 0, 1};  ///< Axis of a cylinder; need not be normalised.
};

/// Irradiance at a measuring point [lux = lm/m^2, or W/m^2].
struct MeasuredIrradiance {
    Rgb direct{0, 0, 0};    ///< Light received straight from the sources.
    Rgb indirect{0, 0, 0};  ///< Reflected at least once.
    /// Standard error of the sum from gathering alone, without the solution's own error.
    Rgb standard_error{0, 0, 0};
    float indirect_error = 0;  ///< Standard error of the mean over the channels of `indirect`.
    Rgb sum() const { return direct + indirect; }
    /// Whether the estimate is usable; false if an interruption left too few samples.
    bool is_measured() const { return std::isfinite(standard_error.x); }
    float illuminance() const { return luminance(sum()); }                 ///< [lux]
    float illuminance_error() const { return luminance(standard_error); }  ///< [lux]
};

/// Measures irradiance by final gathering as for a pixel, see gather(). For cylinders, the mean over their normals (CIE
/// 136).
/// @param solution  Of the same scene, as is `ray_caster`; null: path tracing alone, see trace_paths().
/// @param options   For each point; width and height are ignored. `until` is relative to the point's irradiance.
/// @return          One entry per point. Points with too few samples after an interruption have an infinite standard
///                  error.
/// @throws InputError as gather() does, and for a point, normal or axis that is not finite or has no direction.
std::vector<MeasuredIrradiance> measure_irradiance(const Scene& scene, const Solution* solution,
                                                   const RayCaster& ray_caster, std::span<const MeasuringPoint> points,
                                                   PathOptions options = {}, const PathMonitor& monitor = {});

}  // namespace interflect
