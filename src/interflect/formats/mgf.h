#pragma once

#include <filesystem>
#include <string_view>

#include "interflect/read_options.h"
#include "interflect/scene.h"

namespace interflect::inline detail {

/// Reads a scene in the Materials and Geometry Format, version 2.0 (Ward 1996, http://radsite.lbl.gov/mgf/).
///
/// All entities are understood:
/// * `f fh sph torus cyl cone ring prism` become patches (add_polygon), curved ones with options.curve_divisions pieces
///   per quarter circle, at the transform in force; a mirror image keeps its front outside. One patch a face where the
///   material has `sides 1`, else two. Faces that meet at exactly the same position share a vertex. Vertex normals
///   (`n`) orient rings and tori and are not kept otherwise.
/// * `c cxy cspec cct cmix` give colours in linear Rec. 709 as to_rec709() has it; MGF's neutral is R = G = B.
///   Spectra and the weights of mixtures may have negative values; chromaticities without luminance count as bluest or
///   reddest. What lies outside Rec. 709 is desaturated.
/// * `rd` and `ed` [lm/m^2] become reflectance, each channel at most 0.99, and exitance; `ts` the transmittance of thin
///   glass, a roughness of which is ignored ("rough-transmission"); `rs` a mirror to the camera, where its roughness is
///   0.02 at most. Otherwise `rs` and `td` are left out: warnings "specular-reflection" and "diffuse-transmission" tell
///   the share. `ir` is checked only.
/// * `o` names objects, nested names with dots; the copies of an array are objects "a0", "a1" ..., or "a0.0" ...
/// * `xf` and `i`: transforms, arrays and files, which are found relative to the including file and share its contexts.
///   What a file leaves open is closed at its end, with a warning; of an array left open only the first copy is read.
/// * `uv` and `texture` (docs/mgf-extensions.md) are Interflect's own: texture coordinates of a vertex, and an image
///   that a material's `rd` or `ed` is multiplied by.
/// * `ies` places a luminaire of measured light (load_photometric_web()), whose warnings are added to those below.
/// * Unknown entities are skipped with a warning.
///
/// A scene that lies far from the world's origin is read twice, the second time relative to its Scene::origin
/// (origin_for), so that it keeps its precision.
///
/// Scene::files lists the files read. Warnings are counted under these kinds: "unsupported-entity",
/// "reflectance-clamped", "out-of-gamut", "no-luminance", "unused-fault" (in a colour or material that no face uses),
/// "degenerate-face" (fewer than three different vertices, no wider than their rounding, or nothing left of its area
/// where its outline crosses itself), "unbalanced-object", "unclosed-object", "unclosed-transform" and those above.
/// Time and memory are linear in the text, with arrays written out.
///
/// @throws InputError  with file, line and what was expected, where a file cannot be read, an entity lacks arguments,
/// has a
///         number that is not finite in single precision or out of its range, names what is not defined or an image
///         that cannot be used, puts a texture on what has no texture coordinates, or goes beyond a limit of `options`,
///         all this in a colour or material only where a face uses it; where a face or an exitance is beyond what can
///         be computed (limits.h), or a face so far from the others that rounding would leave nothing of it though it
///         is as large as they are; where a hole names fewer than three different vertices; where a file includes
///         itself; where arrays and includes go over much more than they make; where no face with an area is left.
Scene read_mgf(const std::filesystem::path& path, const ReadOptions& options = {});

/// The same from memory. @param path  Name for messages; its folder is where includes are looked for.
Scene read_mgf_text(std::string_view text, const std::filesystem::path& path, const ReadOptions& options = {});

}  // namespace interflect::inline detail
