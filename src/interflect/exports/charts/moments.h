#pragma once

#include <cmath>

#include "interflect/exports/mesh/flat_patches.h"

namespace interflect::detail {

/// Area and moments of counter-clockwise patches in a plane.
class Moments {
  public:
    void add(const FlatPatch& flat) {
        for (std::size_t c = 2; c < flat.outline().size(); ++c) {
            const Imath::V2d &a = flat.corners[0], &b = flat.corners[c - 1], &d = flat.corners[c], sum = a + b + d;
            const double area = (b - a).cross(d - a) / 2;
            area_ += area;
            first_ += area / 3 * sum;
            for (const Imath::V2d& x : {a, b, d, sum}) {
                xx_ += area / 12 * x.x * x.x;
                xy_ += area / 12 * x.x * x.y;
                yy_ += area / 12 * x.y * x.y;
            }
        }
    }

    /// Returns the area relative to a rectangle with the same second moments: 1 for rectangles, 1.05 for discs, less
    /// for stars and bent strips.
    double fill() const {
        const Imath::V2d mean = first_ / area_;
        const double xx = xx_ / area_ - mean.x * mean.x, xy = xy_ / area_ - mean.x * mean.y,
                     yy = yy_ / area_ - mean.y * mean.y;
        return area_ / (12 * std::sqrt(xx * yy - xy * xy));  // sides a and b have the moments a^2 / 12 and b^2 / 12
    }

  private:
    double area_ = 0;
    Imath::V2d first_{0, 0};
    double xx_ = 0, xy_ = 0, yy_ = 0;
};

}  // namespace interflect::detail
