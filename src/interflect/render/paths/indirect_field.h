#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "interflect/base/sums/common_stop.h"
#include "interflect/core.h"
#include "interflect/geometry/search/box_tree.h"
#include "interflect/render/paths/group_mean.h"
#include "interflect/render/paths/surface_points.h"
#include "interflect/render/rays/path_plan.h"
#include "interflect/render/smooth/local_fit.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Indirect irradiance, interpolated between sparse records (irradiance caching, Ward et al. 1988), which average the
/// noise of a solution. Their reach is a share of the harmonic mean length of their rays that hit a surface, and ends
/// at contacts. Values are local linear fits. Immutable, thread-safe.
///
/// Biased by interpolation. Each record is compared with the fit of its neighbours: where they differ by more than a
/// tenth of all irradiance and their noise, both reach half as far. The remaining difference is part of Light::error.
/// Without near neighbours a record has no such difference. The number of rays of a record follows the spread among its
/// own and near rays; in twenty rooms this changed means by less than 0.02%.
class IndirectField {
  public:
    /// Makes records at points that others do not cover. Each point is tested once: shorter reaches can leave gaps.
    /// @param plan  With known light; its records gather as it does.
    /// If stopped, ends with fewer records: within milliseconds, with several ranks within seconds. Collective.
    IndirectField(const PathPlan& plan, std::span<const SurfacePoint> points, const Monitor& monitor);

    struct Light {
        Rgb irradiance;  ///< [as H]
        float error;     ///< Standard error of the records and error of interpolation, mean of the channels [as H].
        float reach;     ///< Reach of the nearest record [m].
        std::uint32_t record;  ///< The nearest.
    };
    /// Returns nullopt without a record in reach.
    std::optional<Light> at(const V3f& x, const V3f& n, PatchIndex patch) const;

    std::size_t size() const { return records_.size(); }
    SurfacePoint place(std::size_t record) const {
        return {records_[record].position, records_[record].normal, records_[record].patch};
    }
    /// Calls visit(record, squared distance relative to its reach) for records in whose reach a point is.
    template <class Visit>
    void visit_near(const V3f& x, const V3f& n, PatchIndex patch, const Visit& visit) const {
        visit_box_tree(
            std::span<const Boxed>(tree_), [&](const Imath::Box3f& box) { return box.intersects(x); },
            [&](std::uint32_t i) {
                const float distance2 = reaches_[i].relative_distance2(x, n, patch);
                if (distance2 < 1) visit(reaches_[i].record, distance2);
            });
    }

    std::int64_t rays() const { return rays_; }

  private:
    struct Record {
        V3f position, normal;
        PatchIndex patch{};
        float spacing = 0;          // of the points [m]
        float reach = 0;            // on its own patch, which no contact crosses [m]
        float reach_elsewhere = 0;  // at most the distance to the nearest contact [m]
        float irradiance = 0;       // luminance of all irradiance there, for relative errors [as H]
        GroupMean gathered{};       // irradiance by groups of paths [as H]
        double difference = 0;      // half that between the halves of the groups: sum of mean channels [as H]
        float group_variance = 0;   // of the mean channel of a group, pooled over near records
        float squared_bias = 0;     // of interpolation near the record, mean channel

        float variance() const { return group_variance / static_cast<float>(gathered.groups); }
    };
    /// Position and reach of a record, apart from its light: most records that a lookup tests are out of reach.
    struct Reach {
        V3f position, normal;
        PatchIndex patch{};
        float inverse_square = 0, inverse_square_elsewhere = 0;  // of Record::reach and reach_elsewhere [1/m^2]
        std::uint32_t record = 0;

        /// Squared distance relative to the reach; 1 or more beyond it.
        float relative_distance2(const V3f& x, const V3f& n, std::uint32_t of_patch) const;
    };

    struct Fit {
        LocalFit values;
        std::uint32_t nearest = none;  // record
    };
    /// @param omitted  Record, or none.
    Fit fit_at(const V3f& x, const V3f& n, PatchIndex patch, std::uint32_t omitted = none) const;
    void cover(const PathPlan& plan, std::span<const SurfacePoint> points, const Monitor& monitor,
               const CommonStop& stop);
    std::vector<SurfacePoint> uncovered_among(std::span<const SurfacePoint> points, Ranks* ranks) const;
    /// Returns whether a stop was due.
    bool gather(const PathPlan& plan, std::span<const std::uint32_t> chosen, std::size_t groups, const CommonStop& stop,
                std::vector<float>* lengths = nullptr);
    bool add_records(const PathPlan& plan, std::span<const SurfacePoint> points, const CommonStop& stop);
    void arrange_tree();
    void pool_variances();
    /// Difference between record i and the fit of its neighbours, mean channel; nullopt without enough of them.
    struct Residual {
        double square, variance;
    };
    std::optional<Residual> residual(std::uint32_t i) const;
    /// Halves the reach of new records, and of their neighbours, where interpolation fails.
    void shorten_reaches(std::size_t first_new);
    void estimate_bias();
    void refine_noisy_records(const PathPlan& plan, const CommonStop& stop);
    /// Returns the mean over the records.
    float mean_irradiance() const;
    /// Returns the logarithm of the geometric mean over the lit records.
    float log_mean_irradiance() const;
    /// Returns the distance to the nearest contact, at most max_distance [m].
    float distance_to_contact(const V3f& x, float max_distance) const;

    std::vector<Contact> contacts_;
    std::vector<Boxed> contact_tree_;
    std::vector<Record> records_;
    std::vector<Boxed> tree_;  // boxes of reaches_, which are in the same order
    std::vector<Reach> reaches_;
    std::int64_t rays_ = 0;
};

}  // namespace interflect::detail
