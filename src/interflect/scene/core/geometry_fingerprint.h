#pragma once

#include <cstdint>

#include "interflect/scene.h"

namespace interflect::detail {

/// Hashes a scene's origin, patch corners and pairs of sides.
/// @throws InputError if a vertex index is out of range.
std::uint64_t geometry_fingerprint(const Scene& scene);

/// @throws InputError if `scene` has another fingerprint.
/// @param what  For the message.
void require_made_for(const Scene& scene, std::uint64_t fingerprint, const char* what);

}  // namespace interflect::detail
