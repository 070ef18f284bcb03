#pragma once

#include <cstdint>
#include <vector>

#include "interflect/elements/cell.h"
#include "interflect/geometry/texture_integral.h"
#include "interflect/scene.h"

namespace interflect::inline detail {

/// Means of a scene's textures over parts of its patches, by area. A cell's is the area-weighted mean of its
/// children's, to rounding, where texture coordinates are linear over the patch, as on triangles and images that are
/// laid flat on quadrilaterals; elsewhere a cell is taken as 32 triangles. Depends on the patch and the cell alone.
class TextureMeans {
  public:
    /// @param scene  Without faults; must outlive this.
    explicit TextureMeans(const Scene& scene);

    /// The mean over `cell` of a patch with texture coordinates. @param texture  Index, or none: 1 then.
    Rgb mean(std::uint32_t texture, const Patch& patch, const PatchGeometry& geometry, const Cell& cell) const;

  private:
    const Scene& scene_;
    std::vector<TextureIntegral> integrals_;
};

}  // namespace interflect::inline detail
