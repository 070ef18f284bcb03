#pragma once

#include <ImathBox.h>

#include <cstddef>
#include <span>
#include <vector>

#include "interflect/scene.h"

namespace interflect::inline detail {

/// Bounding box of a face, as input of core_of().
struct FaceExtent {
    Imath::V3d centre{0, 0, 0};  ///< Centre of the box [m].
    double size = 0;             ///< Diagonal of the box [m]; > 0.
};

/// Keeps every k-th face, with the smallest power of two k for which at most `capacity` are kept: enough for medians,
/// in constant memory. Deterministic.
class FaceSample {
  public:
    static constexpr std::size_t capacity = 1 << 13;

    /// Whether the next face will be kept. Call once per face.
    bool wants_next() { return offered_++ % stride_ == 0; }
    void add(const FaceExtent& face);
    std::span<const FaceExtent> faces() const { return faces_; }

  private:
    std::vector<FaceExtent> faces_;
    std::size_t offered_ = 0, stride_ = 1;
};

/// Location of most of a scene, robust against a few distant faces.
struct Core {
    Imath::V3d middle{0, 0, 0};  ///< Per axis: median of the face centres, weighted by face size [m].
    double reach = 0;            ///< Distance to which the faces extend from the middle: weighted median [m].
};

/// O(n log n). All zero without faces.
Core core_of(std::span<const FaceExtent> faces);

/// Origin that preserves the precision of single-precision vertices. It is 0 if the middle is within 8 times the reach
/// (at most 3 bits are lost); otherwise the middle, rounded to a multiple of a power of two near the reach, which keeps
/// exact coordinates exact.
Imath::V3d origin_for(const Core& core);

/// Bounding box that defines the scene's size, relative to the scene's origin [m]. Ignores faces whose centre is
/// farther from the middle than 64 times the reach. O(patches).
Imath::Box3f core_bounds(const Scene& scene);

}  // namespace interflect::inline detail
