#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "interflect/base/numbers/fixed_point.h"
#include "interflect/base/numbers/points.h"
#include "interflect/base/numbers/random.h"
#include "interflect/base/threads/parallel.h"
#include "interflect/elements/forest.h"
#include "interflect/ray_caster.h"
#include "interflect/raycast/panes.h"
#include "interflect/solver/sampling/ray_allocation.h"
#include "interflect/solver/sampling/ray_maker.h"
#include "interflect/solver/state/solver_state.h"

namespace interflect::detail {

/// Number of paths that are traced together, enough for long batches of Embree.
inline constexpr std::size_t paths_per_task = 4096;
/// Maximum expected number of copies of a particle at a hit.
inline constexpr double max_copies = 8;
/// Ratio of received to expected power at which a sum overflows. It leaves 2^45 fixed-point units for the expected
/// power.
inline constexpr double sum_headroom = 0x1p16;
enum class WalkPurpose : std::uint64_t {
    light = 1,
    importance,
    pilot,
    batch,
    allocation,
    emission,
    survival,
    reflection
};

constexpr std::uint64_t sub_key(std::uint64_t key, WalkPurpose purpose, std::uint64_t index = 0) {
    return mix(mix(key, static_cast<std::uint64_t>(purpose)), index);
}

/// Source of particles, which carry light or importance (Eq. 7). The arrays have an entry for each element, of which
/// leaves are used. In `emitted` and `density`, entries for luminaire parts follow (Emission).
struct WalkSource {
    std::vector<Rgb> emitted;      ///< Emitted power W [lm or W], or reflected view importance rho V.
    std::vector<Rgb> reflectance;  ///< Reflectance rho, or the mean of its channels.
    std::vector<float> density;    ///< Particles per unit of leaving power, up to a common factor; >= 0.
    bool is_grey = false;          ///< Whether panes transmit the mean of their channels.
    /// Whether reflected particles start at hit points, not uniformly on the leaf. If true, hits are counted.
    bool starts_at_hits = false;
};

/// Number of hits. A hit behind panes counts as the transmitted share of its particle's power.
class HitSum {
  public:
    void add_concurrent(double share) {
        add_concurrently(sum_, std::llround(share / unit));
        add_concurrently(squares_, std::llround(share * share / unit));
    }
    HitSum& operator+=(const HitSum& other) {
        sum_ += other.sum_;
        squares_ += other.squares_;
        return *this;
    }
    double sum() const { return static_cast<double>(sum_) * unit; }
    /// Returns the sum of the squares, which is the variance of sum().
    double squares() const { return static_cast<double>(squares_) * unit; }

  private:
    static constexpr double unit = 0x1p-16;  // fixed-point unit, which makes sums independent of the order

    std::int64_t sum_ = 0, squares_ = 0;
};

/// Sums of each leaf.
struct PathSums {
    FixedPoint unit;
    std::vector<FixedPoint::Value> received;
    FixedPoint::Value escaped{};
    std::vector<std::int64_t> started;  ///< Number of rays that left each leaf.
    std::vector<HitSum> hits;           ///< Empty unless the source counts them.
    std::int64_t rays = 0, escaped_rays = 0;

    /// @param most_hits  Maximum number of hits per ray; more than 1 with panes.
    PathSums(const WalkSource& walk_source, double most_hits)
        : unit(sum_headroom * most_hits * max_expected(walk_source)),
          received(walk_source.reflectance.size()),
          started(walk_source.reflectance.size(), 0),
          hits(walk_source.starts_at_hits ? walk_source.reflectance.size() : 0) {}

    static double max_expected(const WalkSource& walk_source) {
        double power = 0, rho = 0;
        for (const Rgb& w : walk_source.emitted) power += static_cast<double>(largest_channel(w));
        for (const Rgb& r : walk_source.reflectance) rho = std::max(rho, static_cast<double>(largest_channel(r)));
        return power / (1 - rho);
    }
};

/// Power that will leave a leaf or luminaire part as one ray.
struct Particle {
    std::uint32_t source;  ///< Leaf, or size of the forest + luminaire part.
    PatchIndex patch;      ///< Patch of the leaf; none for luminaires.
    Parameters at;         ///< Hit point on the patch, if WalkSource::starts_at_hits.
    Rgb power;
};

/// Particles that a thread traces together.
struct Wavefront {
    std::vector<Particle> particles, reflected;
    std::vector<Ray> rays;
    std::vector<Parameters> origins;
    std::vector<Hit> hits;
    std::vector<Panes::HitBehind> behind;
    PointBlock points;

