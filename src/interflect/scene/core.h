#pragma once

#include <ImathBox.h>

#include <cstddef>
#include <span>
#include <vector>

#include "interflect/scene.h"

namespace interflect::inline detail {

/// A face as the search for the core of a scene sees it.
struct FaceExtent {
    Imath::V3d centre{0, 0, 0};  ///< Of its bounding box [m].
    double size = 0;             ///< That box's diagonal [m]; > 0.
};

/// Keeps every k-th of the faces that it is offered, with k such that at most `capacity` are kept: enough for medians,
/// in little memory whatever the size of the scene. Deterministic.
class FaceSample {
  public:
    static constexpr std::size_t capacity = 1 << 13;

    /// Whether the next face will be kept; each face is offered once, by this function.
    bool wants_next() { return offered_++ % stride_ == 0; }
    void add(const FaceExtent& face);
    std::span<const FaceExtent> faces() const { return faces_; }

  private:
    std::vector<FaceExtent> faces_;
    std::size_t offered_ = 0, stride_ = 1;
};

/// Where most of a scene lies. A few faces far away do not move it.
struct Core {
    Imath::V3d middle{0, 0, 0};  ///< On each axis the median of the faces' centres, weighted by their sizes [m].
    double reach = 0;            ///< Median, weighted alike, of how far the faces reach from there [m].
};

/// O(n log n). All zero where there is no face.
Core core_of(std::span<const FaceExtent> faces);

/// The origin that keeps the precision of single-precision vertices: 0 where the middle is no farther from it than 8
/// times the reach (at most 3 bits are lost), else the middle, rounded to a power of two of about the reach: what is
/// exact in the file stays exact.
Imath::V3d origin_for(const Core& core);

/// The bounding box of what counts as the scene's size: of the vertices of all faces but those whose centre is farther
/// from the middle than 64 times the reach. Relative to the scene's origin [m]. O(patches).
Imath::Box3f core_bounds(const Scene& scene);

}  // namespace interflect::inline detail
