#pragma once

#include <map>
#include <optional>
#include <set>
#include <utility>

#include "interflect/exports/gltf/gltf_document.h"
#include "interflect/exports/gltf/lightmap_images.h"

namespace interflect::detail {

/// The materials of a glTF file, lit by the images of a lightmap. A material whose surfaces lie in several images is
/// listed once for each. Materials without light (KHR_materials_unlit) stay.
///
/// Irradiance is added to the material by reference (MOZ_lightmap). Radiance replaces the material by an unlit one; the
/// file's own stays as the variant "authored" (KHR_materials_variants); glass, metal and surfaces with holes keep
/// theirs, because the lightmap contains diffuse light only.
class LitMaterials {
  public:
    /// Multiplies emission by the exposure.
    LitMaterials(GltfDocument& document, const LightmapImages& images);

    /// Index of the texture coordinates for lightmaps (TEXCOORD_n): one above the highest index of the materials.
    int set() const { return set_; }
    /// Leaves the materials of a primitive as they are; light() adds copies of them.
    void keep(const Json& primitive);
    /// Replaces the materials of a primitive and of its variants by materials lit by image `page`.
    void light(Json& primitive, int page);

  private:
    /// Returns the index of a material lit by an image. Adds this material if needed.
    int lit(int material, int page);
    Json with_irradiance(Json material, int page) const;
    Json as_radiance(const Json& material, int page) const;
    void add_variants(Json& primitive, int authored, int lit);

    GltfDocument& document_;
    const LightmapImages& images_;
    int set_ = 1;
    std::map<std::pair<int, int>, int> lit_;  // keys: material (-1: none) and image
    std::map<int, int> first_page_;
    std::set<int> kept_;
    std::optional<int> first_variant_;  // index of the first of the two variants for radiance
};

}  // namespace interflect::detail
