#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interflect/core.h"
#include "interflect/render/rays/path_plan.h"
#include "interflect/render/rays/path_rays.h"
#include "interflect/render/rays/sample_batch.h"

namespace interflect::detail {

/// Recorded indirect light at the first points of paths in hybrid shading.
///
/// Near points on a patch share a lookup of IndirectField, whose interpolation biases the light.
/// PathLight::record_error contains noise and bias.
class RecordLookups {
  public:
    explicit RecordLookups(const PathPlan& plan) : plan_(plan) {}
    void clear() { groups_.clear(); }

    /// Result of looking up the recorded indirect light of a group of points.
    struct Lookup {
        bool is_found = false;
        std::uint32_t guide = none;  ///< Record whose SkyGuide samples the visible sky; none: no sky is visible.
    };
    /// Adds the indirect light of the path's vertex to `light`. Near points of a batch with the same patch and normal
    /// share the lookup at the first of them, which may belong to the other half.
    /// @param pixel  Of the path: its gauge in bakes.
    Lookup add_indirect(const Path& path, std::uint32_t pixel, PathLight& light);

  private:
    struct Group {
        std::uint32_t batch = none, patch = none;
        V3f normal{0, 0, 0}, position{0, 0, 0};
        float radius = 0;  // points within this distance share the lookup [m]: half the reach of the nearest record
        Lookup lookup{};
        Rgb irradiance{0, 0, 0};
        float error = 0;  // standard error, mean channel
    };
    const Group& group_of(const Path& path, std::uint32_t pixel);

    const PathPlan& plan_;
    std::vector<Group> groups_;
};

}  // namespace interflect::detail
