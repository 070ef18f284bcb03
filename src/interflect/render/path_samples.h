#pragma once

#include <cstdint>

#include "interflect/core.h"
#include "interflect/geometry/patch_geometry.h"

namespace interflect::detail {

/// Samples a direction with density cosine / pi around n by Malley's method; a, b uniform in (0, 1).
V3f cosine_direction(const V3f& n, float a, float b);

/// Random numbers that continue a path at one vertex.
struct VertexSample {
    float direction_u, direction_v;
    float roulette;
};

/// Random numbers of the shadow rays to an emitting patch and to a luminaire.
struct LightSample {
    double light;      // chooses the emitting patch
    float u, v;        // choose the point on it
    float candidates;  // chooses candidate luminaires; `light` chooses among them
};

/// Random numbers that sample bright places in final gathering.
struct PlaceSample {
    double patch;
    float u, v;  // choose the point on it
};

/// Random numbers that sample the skies at a vertex.
struct SkySample {
    double sky;
    float u, v;  // choose the direction
};

/// Returns Sobol' points at the first vertices of a path, pseudo-random numbers at later ones.
/// @param vertex  1 is the first vertex that the camera sees.
/// @param index   Path in its batch.
VertexSample vertex_sample(std::uint64_t batch_key, std::uint32_t vertex, std::uint32_t index);
/// @param index  Shadow ray among those of the batch at this vertex; also in the functions below.
LightSample light_sample(std::uint64_t batch_key, std::uint32_t vertex, std::uint32_t index);
PlaceSample place_sample(std::uint64_t batch_key, std::uint32_t vertex, std::uint32_t index);
SkySample sky_sample(std::uint64_t batch_key, std::uint32_t vertex, std::uint32_t index);

/// Returns the density per solid angle of sampling this point of an emitting patch [1/sr].
/// @param probability  Probability of the patch. @param distance2  Squared distance to the point [m^2].
float light_density(const PatchGeometry& lamp, float probability, const V3f& direction, float distance2);

/// Balance heuristic: the weight of a sample of density p if another technique has density q.
inline float balance(float p, float q) { return p / (p + q); }

}  // namespace interflect::detail
