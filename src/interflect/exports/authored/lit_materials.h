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
/// Irradiance is a reference in the material (MOZ_lightmap). Radiance is an unlit material in place of the file's own,
/// which stays as the variant "authored" (KHR_materials_variants); glass, metal and surfaces with holes keep theirs,
/// because the lightmap contains diffuse light only.
class LitMaterials {
  public:
    /// Multiplies emission by the exposure.
    LitMaterials(GltfDocument& document, const LightmapImages& images);

    /// Index of the texture coordinates for lightmaps (TEXCOORD_n): the first one above 0 that no material uses.
    int set() const { return set_; }
    /// Leaves the materials of a primitive as they are; light() adds copies of them.
    void keep(const Json& primitive);
    /// Refers a primitive, with all of its variants, to the materials with an image.
    void light(Json& primitive, int page);

  private:
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
    std::optional<int> first_variant_;  // of the two that radiance needs
};

}  // namespace interflect::detail
