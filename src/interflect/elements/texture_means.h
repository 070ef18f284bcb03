#pragma once

#include <cstdint>
#include <vector>

#include "interflect/elements/cell.h"
#include "interflect/geometry/textures/texture_integral.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Area-weighted means of textures over cells. They are exact for linear texture coordinates. Other cells are divided
/// into 32 triangles.
class TextureMeans {
  public:
    /// @param scene  Must be valid, and must outlive this.
    explicit TextureMeans(const Scene& scene);

    /// Returns the mean texel over a cell; 1 without a texture.
    Rgb mean(std::uint32_t texture, const Patch& patch, const PatchGeometry& geometry, const Cell& cell) const;

  private:
    const Scene& scene_;
    std::vector<TextureIntegral> integrals_;
};

}  // namespace interflect::detail
