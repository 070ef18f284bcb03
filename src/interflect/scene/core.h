#pragma once

#include <ImathBox.h>

#include <cstddef>
#include <span>
#include <vector>

#include "interflect/scene.h"

namespace interflect::detail {

struct FaceExtent {
    Imath::V3d centre{0, 0, 0};  ///< [m]
    double size = 0;             ///< Diagonal of the bounding box [m]; > 0.
};

/// Keeps every k-th face, with k a power of two: enough for medians. Deterministic.
class FaceSample {
  public:
    static constexpr std::size_t capacity = 1 << 13;

    /// Call once per face.
    bool wants_next() { return offered_++ % stride_ == 0; }
    void add(const FaceExtent& face);
    std::span<const FaceExtent> faces() const { return faces_; }

  private:
    std::vector<FaceExtent> faces_;
    std::size_t offered_ = 0, stride_ = 1;
};

/// Location and extent of a scene, robust against distant faces.
struct Core {
    Imath::V3d middle{0, 0, 0};  ///< Median of the face centres per axis, weighted by size [m].
    double reach = 0;            ///< Weighted median of each face's distance from the middle plus half its size [m].
};

/// All zero without faces. O(n log n).
Core core_of(std::span<const FaceExtent> faces);

/// Returns an origin that preserves the precision of float vertices. It is 0 if the middle is within 8 reaches, which
/// costs at most 3 bits. Otherwise it is the middle, rounded to a multiple of the power of two above the reach, so
/// exact coordinates stay exact.
Imath::V3d origin_for(const Core& core);

/// Returns the bounding box, relative to the scene's origin [m], of faces whose centre is within 64 reaches of the
/// middle. O(patches).
Imath::Box3f core_bounds(const Scene& scene);

}  // namespace interflect::detail
