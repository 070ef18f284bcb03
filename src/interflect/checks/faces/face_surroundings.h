#pragma once

#include <cstdint>

#include "interflect/ray_caster.h"
#include "interflect/scene.h"

namespace interflect::detail {

enum class Side { front, back };

/// Fractions of the rays from a side of a face.
struct Surroundings {
    float blocked = 0;  ///< Hit within a tenth of the face's size.
    float escaped = 0;  ///< Left the scene.
    float one_way = 0;  ///< Hit an object that returns no light (is_one_way()).
};

/// Samples the space around a face with rays.
class FaceSurroundings {
  public:
    FaceSurroundings(const Scene& scene, const RayCaster& ray_caster);

    /// Traces 64 rays and their reversed rays.
    Surroundings measure(PatchIndex patch, Side side) const;
    /// Whether paths from a lamp stay in a small box for eight reflections. Its diagonal is the larger of five lamp
    /// sizes and 0.5 m, but at most a tenth of the scene's. Traces 64 paths through glass, regardless of reflectance.
    bool is_enclosed(PatchIndex patch) const;

  private:
    template <class Start>
    bool stays_within(float extent, const Start& start) const;

    const Scene& scene_;
    const RayCaster& ray_caster_;
    float scene_size_;  // [m]
};

}  // namespace interflect::detail
