#pragma once

#include <filesystem>
#include <string_view>

#include "interflect/load.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Reads a scene in the Materials and Geometry Format 2.0 (Ward 1996, http://radsite.lbl.gov/mgf/).
///
/// * `f fh sph torus cyl cone ring prism` become patches, two per face unless `sides 1`, with shared vertices.
/// * `c cxy cspec cct cmix` become linear Rec. 709; MGF's neutral is R = G = B. Spectra and mixture weights may be
/// negative.
/// * `rd` is limited to 0.99; `ts` ignores roughness. `rs` is a mirror for the camera if its roughness is at most 0.02.
/// Other `rs` and all `td` are omitted, with their share in a warning. `ir` is only checked.
/// * `o` and the copies of arrays ("a0", "a1") name objects, joined by dots.
/// * The end of a file closes everything open, with a warning; an unclosed array is read once.
/// * `ies` places a measured luminaire. `uv`, `texture` and `light` are extensions (docs/mgf-extensions.md).
///
/// Scenes far from the world's origin are relative to Scene::origin. Linear in the text with arrays expanded.
///
/// @throws InputError with file, line and expected input, for:
/// - unreadable files, recursive includes, and input beyond the limits of `options`
/// - missing arguments, undefined names, and numbers out of range
/// - unusable images, and textures without coordinates
/// - arrays and includes that repeat far more text than patches
/// - faces or exitances beyond limits.h, and distant faces that rounding would remove
/// - scenes without a face that has an area
/// Errors in a colour or material count only if a face uses it.
Scene read_mgf(const std::filesystem::path& path, const ReadOptions& options = {});

/// @param path  Name for messages; its folder contains includes.
Scene read_mgf_text(std::string_view text, const std::filesystem::path& path, const ReadOptions& options = {});

}  // namespace interflect::detail
