#pragma once

#include <optional>
#include <vector>

#include "interflect/image.h"
#include "interflect/render.h"

namespace interflect::detail {

/// Light of a picture of few pixels, interpolated over the surfaces that it shows. Immutable, thread-safe.
class CoarseLight {
  public:
    /// @param layers  Layers of the picture. @param picture  Its light, without noise.
    CoarseLight(const PictureLayers& layers, const Image& picture);

    /// Returns the reflected light per reflectance at a point of a surface: irradiance / pi, or irradiance in pictures
    /// of it. Returns nullopt if no near pixel shows the surface.
    /// @param column, row  Position in the picture [pixels]. @param x, n  Point and shading normal.
    std::optional<Rgb> at(float column, float row, const V3f& x, const V3f& n) const;

  private:
    /// Mean surface of a pixel.
    struct Pixel {
        V3f position{0, 0, 0}, normal{0, 0, 0};
        float inverse_spacing = 0;  // 1 / distance between the points of adjacent pixels [1/m]; 0: no surface
        Rgb reflected{0, 0, 0}, albedo{0, 0, 0};
    };

    int width_, height_;
    std::vector<Pixel> pixels_;
};

}  // namespace interflect::detail
