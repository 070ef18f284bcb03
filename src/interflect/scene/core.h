#pragma once

#include <ImathBox.h>

#include <cstddef>
#include <span>
#include <vector>

#include "interflect/scene.h"

namespace interflect::detail {

/// Bounding box of a face.
struct FaceExtent {
    Imath::V3d centre{0, 0, 0};  ///< [m]
    double size = 0;             ///< Diagonal [m]; > 0.
};

/// Keeps every k-th face, k being a power of two, so at most `capacity` are kept: enough for medians. Deterministic.
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

/// Location of most of a scene, robust against distant faces.
struct Core {
    Imath::V3d middle{0, 0, 0};  ///< Per axis: median of the face centres, weighted by face size [m].
    double reach = 0;            ///< Extent of the faces from the middle: weighted median [m].
};

/// O(n log n). All zero without faces.
Core core_of(std::span<const FaceExtent> faces);

/// Origin that preserves the precision of single-precision vertices. 0 if the middle is within 8 times the reach, which
/// costs at most 3 bits. Otherwise the middle, rounded to a power of two near the reach, which keeps exact coordinates
/// exact.
Imath::V3d origin_for(const Core& core);

/// Bounding box that defines the scene's size, relative to its origin [m]. Excludes faces whose centre is farther from
/// the middle than 64 times the reach. O(patches).
Imath::Box3f core_bounds(const Scene& scene);

}  // namespace interflect::detail
