#pragma once

namespace interflect::detail {

/// Variants of materials (KHR_materials_variants) in files whose lightmaps contain radiance.
inline constexpr const char* lit_variant = "lit";
inline constexpr const char* authored_variant = "authored";

/// Removes lightmaps of `interflect export` from a glTF file, with their texture coordinates, and restores the author's
/// materials and emission. Light sources that the export removed stay removed; light in vertices stays. Returns whether
/// the file is such an export.
/// @param root  The file's JSON, which may have faults.
template <class Json>  // nlohmann::json or nlohmann::ordered_json
bool remove_baked_light(Json& root);

}  // namespace interflect::detail
