#pragma once

#include <cstdint>

#include "interflect/scene.h"

namespace interflect::detail {

/// Returns a 64-bit hash of a scene's origin, patch corners and pairs of sides. Materials, names and views do not
/// matter. O(patches). @throws InputError if a vertex index is out of range.
std::uint64_t geometry_fingerprint(const Scene& scene);

/// @param what  Object with this fingerprint, for the message.
/// @throws InputError if `scene` has another one.
void require_made_for(const Scene& scene, std::uint64_t fingerprint, const char* what);

}  // namespace interflect::detail
