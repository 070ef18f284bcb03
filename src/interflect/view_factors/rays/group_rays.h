#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interflect/base/numbers/points.h"
#include "interflect/geometry/polygons/patch_geometry.h"
#include "interflect/ray_caster.h"
#include "interflect/view_factors.h"

namespace interflect::detail {

/// Rays that leave a group of patches: origins uniform on its uncovered area, directions of density cos(theta) / pi.
class GroupRays {
  public:
    GroupRays(const Scene& scene, const RayCaster& ray_caster, const FaceGroup& group);

    double area() const { return area_; }  ///< Uncovered area [m^2].

    struct Batch {
        PointBlock points;
        std::vector<Ray> rays;
        std::vector<Ray> probes;  // rays down to the start points, to find those on covered parts
        std::vector<Hit> hits;
        std::vector<std::uint32_t> sources;  // index into sources_ of each ray
    };
    /// Generates the rays from `first` on of the sequence `key` in batch.rays. Omits rays that start on covered parts.
    /// @param count  At most PointBlock::capacity.
    void make(std::uint64_t key, std::uint64_t first, std::size_t count, Batch& batch) const;

  private:
    struct Source {
        PatchGeometry geometry;
        PatchIndex patch;
        float offset;            // of the rays' origins above the patch [m]
        double area_up_to_here;  // cumulative area, with covered parts [m^2]
    };
    void drop_covered_starts(Batch& batch) const;

    const RayCaster& ray_caster_;
    std::vector<Source> sources_;  // patches that are not covered completely
    double area_ = 0;
    bool has_covered_parts_ = false;
};

}  // namespace interflect::detail
