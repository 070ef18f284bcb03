#pragma once

#include <vector>

#include "interflect/scene.h"
#include "interflect/solve.h"

namespace interflect::inline detail {

/// Minimum area of elements, by the views and the size of surfaces, not of the world.
class ElementFloor {
  public:
    ElementFloor(const Scene& scene, const SolveOptions& options);

    /// Smallest area that a pixel of any view covers there [m^2]; infinite without views.
    float pixel_area(const V3f& centre, const V3f& normal) const;

    /// @param is_seen  Selects pixel_area(), else unseen().
    /// @return         [m^2]; RefinementOptions::min_area if given.
    float min_area(const V3f& centre, const V3f& normal, bool is_seen) const;

    /// default_element_size() squared [m^2].
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
