#pragma once

#include <ImathVec.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "interflect/texture.h"

namespace interflect::inline detail {

/// Means of a texture, filtered and repeated as texel_at() has it, over triangles of its plane. They are exact, by
/// Green's theorem: the integral of f over a triangle is that of F dy along its border, where dF/dx = f; between two
/// lines of texel centres, F is a cubic, which Simpson's rule integrates exactly. Memory: 3 bytes a texel.
class TextureIntegral {
  public:
    /// @param texture  Without faults; must outlive this.
    explicit TextureIntegral(const Texture& texture);

    /// The mean over the triangle with these corners, texture coordinates; of one without an area that over the line
    /// that it is. In the range of the texels. O(texels along the border), but where these are more than a million,
    /// the whole texture's mean is given.
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
    std::vector<RgbD> sums_;  // of each row's texels before every eighth one, and of all of them
    Rgb largest_;
    RgbD mean_{0, 0, 0};
};

}  // namespace interflect::inline detail