    void make_room_for_rays() {
        rays.resize(particles.size());
        origins.resize(particles.size());
        hits.resize(particles.size());
    }
};

/// Paths of particles that are traced to their end.
class PathBatch {
  public:
    PathBatch(const SolverState& state, const WalkSource& walk_source, std::int64_t paths, std::uint64_t key)
        : forest_(*state.light.forest),
          elements_(forest_.size()),
          emission_(state.inputs.emission),
          ray_caster_(state.inputs.ray_caster),
          panes_(state.inputs.scene, state.inputs.ray_caster),
          stop_(state.work.stop.within_process()),
          first_points_(state.light.options().experimental.points),
          walk_source_(walk_source),
          paths_(paths),
          key_(key),
          sums_(walk_source, panes_.empty() ? 1 : 1 + Panes::max_consecutive_panes) {
        const auto weight = [&](std::size_t i) {
            return static_cast<double>(channel_sum(walk_source.emitted[i])) * walk_source.density[i];
        };
        double sum = 0;
        for (std::size_t i = 0; i < walk_source.emitted.size(); ++i) sum += weight(i);
        if (!(sum > 0)) return;
        unit_power_ = sum / static_cast<double>(paths);
        for (std::size_t i = 0; i < walk_source.emitted.size(); ++i) q_.push_back(static_cast<float>(weight(i) / sum));
        allocation_.emplace(q_, paths, random_double(sub_key(key, WalkPurpose::allocation), 0));
    }

    /// Traces all paths. Returns their sums.
    const PathSums& follow() {
        if (!(unit_power_ > 0)) return sums_;
        PerThread<Wavefront> wavefronts;
        const auto follow_some = [&](std::size_t begin, std::size_t end) {
            follow(static_cast<std::int64_t>(begin), static_cast<std::int64_t>(end), wavefronts.local());
        };
        parallel_for_ranges(static_cast<std::size_t>(paths_), paths_per_task, stop_, follow_some);
        return sums_;
    }

  private:
    void follow(std::int64_t begin, std::int64_t end, Wavefront& w) {
        const auto task = static_cast<std::uint64_t>(begin);
        emit(begin, end, w);
        for (std::uint64_t bounce = 1; !w.particles.empty(); ++bounce) {
            ray_caster_.trace(w.rays, w.hits);
            panes_.trace(w.rays, w.hits, w.behind);
            score(w);
            survive(random_double(sub_key(key_, WalkPurpose::survival, task), bounce), w);
            reflect(mix(sub_key(key_, WalkPurpose::reflection, task), bounce), w);
        }
    }

    /// Returns a number of the source that does not depend on the rest of the mesh.
    std::uint64_t number_of(std::uint32_t source) const {
        if (source >= elements_) return source - elements_ + forest_.patch_count();
        if (source < forest_.patch_count()) return source;
        const ElementIndex leaf(source);
        return static_cast<std::uint64_t>(forest_.path(leaf)) << 32 | forest_.patch(leaf);
    }

    /// Starts paths. Each of N paths starts at source s with probability q_s and carries the power W_s / (N q_s).
    void emit(std::int64_t begin, std::int64_t end, Wavefront& w) const {
        w.particles.resize(static_cast<std::size_t>(end - begin));
        w.make_room_for_rays();
        const auto emit_some = [&](std::size_t source, std::int64_t first, std::int64_t from, std::int64_t to) {
            const auto s = static_cast<std::uint32_t>(source);
            const auto offset = static_cast<std::size_t>(from - begin), count = static_cast<std::size_t>(to - from);
            const double share =
                unit_power_ / walk_source_.density[s] / static_cast<double>(channel_sum(walk_source_.emitted[s]));
            const PatchIndex patch = s < elements_ ? forest_.patch(ElementIndex(s)) : no_patch;
            const Particle particle{s, patch, {}, Rgb(RgbD(walk_source_.emitted[s]) * share)};
            std::fill_n(&w.particles[offset], count, particle);
            const std::uint64_t key = sub_key(key_, WalkPurpose::emission, number_of(s));
            const auto first_sample = static_cast<std::uint64_t>(from - first);
            const std::span<Ray> rays = std::span(w.rays).subspan(offset, count);
            if (s < elements_)
                shoot_rays(forest_.geometry(patch), forest_.cell(ElementIndex(s)), ray_caster_.ray_offset(patch),
                           first_points_, key, first_sample, w.points, rays,
                           std::span(w.origins).subspan(offset, count));
            else
                emission_.shoot(s - elements_, first_points_, key, first_sample, w.points, rays);
        };
        allocation_->for_each_source(begin, end, emit_some);
    }

