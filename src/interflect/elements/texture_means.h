#pragma once

#include <cstdint>
#include <vector>

#include "interflect/elements/cell.h"
#include "interflect/geometry/textures/texture_integral.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Area-weighted means over cells, exact for linear texture coordinates, else by 32 triangles per cell.
class TextureMeans {
  public:
    /// @param scene  Valid; must outlive this.
    explicit TextureMeans(const Scene& scene);

    /// Returns 1 without a texture.
    Rgb mean(std::uint32_t texture, const Patch& patch, const PatchGeometry& geometry, const Cell& cell) const;

  private:
    const Scene& scene_;
    std::vector<TextureIntegral> integrals_;
};

}  // namespace interflect::detail
