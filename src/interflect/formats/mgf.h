#pragma once

#include <filesystem>
#include <string_view>

#include "interflect/read_options.h"
#include "interflect/scene.h"

namespace interflect::inline detail {

/// Reads a scene in the Materials and Geometry Format, version 2.0 (Ward 1996, http://radsite.lbl.gov/mgf/).
///
/// All entities are supported:
/// * `f fh sph torus cyl cone ring prism` become patches (add_polygon) under the current transform. Curved surfaces
///   have options.curve_divisions pieces per quarter circle. Mirroring transforms keep the front outside. A face makes
///   one patch if the material has `sides 1`, else two. Faces share vertices at exactly equal positions. Vertex normals
///   (`n`) orient rings and tori and are otherwise dropped.
/// * `c cxy cspec cct cmix` give colours in linear Rec. 709 (to_rec709()); MGF's neutral is R = G = B. Spectra and
///   mixture weights may be negative. Chromaticities without luminance count as bluest or reddest. Colours outside Rec.
///   709 are desaturated.
/// * `rd` becomes reflectance, each channel at most 0.99, and `ed` exitance [lm/m^2]. `ts` becomes the transmittance of
///   thin glass; its roughness is ignored ("rough-transmission"). `rs` becomes a mirror visible to the camera if its
///   roughness is at most 0.02. Other `rs` and all `td` are omitted; the warnings "specular-reflection" and
///   "diffuse-transmission" report the omitted share. `ir` is only checked.
/// * `o` names objects; nested names are joined by dots. Copies of an array are objects "a0", "a1" ..., or "a0.0" ...
/// * `xf` and `i` are transforms, arrays and files. File names are relative to the including file, and contexts are
///   shared. Anything still open at the end of a file is closed with a warning. Only the first copy of an unclosed
///   array is read.
/// * `uv` and `texture` (docs/mgf-extensions.md) are extensions: texture coordinates of a vertex, and an image that
///   multiplies a material's `rd`, `ts` or `ed`.
/// * `ies` places a measured luminaire (load_photometric_web()), whose warnings are added to the list below.
/// * Unknown entities are skipped with a warning.
///
/// A scene far from the world's origin is read a second time, relative to its Scene::origin (origin_for), to keep
/// precision.
///
/// Scene::files lists the files read. Further warnings, counted by kind: "unsupported-entity", "reflectance-clamped",
/// "out-of-gamut", "no-luminance", "unused-fault" (in a colour or material that no face uses), "degenerate-face" (fewer
/// than three distinct vertices, narrower than their rounding, or no area left by a self-crossing outline),
/// "unbalanced-object", "unclosed-object" and "unclosed-transform". Time and memory are linear in the text with arrays
/// expanded.
///
/// @throws InputError  with file, line and the expected input, for:
/// - a file that cannot be read, or that includes itself
/// - missing arguments, numbers out of range or not finite in single precision, undefined names
/// - unusable images, and textures without texture coordinates
/// - input beyond a limit of `options`, and arrays and includes that process much more text than they produce
/// - faces or exitances beyond the computable range (limits.h), and holes with fewer than three distinct vertices
/// - a face as large as the others but so far away that rounding would remove it
/// - a scene without a face that has an area
/// Errors in a colour or material count only if a face uses it.
Scene read_mgf(const std::filesystem::path& path, const ReadOptions& options = {});

/// Reads from memory. @param path  Name for messages; includes are relative to its folder.
Scene read_mgf_text(std::string_view text, const std::filesystem::path& path, const ReadOptions& options = {});

}  // namespace interflect::inline detail
