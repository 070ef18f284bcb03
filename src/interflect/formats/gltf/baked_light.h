#pragma once

namespace interflect::detail {

/// Variants of materials (KHR_materials_variants) in files whose lightmaps contain radiance.
inline constexpr const char* lit_variant = "lit";
inline constexpr const char* authored_variant = "authored";

/// Removes the lightmaps that `interflect export` added to a glTF file, with their texture coordinates, so that its
/// materials are the author's, with their emission. Light sources that the export removed, and light in vertices, stay
/// as they are. Returns whether the file is such an export.
/// @param root  The file's JSON, which may have faults.
template <class Json>  // nlohmann::json or nlohmann::ordered_json
bool remove_baked_light(Json& root);

}  // namespace interflect::detail
