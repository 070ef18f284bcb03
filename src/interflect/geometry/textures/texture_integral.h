#pragma once

#include <ImathVec.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "interflect/scene.h"

namespace interflect::detail {

/// Exact means, over triangles, of a texture f that texel_at() filters. By Green's theorem, the integral over a
/// triangle is the integral of F dy along its border, with dF/dx = f. F is cubic between texel lines, so Simpson's rule
/// is exact.
class TextureIntegral {
  public:
    /// @param texture  It must have no faults and must outlive this object.
    explicit TextureIntegral(const Texture& texture);

    /// Returns the mean over a triangle or line in texture coordinates. The cost is proportional to the texels along
    /// the border; above a million texels, returns the mean of the whole texture.
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
    std::vector<RgbD> sums_;  // per row: sums of the texels before every eighth one, then the sum of the whole row
    Rgb largest_;
    RgbD mean_{0, 0, 0};
};

}  // namespace interflect::detail
