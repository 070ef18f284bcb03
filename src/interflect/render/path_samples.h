#pragma once

#include <cstdint>

#include "interflect/core.h"
#include "interflect/geometry/patch_geometry.h"

namespace interflect::detail {

/// Samples directions around n with density cosine / pi (Malley's method); a, b uniform in (0, 1).
V3f cosine_direction(const V3f& n, float a, float b);

/// Random numbers that continue a path.
struct VertexSample {
    float direction_u, direction_v;
    float roulette;
};

/// Random numbers of shadow rays to an emitting patch and a luminaire.
struct LightSample {
    double light;      // selects the emitting patch
    float u, v;        // select the point
    float candidates;  // selects candidate luminaires, among which `light` selects
};

/// Random numbers that sample a KnownLight::Place.
struct PlaceSample {
    double patch;
    float u, v;  // select the point
};

struct SkySample {
    double sky;
    float u, v;  // select the direction
};

/// Returns Sobol' points at a path's first vertices, then pseudo-random numbers.
/// @param vertex  1 is the first vertex after the camera.
/// @param index   Path in its batch.
VertexSample vertex_sample(std::uint64_t batch_key, std::uint32_t vertex, std::uint32_t index);
/// @param index  Shadow ray in its batch at this vertex, also below.
LightSample light_sample(std::uint64_t batch_key, std::uint32_t vertex, std::uint32_t index);
PlaceSample place_sample(std::uint64_t batch_key, std::uint32_t vertex, std::uint32_t index);
SkySample sky_sample(std::uint64_t batch_key, std::uint32_t vertex, std::uint32_t index);

/// Returns the density per solid angle of a point on an emitting patch [1/sr].
/// @param probability  Of the patch.
/// @param distance2    Squared distance to the point [m^2].
float density_per_solid_angle(const PatchGeometry& patch, float probability, const V3f& direction, float distance2);

/// Balance heuristic: weight of density p against density q.
inline float balance(float p, float q) { return p / (p + q); }

}  // namespace interflect::detail
