#pragma once

#include <filesystem>
#include <string_view>

#include "interflect/load.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Reads the Materials and Geometry Format 2.0 (Ward 1996, http://radsite.lbl.gov/mgf/) with extensions
/// (docs/files/mgf-extensions.md).
///
/// * Surfaces become patches, two per face unless `sides 1`, with shared vertices.
/// * Colours become linear Rec. 709; MGF's neutral is R = G = B.
/// * `rd`, times its texture, is limited to 0.99; `ts` ignores roughness. `rs` is a mirror for the camera if its
///   roughness is at most 0.02.
/// * `o` and array copies ("a0", "a1") name objects, joined by dots.
///
/// The time is proportional to the length of the text with its arrays expanded.
/// @throws InputError for invalid input. Errors in colours and materials count only if used by a face.
Scene read_mgf(const std::filesystem::path& path, const ReadOptions& options = {});

Scene read_mgf_text(std::string_view text, const std::filesystem::path& path, const ReadOptions& options = {});

}  // namespace interflect::detail
