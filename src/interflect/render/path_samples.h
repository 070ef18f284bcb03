#pragma once

#include <cstdint>

#include "interflect/colour.h"
#include "interflect/geometry/patch_geometry.h"

namespace interflect::inline detail {

/// A direction with density cosine / pi over the hemisphere of n, for a and b uniform in (0, 1): Malley's method.
V3f cosine_direction(const V3f& n, float a, float b);

/// The random numbers of one vertex of a path, by which it goes on.
struct VertexSample {
    float direction_u, direction_v;
    float roulette;
};

/// Those of a shadow ray to a lamp and of one to a luminaire.
struct LightSample {
    double light;      // chooses the emitting patch
    float u, v;        // and the point on it
    float candidates;  // chooses luminaires that come into question; light, one of them
};

/// Those with which final gathering looks for bright places at a vertex.
struct PlaceSample {
    double patch;  // chooses it
    float u, v;    // and the point on it
};

/// Those with which skies are sampled at a vertex.
struct SkySample {
    double sky;  // chooses one
    float u, v;  // and the direction
};

/// Sobol' points at the first vertices of a path, pseudo-random numbers at later ones.
/// @param batch_key  Names the batch that the path is part of.
/// @param vertex     1 is the first that the camera sees.
/// @param index      Of the path in its batch.
VertexSample vertex_sample(std::uint64_t batch_key, std::uint32_t vertex, std::uint32_t index);
/// @param index  Of the shadow ray among those of the batch at this vertex; likewise below.
LightSample light_sample(std::uint64_t batch_key, std::uint32_t vertex, std::uint32_t index);
PlaceSample place_sample(std::uint64_t batch_key, std::uint32_t vertex, std::uint32_t index);
SkySample sky_sample(std::uint64_t batch_key, std::uint32_t vertex, std::uint32_t index);

/// Density per solid angle, seen from a point that `direction` leaves, of sampling a point of an emitting patch there.
/// @param probability  With which the patch is chosen.
/// @param distance2    From the point to that of the patch, squared [m^2].
float light_density(const PatchGeometry& lamp, float probability, const V3f& direction, float distance2);

/// The balance heuristic: the weight of a sample of density p where another technique has density q.
inline float balance(float p, float q) { return p / (p + q); }

}  // namespace interflect::inline detail