    /// Hit leaf, and the hit point on its patch.
    struct HitPlace {
        ElementIndex leaf;
        Parameters at;
    };
    HitPlace hit_place(const Ray& ray, const Hit& hit) const {
        if (!walk_source_.starts_at_hits && forest_.is_leaf(hit.patch)) return {hit.patch, {}};
        const Parameters at = forest_.geometry(hit.patch).parameters_of(ray.origin + hit.distance * ray.direction);
        return {forest_.leaf_at(hit.patch, at), at};
    }

    /// Adds the hits of the particles to the sums, and creates the reflected particles.
    void score(Wavefront& w) {
        FixedPoint::Value escaped{};
        std::int64_t escaped_rays = 0;
        w.reflected.clear();
        const auto arrive = [&](std::size_t i, const Hit& hit, const Rgb& transmittance) {
            const Rgb power = w.particles[i].power * transmittance;
            const FixedPoint::Value term = sums_.unit.from(RgbD(power));
            if (hit.patch == none) {
                for (std::size_t c = 0; c < 3; ++c) escaped[c] += term[c];
                ++escaped_rays;
                return;
            }
            const auto [leaf, at] = hit_place(w.rays[i], hit);
            add_concurrently(sums_.received[leaf], term);
            if (walk_source_.starts_at_hits)
                sums_.hits[leaf].add_concurrent(static_cast<double>(channel_sum(power)) /
                                                static_cast<double>(channel_sum(w.particles[i].power)));
            w.reflected.push_back({leaf, hit.patch, at, walk_source_.reflectance[leaf] * power});
        };
        auto behind = w.behind.begin();
        for (std::size_t i = 0; i < w.particles.size(); ++i) {
            const std::uint32_t source = w.particles[i].source;
            if (source < sums_.started.size()) add_concurrently(sums_.started[source], 1);
            arrive(i, w.hits[i], Rgb(1));
            for (; behind != w.behind.end() && behind->ray == i; ++behind) {
                const Rgb& t = behind->transmittance;
                arrive(i, behind->hit, walk_source_.is_grey ? Rgb(channel_sum(t) / 3) : t);
            }
        }
        add_concurrently(sums_.escaped, escaped);
        add_concurrently(sums_.rays, static_cast<std::int64_t>(w.particles.size()));
        add_concurrently(sums_.escaped_rays, escaped_rays);
    }

    /// Applies Russian roulette and splitting: n copies of a particle continue on average. If n is below its limit, a
    /// copy has the power that a particle emitted at its place would have.
    void survive(double offset, Wavefront& w) const {
        w.particles.clear();
        double cumulative = offset;
        for (const Particle& p : w.reflected) {
            const double n = std::min(
                max_copies, static_cast<double>(channel_sum(p.power)) * walk_source_.density[p.source] / unit_power_);
            const double before = std::floor(cumulative);
            cumulative += n;
            const auto copies = static_cast<std::size_t>(std::floor(cumulative) - before);
            if (copies > 0)
                w.particles.insert(w.particles.end(), copies,
                                   {p.source, p.patch, p.at, p.power * static_cast<float>(1 / n)});
        }
    }

    void reflect(std::uint64_t key, Wavefront& w) const {
        w.make_room_for_rays();
        for (std::size_t i = 0; i < w.particles.size(); ++i) {
            const Particle& p = w.particles[i];
            const PatchGeometry& geometry = forest_.geometry(p.patch);
            const float offset = ray_caster_.ray_offset(p.patch);
            shoot_rays(geometry, forest_.cell(ElementIndex(p.source)), offset, PointSet::random, key, i, w.points,
                       std::span(w.rays).subspan(i, 1), std::span(w.origins).subspan(i, 1));
            if (walk_source_.starts_at_hits) w.rays[i].origin = geometry.point(p.at) + geometry.normal() * offset;
        }
    }

    const ElementForest& forest_;
    const std::uint32_t elements_;
    const Emission& emission_;
    const RayCaster& ray_caster_;
    const Panes panes_;
    const StopRequest& stop_;
    PointSet first_points_;
    const WalkSource& walk_source_;
    std::int64_t paths_;
    std::uint64_t key_;
    PathSums sums_;
    double unit_power_ = 0;  // power of a particle where the density is 1, sum of the channels
    std::vector<float> q_;
    std::optional<RayAllocation> allocation_;
};

}  // namespace interflect::detail
