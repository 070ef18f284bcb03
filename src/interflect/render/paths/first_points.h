#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "interflect/core.h"
#include "interflect/render/lights/light_sources.h"
#include "interflect/render/rays/path_plan.h"
#include "interflect/render/rays/path_rays.h"
#include "interflect/render/rays/sample_batch.h"

namespace interflect::detail {

/// Light of the first points of paths in hybrid shading.
///
/// Direct light of each kind of source: let U be the unoccluded irradiance of a point, f / p the unoccluded
/// contribution of a shadow ray (irradiance over density) and V its visibility. The estimate of the point is
///
///     E = c U + (sum of V f / p - c sum of f / p) / rays
///
/// U is a control variate: the expected value is the mean of V f / p for any coefficient c that does not depend on
/// these shadow rays. Hence c comes from the other half of the batch, as the visible share of its shadow rays from
/// points with similar normals (cross-fitting). The estimate is unbiased for any number of samples. If all or none are
/// visible, c = V and only U has noise.
///
/// Indirect light: each group of near points on a patch shares a lookup of IndirectField. It is biased by the
/// interpolation. PathLight::record_error contains noise and bias.
class FirstPoints {
  public:
    explicit FirstPoints(const PathPlan& plan) : plan_(plan) {}
    void clear() {
        groups_.clear();
        points_.clear();
    }

    /// Result of looking up the recorded indirect light of a group of points.
    struct Lookup {
        bool is_found = false;
        std::uint32_t guide = none;  ///< Record whose SkyGuide samples the visible sky; none: no sky is visible.
    };
    /// Adds the indirect light of the path's vertex to `light`. Near points of a batch with the same patch and normal
    /// share the lookup at the first of them, which may belong to the other half.
    Lookup add_indirect(const Path& path, PathLight& light);

    /// Adds the path's vertex and computes its unoccluded light, for the kinds of sources that have it. Returns the
    /// index of the point.
    /// @param numbers  Random numbers that place the strata of UnoccludedLight.
    std::uint32_t add(const Path& path, const LightSample& numbers);
    /// Adds the contribution of a shadow ray, f / (p rays), and later its visible part.
    void add_sampled(std::uint32_t point, SourceKind kind, const Rgb& irradiance) {
        at(point, kind).sampled += irradiance;
    }
    void add_visible(std::uint32_t point, SourceKind kind, const Rgb& irradiance) {
        at(point, kind).visible += irradiance;
    }

    /// Adds direct light to the sums of the half batches 2 k and 2 k + 1, which are the halves of one batch.
    void add_direct(std::span<PathLight> halves) const;

  private:
    struct Source {
        Rgb unoccluded{0, 0, 0}, sampled{0, 0, 0}, visible{0, 0, 0};  // irradiance
    };
    struct Point {
        std::uint32_t half_batch;
        V3f normal;
        Rgb throughput;
        std::array<Source, source_kinds.size()> sources{};
    };
    struct Group {
        std::uint32_t batch = none, patch = none;
        V3f normal{0, 0, 0}, position{0, 0, 0};
        float radius = 0;  // points within this distance share the lookup [m]: half the reach of the nearest record
        Lookup lookup{};
        Rgb irradiance{0, 0, 0};
        float error = 0;  // standard error, mean channel
    };
    Source& at(std::uint32_t point, SourceKind kind) { return points_[point].sources[static_cast<std::size_t>(kind)]; }
    const Group& group_of(const Path& path);

    const PathPlan& plan_;
    std::vector<Group> groups_;
    std::vector<Point> points_;
};

}  // namespace interflect::detail
