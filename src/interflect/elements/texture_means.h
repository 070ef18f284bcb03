#pragma once

#include <cstdint>
#include <vector>

#include "interflect/elements/cell.h"
#include "interflect/geometry/texture_integral.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Area-weighted means of a scene's textures over cells of its patches. Where texture coordinates are linear
/// (triangles, undistorted images on quadrilaterals), a cell's mean is that of its children, to rounding. Elsewhere a
/// cell is approximated by 32 triangles. Depends on the patch and the cell alone.
class TextureMeans {
  public:
    /// @param scene  Without faults; must outlive this object.
    explicit TextureMeans(const Scene& scene);

    /// Mean over `cell` of a patch with texture coordinates. @param texture  Index, or none, which gives 1.
    Rgb mean(std::uint32_t texture, const Patch& patch, const PatchGeometry& geometry, const Cell& cell) const;

  private:
    const Scene& scene_;
    std::vector<TextureIntegral> integrals_;
};

}  // namespace interflect::detail
