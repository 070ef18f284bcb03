#pragma once

#include <ImathVec.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "interflect/scene.h"

namespace interflect::detail {

/// Exact means of a texture over triangles, with filtering and repetition as in texel_at(). By Green's theorem the
/// integral of f over a triangle is that of F dy along its border, with dF/dx = f. Between lines of texel centres F is
/// a cubic, which Simpson's rule integrates exactly. Memory: 3 bytes a texel.
class TextureIntegral {
  public:
    /// @param texture  Without faults; must outlive this object.
    explicit TextureIntegral(const Texture& texture);

    /// Mean over a triangle in texture coordinates, or over a line if it has no area. Within the range of the texels.
    /// O(texels along the border); above a million of them, the mean of the whole texture.
    Rgb mean(const std::array<V2f, 3>& corners) const;

  private:
    using V2d = Imath::V2d;
    std::size_t wrapped_row(std::int64_t row) const;
    const Rgb* texels_of(std::size_t row) const { return &texture_.texels[row * texture_.width]; }
    RgbD row_integral(std::int64_t column, std::size_t row) const;
    RgbD value_at(const V2d& x) const;
    RgbD integral_along(const V2d& a, const V2d& b, std::int64_t origin) const;
    RgbD integral_within_cell(const V2d& a, const V2d& b, std::int64_t origin) const;
    RgbD mean_of_wide(std::array<V2d, 3> x) const;

    const Texture& texture_;
    std::size_t sums_per_row_;
    std::vector<RgbD> sums_;  // per row: sum of the texels before every eighth one, then of the whole row
    Rgb largest_;
    RgbD mean_{0, 0, 0};
};

}  // namespace interflect::detail
