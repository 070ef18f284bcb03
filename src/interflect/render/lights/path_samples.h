#pragma once

#include <cstdint>

#include "interflect/core.h"

namespace interflect::detail {

/// Samples directions around n with density cosine / pi (Malley's method); a, b uniform in (0, 1).
V3f cosine_direction(const V3f& n, float a, float b);

struct VertexSample {
    float direction_u, direction_v;
    float roulette;
};

/// Numbers in (0, 1) that choose a light source or bright element and a point or direction there.
struct LightSample {
    double choice;
    float u, v;
    float candidates;  // selects the candidates of LuminaireChoice
};

/// Independent sequences at a vertex.
enum class LightStream : std::uint32_t { patches = 1, lamps, suns, skies, guided_skies, reflections, unoccluded };

/// Returns Sobol' points at a path's first vertices, then pseudo-random numbers.
/// @param vertex  1 for the first vertex after the camera.
/// @param index   Index of the path in its sequence.
VertexSample vertex_sample(std::uint64_t key, std::uint32_t vertex, std::uint32_t index);
/// Returns the numbers of a shadow ray. @param index  Index of the shadow ray in the sequence of this vertex and
/// stream.
LightSample light_sample(std::uint64_t key, std::uint32_t vertex, LightStream stream, std::uint32_t index);

/// Returns the weight of a sample of density p by the balance heuristic, if the other method has density q.
inline float balance(float p, float q) { return p / (p + q); }

}  // namespace interflect::detail
