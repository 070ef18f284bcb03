#pragma once

#include <vector>

#include "interflect/scene.h"
#include "interflect/solve.h"

namespace interflect::inline detail {

/// The smallest area that elements are divided to. Depends on the views and on how large the scene's surfaces are, not
/// on the size of the world.
class ElementFloor {
  public:
    ElementFloor(const Scene& scene, const SolveOptions& options);

    /// The area that a pixel of the nearest view shows of a surface there [m^2]; infinite where there is no view.
    float pixel_area(const V3f& centre, const V3f& normal) const;

    /// @param is_seen  By a view: then the area that a pixel of the nearest view shows there; else as below.
    /// @return         [m^2]; RefinementOptions::min_area wherever that is given.
    float min_area(const V3f& centre, const V3f& normal, bool is_seen) const;

    /// Where no view looks: the square of default_element_size().
    float unseen() const { return unseen_; }

  private:
    struct Eye {
        V3f position;
        float pixel;  // width at distance 1
    };
    std::vector<Eye> eyes_;
    float unseen_;
    bool is_given_;
};

}  // namespace interflect::inline detail
