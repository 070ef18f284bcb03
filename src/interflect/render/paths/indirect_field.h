#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "interflect/base/common_stop.h"
#include "interflect/core.h"
#include "interflect/geometry/box_tree.h"
#include "interflect/render/paths/part_statistics.h"
#include "interflect/render/smooth/local_fit.h"
#include "interflect/scene.h"

namespace interflect::detail {

struct PathScene;

/// Needs indirect light.
struct SurfacePoint {
    V3f position;  ///< Start of its rays, relative to the scene's origin [m].
    V3f normal;    ///< For shading, unit length.
    std::uint32_t patch = none;
    float spacing = 0;  ///< Distance to the nearest such points: size of a pixel or texel [m].
};

/// Indirect irradiance, interpolated between sparse records (irradiance caching, Ward et al. 1988), which average the
/// noise of a solution. Their reach is a share of the harmonic mean length of their rays, at least a few spacings, and
/// ends at contacts. Values are local linear fits. Immutable, thread-safe.
class IndirectField {
  public:
    /// Makes records until all points are covered.
    /// @param scene  With a known solution; its batches are ignored.
    /// If stopped, ends with fewer records: within milliseconds, with several ranks within seconds. Collective.
    IndirectField(const PathScene& scene, std::span<const SurfacePoint> points, const Monitor& monitor);

    struct Light {
        Rgb irradiance;        ///< [as H]
        std::uint32_t record;  ///< The nearest.
    };
    /// Returns nullopt without a record in reach.
    std::optional<Light> at(const V3f& x, const V3f& n, std::uint32_t patch) const;

    std::size_t size() const { return records_.size(); }
    SurfacePoint place(std::size_t record) const {
        return {records_[record].position, records_[record].normal, records_[record].patch};
    }
    /// Calls visit(record, squared distance relative to its reach) for records in whose reach a point is.
    template <class Visit>
    void visit_near(const V3f& x, const V3f& n, std::uint32_t patch, const Visit& visit) const {
        visit_box_tree(
            std::span<const Boxed>(tree_), [&](const Imath::Box3f& box) { return box.intersects(x); },
            [&](std::uint32_t i) {
                const float distance2 = records_[i].relative_distance2(x, n, patch);
                if (distance2 < 1) visit(i, distance2);
            });
    }

    std::int64_t rays() const { return rays_; }

  private:
    struct Record {
        V3f position, normal;
        std::uint32_t patch = none;
        float reach = 0;            // on its own patch, which no contact crosses [m]
        float reach_elsewhere = 0;  // at most the distance to the nearest contact [m]
        float reach_in_spacings = 0;
        float irradiance = 0;       // luminance of all irradiance there, for relative errors [as H]
        float inverse_length = 0;   // sum of 1 / length over the first rays of its paths [1/m]
        PartStatistics gathered{};  // irradiance by groups of paths [as H]

        /// Squared distance relative to the reach; 1 or more beyond it.
        float relative_distance2(const V3f& x, const V3f& n, std::uint32_t of_patch) const;
    };

    struct Fit {
        LocalFit values;
        std::uint32_t nearest = none;  // record
    };
    Fit fit_at(const V3f& x, const V3f& n, std::uint32_t patch) const;
    void cover(const PathScene& scene, std::span<const SurfacePoint> points, const Monitor& monitor,
               const CommonStop& stop);
    std::vector<SurfacePoint> uncovered_among(std::span<const SurfacePoint> points, Ranks* ranks) const;
    /// Returns whether a stop was due.
    bool gather(const PathScene& scene, std::span<const std::uint32_t> chosen, std::size_t groups,
                const CommonStop& stop);
    bool add_records(const PathScene& scene, std::span<const SurfacePoint> points, const CommonStop& stop);
    void refine_noisy_records(const PathScene& scene, const CommonStop& stop);
    /// Over records, below.
    float mean_irradiance() const;
    /// Geometric mean, of lit records.
    float log_mean_irradiance() const;
    float pooled_variance(const Record& record) const;
    /// At most max_distance.
    float distance_to_contact(const V3f& x, float max_distance) const;

    std::vector<Contact> contacts_;
    std::vector<Boxed> contact_tree_;
    std::vector<Record> records_;
    std::vector<Boxed> tree_;  // boxes of the records' reach
    std::int64_t rays_ = 0;
};

}  // namespace interflect::detail
