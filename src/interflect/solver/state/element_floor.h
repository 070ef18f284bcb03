#pragma once

#include <vector>

#include "interflect/scene.h"
#include "interflect/solve_options.h"

namespace interflect::detail {

/// Lower limit of the area of elements, from views and surface sizes.
class ElementFloor {
  public:
    ElementFloor(const Scene& scene, const SolveOptions& options);

    /// Returns the smallest area that a pixel of any view covers [m^2]; infinite without views.
    float pixel_area(const V3f& centre, const V3f& normal) const;

    /// Returns RefinementOptions::min_area if it is given, else pixel_area() if a view shows the element, else
    /// default_min_area() [m^2].
    float min_area(const V3f& centre, const V3f& normal, bool is_seen) const;

    /// Returns default_element_size() squared, or RefinementOptions::min_area if given [m^2].
    float default_min_area() const { return default_min_area_; }

  private:
    struct ViewPoint {
        V3f position;
        float pixel;  // width of a pixel at distance 1
    };
    std::vector<ViewPoint> cameras_;
    float default_min_area_;
    bool is_given_;
};

}  // namespace interflect::detail
