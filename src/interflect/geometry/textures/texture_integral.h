#pragma once

#include <ImathVec.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "interflect/scene.h"

namespace interflect::detail {

/// Exact means over triangles of a texture as filtered by texel_at(). Integrates F dy along the border, with dF/dx = f
/// (Green's theorem). F is cubic between texel lines, so Simpson's rule is exact.
class TextureIntegral {
  public:
    /// @param texture  Without faults; must outlive this.
    explicit TextureIntegral(const Texture& texture);

    /// Returns the mean over a triangle or line in texture coordinates. O(texels along the border); above a million,
    /// the mean of the whole texture.
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
    std::vector<RgbD> sums_;  // per row: before every eighth texel, then of the whole row
    Rgb largest_;
    RgbD mean_{0, 0, 0};
};

}  // namespace interflect::detail
