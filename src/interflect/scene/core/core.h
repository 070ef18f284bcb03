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

/// Sample of at most `capacity` faces: every k-th one, with k a power of two.
class FaceSample {
  public:
    static constexpr std::size_t capacity = 1 << 13;

    /// Returns whether the next face belongs to the sample. Call once per face.
    bool wants_next() { return (offered_++ & (stride_ - 1)) == 0; }
    void add(const FaceExtent& face);
    std::span<const FaceExtent> faces() const { return faces_; }

  private:
    std::vector<FaceExtent> faces_;
    std::size_t offered_ = 0, stride_ = 1;
};

/// Location and extent of the bulk of a scene, robust against distant faces.
struct Core {
    Imath::V3d middle{0, 0, 0};  ///< Median face centre per axis, weighted by size [m].
    double reach = 0;            ///< Weighted median of the distance from the middle plus half the size [m].
};

/// Returns zeros without faces.
Core core_of(std::span<const FaceExtent> faces);

/// Returns an origin that preserves float precision: 0 if the middle is within 8 reaches, which costs at most 3 bits,
/// else the middle in steps of a power of two, which keeps exact coordinates exact.
Imath::V3d origin_for(const Core& core);

/// Returns the bounding box of the faces with centres within 64 reaches of the middle, relative to the scene's origin
/// [m].
Imath::Box3f core_bounds(const Scene& scene);

}  // namespace interflect::detail
