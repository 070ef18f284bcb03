#pragma once

#include <filesystem>
#include <string_view>

#include "interflect/load.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Reads a scene in the Materials and Geometry Format, version 2.0 (Ward 1996, http://radsite.lbl.gov/mgf/).
///
/// * `f fh sph torus cyl cone ring prism` become patches (add_polygon), curved ones with options.curve_divisions pieces
///   per quarter circle. A face makes one patch with `sides 1`, else two. Mirroring keeps the front outside. Faces
///   share vertices at equal positions. Normals (`n`) orient rings and tori only.
/// * `c cxy cspec cct cmix` give colours in linear Rec. 709 (to_rec709()); MGF's neutral is R = G = B. Spectra and
///   mixture weights may be negative. Chromaticities without luminance count as bluest or reddest.
/// * `rd` (limited to 0.99) is reflectance, `ed` exitance [lm/m^2], `ts` the transmittance of thin glass without
///   roughness ("rough-transmission"). `rs` is a mirror visible to the camera if its roughness is at most 0.02. Other
///   `rs` and all `td` are omitted; "specular-reflection" and "diffuse-transmission" report the share. `ir` is only
///   checked.
/// * `o` names objects, joined by dots. Copies of an array are objects "a0", "a1" ..., or "a0.0" ...
/// * `xf` and `i`: file names are relative to the including file; contexts are shared. A file's end closes everything
///   left open, with a warning; of an unclosed array only the first copy is read.
/// * `uv` and `texture` (docs/mgf-extensions.md) are extensions: texture coordinates of a vertex, and an image that
///   multiplies `rd`, `ts` or `ed`.
/// * `ies` places a measured luminaire (load_photometric_web(), with its warnings); `light` is an extension for other
///   lights.
///
/// A scene far from the world's origin is read a second time relative to Scene::origin (origin_for), to keep precision.
/// Scene::files lists the files read. Time and memory are linear in the text with arrays expanded.
///
/// Other warnings: "unsupported-entity", "reflectance-clamped", "out-of-gamut" (desaturated), "no-luminance",
/// "unused-fault" (in an unused colour or material), "degenerate-face" (fewer than three distinct vertices, too narrow,
/// or no area because its outline crosses itself), "unbalanced-object", "unclosed-object", "unclosed-transform".
///
/// @throws InputError  with file, line and the expected input, for:
/// - unreadable files, files that include themselves, and input beyond the limits of `options`
/// - missing arguments, undefined names, and numbers out of range or not finite in single precision
/// - unusable images, and textures without coordinates
/// - arrays and includes that repeat far more text than patches
/// - faces or exitances beyond limits.h, and holes with fewer than three distinct vertices
/// - large faces so distant that rounding would remove them
/// - scenes without a face that has an area
/// Errors in a colour or material count only if a face uses it.
Scene read_mgf(const std::filesystem::path& path, const ReadOptions& options = {});

/// Reads from memory. @param path  Name for messages; includes are relative to its folder.
Scene read_mgf_text(std::string_view text, const std::filesystem::path& path, const ReadOptions& options = {});

}  // namespace interflect::detail
