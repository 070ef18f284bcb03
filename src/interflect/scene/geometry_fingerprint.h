#pragma once

#include <cstdint>

#include "interflect/scene.h"

namespace interflect::inline detail {

/// Hash of a scene's geometry: the origin, the corners of each patch, and which patches are sides of one face.
/// Materials, names and views are ignored. Two different scenes collide with probability 2^-64. Independent of the
/// number of threads. Cost: one pass over the patches.
/// @throws InputError if a vertex index is out of range.
std::uint64_t geometry_fingerprint(const Scene& scene);

/// @param fingerprint  geometry_fingerprint() of the scene for which `what` ("the ray caster") was made.
/// @throws InputError if `scene` has another fingerprint.
void require_made_for(const Scene& scene, std::uint64_t fingerprint, const char* what);

}  // namespace interflect::inline detail
