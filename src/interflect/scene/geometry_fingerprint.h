#pragma once

#include <cstdint>

#include "interflect/scene.h"

namespace interflect::detail {

/// 64-bit hash of a scene's origin, the corners of its patches, and which patches are sides of one face. Two scenes
/// collide with probability 2^-64. Independent of materials, names, views and the number of threads. Cost: one pass
/// over the patches.
/// @throws InputError if a vertex index is out of range.
std::uint64_t geometry_fingerprint(const Scene& scene);

/// @param fingerprint  geometry_fingerprint() of the scene of `what` ("the ray caster").
/// @throws InputError if `scene` has another fingerprint.
void require_made_for(const Scene& scene, std::uint64_t fingerprint, const char* what);

}  // namespace interflect::detail
