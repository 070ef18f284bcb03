#pragma once

#include <cstdint>

#include "interflect/core.h"
#include "interflect/geometry/patch_geometry.h"

namespace interflect::detail {

/// Samples directions around n with density cosine / pi (Malley's method); a, b uniform in (0, 1).
V3f cosine_direction(const V3f& n, float a, float b);

struct VertexSample {
    float direction_u, direction_v;
    float roulette;
};

struct LightSample {
    double light;
    float u, v;
    float candidates;  // selects candidate luminaires, among which `light` selects
};

struct PlaceSample {
    double patch;
    float u, v;
};

struct SkySample {
    double sky;
    float u, v;
};

/// Returns Sobol' points at a path's first vertices, then pseudo-random numbers.
/// @param vertex  1 is the first vertex after the camera. @param index  Of the path in its batch.
VertexSample vertex_sample(std::uint64_t batch_key, std::uint32_t vertex, std::uint32_t index);
/// @param index  Of the shadow ray in its batch at this vertex, also below.
LightSample light_sample(std::uint64_t batch_key, std::uint32_t vertex, std::uint32_t index);
PlaceSample place_sample(std::uint64_t batch_key, std::uint32_t vertex, std::uint32_t index);
SkySample sky_sample(std::uint64_t batch_key, std::uint32_t vertex, std::uint32_t index);

/// Returns the density of a point on a patch that is sampled with `probability` [1/sr].
/// @param distance2  Squared distance [m^2].
float density_per_solid_angle(const PatchGeometry& patch, float probability, const V3f& direction, float distance2);

/// Balance heuristic.
inline float balance(float p, float q) { return p / (p + q); }

}  // namespace interflect::detail
