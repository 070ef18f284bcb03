#pragma once

#include <cstdint>

#include "interflect/scene.h"

namespace interflect::inline detail {

/// Tells scenes apart by their geometry: a hash of the origin, of each patch's corners and of which patches are sides
/// of one face. Two different scenes have the same with a chance of 2^-64. Materials, names and views do not count.
/// The same for any number of threads. Cost: one pass over the patches.
/// @throws InputError where a vertex index is out of range.
std::uint64_t geometry_fingerprint(const Scene& scene);

/// @param fingerprint  geometry_fingerprint() of the scene that `what` ("the ray caster") was made for.
/// @throws InputError where that is another scene.
void require_made_for(const Scene& scene, std::uint64_t fingerprint, const char* what);

}  // namespace interflect::inline detail
