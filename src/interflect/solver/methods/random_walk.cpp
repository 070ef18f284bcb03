#include "interflect/solver/methods/random_walk.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "interflect/base/fixed_point.h"
#include "interflect/base/parallel.h"
#include "interflect/base/points.h"
#include "interflect/base/random.h"
#include "interflect/elements/forest.h"
#include "interflect/solver/detail.h"
#include "interflect/solver/ray_allocation.h"
#include "interflect/solver/ray_source.h"
#include "interflect/solver/state_archive.h"
#include "interflect/solver/steps.h"

namespace interflect {

namespace {

/// Paths of one task, which traces one bounce of all of them at a time: enough that Embree gets long batches.
constexpr std::size_t paths_per_task = 4096;
/// Most particles that one becomes at a hit; where importance rises more, the next hits split it further.
constexpr double most_copies = 8;
/// How much more than expected a batch may bring before its sums overflow; leaves 2^45 units for the expected.
constexpr double sum_headroom = 0x1p16;
/// Paths of the pilot that finds how long paths are, and the least rays of the batch for each.
constexpr std::int64_t pilot_paths = 512, rays_per_pilot_path = 16;

/// Keys of the random numbers, so that no two purposes share one.
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

/// What particles carry; every vector has an entry for every patch, `emitted` and `density` then for every part of the
/// luminaires where these emit. Importance (Eq. 7) is importance emitted by the
/// cameras: a patch first emits the reflected part of what it received from them, the same in all channels.
struct Payload {
    std::vector<Rgb> emitted;      ///< What leaves a source at first: W [lm or W], or rho V.
    std::vector<Rgb> reflectance;  ///< rho, or the mean of its channels.
    std::vector<float> density;    ///< Particles per unit of power that leaves the patch, times a constant; >= 0.
};

/// What a batch of paths brought, as integers, so that the order of arrival does not matter.
struct Sums {
    FixedPoint unit;
    std::vector<FixedPoint::Value> received;  ///< By every patch.
    FixedPoint::Value escaped{};
    std::vector<std::int64_t> started;  ///< Rays that left every patch.
    std::int64_t rays = 0, escaped_rays = 0;

    explicit Sums(const Payload& payload)
        : unit(sum_headroom * most_expected(payload)),
          received(payload.reflectance.size()),
          started(payload.reflectance.size(), 0) {}

    /// No channel of all that arrives has a greater expected value: what is emitted over 1 - rho.
    static double most_expected(const Payload& payload) {
        double power = 0, rho = 0;
        for (const Rgb& w : payload.emitted) power += static_cast<double>(largest_channel(w));
        for (const Rgb& r : payload.reflectance) rho = std::max(rho, static_cast<double>(largest_channel(r)));
        return power / (1 - rho);
    }
};

/// Power that is about to leave a patch, or a part of the luminaires.
struct Particle {
    std::uint32_t patch;
    Rgb power;
};

/// The particles of one task that are under way; reused by its thread.
struct Wavefront {
    std::vector<Particle> particles, reflected;
    std::vector<Ray> rays;
    std::vector<Parameters> origins;
    std::vector<Hit> hits;
    PointBlock points;

    void make_room_for_rays() {
        rays.resize(particles.size());
        origins.resize(particles.size());
        hits.resize(particles.size());
    }
};

/// One batch of paths, each followed from its emission to its end.
class PathBatch {
  public:
    /// @param paths  > 0.  @param key  Of the batch's random numbers.
    PathBatch(const SolverState& state, const Payload& payload, std::int64_t paths, std::uint64_t key)
        : forest_(*state.forest),
          emission_(state.emission),
          ray_caster_(state.ray_caster),
          stop_(state.stop),
          first_points_(state.options.points),
          payload_(payload),
          paths_(paths),
          key_(key),
          sums_(payload) {
        const auto weight = [&](std::size_t i) {
            return static_cast<double>(channel_sum(payload.emitted[i])) * payload.density[i];
        };
        double sum = 0;
        for (std::size_t i = 0; i < payload.emitted.size(); ++i) sum += weight(i);
        if (!(sum > 0)) return;
        quantum_ = sum / static_cast<double>(paths);
        for (std::size_t i = 0; i < payload.emitted.size(); ++i) q_.push_back(static_cast<float>(weight(i) / sum));
        allocation_.emplace(q_, paths, random_double(sub_key(key, WalkPurpose::allocation), 0));
    }

    const Sums& follow() {
        if (!(quantum_ > 0)) return sums_;
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
            score(w);
            survive(random_double(sub_key(key_, WalkPurpose::survival, task), bounce), w);
            reflect(mix(sub_key(key_, WalkPurpose::reflection, task), bounce), w);
        }
    }

    /// Starts the paths begin ... end - 1. Patch s sends W_s / (N q_s) with each of its own, which are consecutive
    /// points of its sequence.
    void emit(std::int64_t begin, std::int64_t end, Wavefront& w) const {
        w.particles.resize(static_cast<std::size_t>(end - begin));
        w.make_room_for_rays();
        const auto emit_some = [&](std::size_t source, std::int64_t first, std::int64_t from, std::int64_t to) {
            const auto s = static_cast<std::uint32_t>(source);
            const auto offset = static_cast<std::size_t>(from - begin), count = static_cast<std::size_t>(to - from);
            const double share = quantum_ / payload_.density[s] / static_cast<double>(channel_sum(payload_.emitted[s]));
            std::fill_n(&w.particles[offset], count, Particle{s, Rgb(RgbD(payload_.emitted[s]) * share)});
            const std::uint64_t key = sub_key(key_, WalkPurpose::emission, s);
            const auto first_sample = static_cast<std::uint64_t>(from - first);
            const std::span<Ray> rays = std::span(w.rays).subspan(offset, count);
            if (s < forest_.patch_count())
                shoot_rays(forest_.geometry(s), Cell(), ray_caster_.ray_offset(s), first_points_, key, first_sample,
                           w.points, rays, std::span(w.origins).subspan(offset, count));
            else
                emission_.shoot(s - forest_.patch_count(), first_points_, key, first_sample, w.points, rays);
        };
        allocation_->for_each_source(begin, end, emit_some);
    }

    /// Adds every particle to what the patch that it hit receives, and lists what that reflects.
    void score(Wavefront& w) {
        FixedPoint::Value escaped{};
        w.reflected.clear();
        for (std::size_t i = 0; i < w.particles.size(); ++i) {
            const auto& [source, power] = w.particles[i];
            const std::uint32_t patch = w.hits[i].patch;
            const FixedPoint::Value term = sums_.unit.from(RgbD(power));
            if (source < sums_.started.size()) add_concurrently(sums_.started[source], 1);
            if (patch == none) {
                for (std::size_t c = 0; c < 3; ++c) escaped[c] += term[c];
                continue;
            }
            add_concurrently(sums_.received[patch], term);
            w.reflected.push_back({patch, payload_.reflectance[patch] * power});
        }
        add_concurrently(sums_.escaped, escaped);
        add_concurrently(sums_.rays, static_cast<std::int64_t>(w.particles.size()));
        add_concurrently(sums_.escaped_rays, static_cast<std::int64_t>(w.particles.size() - w.reflected.size()));
    }

    /// Russian roulette and splitting: what is reflected goes on as a random number of copies whose mean is n, each
    /// with 1/n of the power. With n = power * density / quantum each copy carries what an emitter there would send.
    /// The copies of a whole wavefront are drawn systematically with one random number, so that their total hardly
    /// varies.
    void survive(double offset, Wavefront& w) const {
        w.particles.clear();
        double cumulative = offset;
        for (const auto& [patch, power] : w.reflected) {
            const double n =
                std::min(most_copies, static_cast<double>(channel_sum(power)) * payload_.density[patch] / quantum_);
            const double before = std::floor(cumulative);
            cumulative += n;
            const auto copies = static_cast<std::size_t>(std::floor(cumulative) - before);
            if (copies > 0) w.particles.insert(w.particles.end(), copies, {patch, power * static_cast<float>(1 / n)});
        }
    }

    /// Makes the rays on which the particles leave.
    void reflect(std::uint64_t key, Wavefront& w) const {
        w.make_room_for_rays();
        for (std::size_t i = 0; i < w.particles.size(); ++i)
            shoot_rays(forest_.geometry(w.particles[i].patch), Cell(), ray_caster_.ray_offset(w.particles[i].patch),
                       PointSet::random, key, i, w.points, std::span(w.rays).subspan(i, 1),
                       std::span(w.origins).subspan(i, 1));
    }

    const ElementForest& forest_;
    const Emission& emission_;
    const RayCaster& ray_caster_;
    const StopRequest& stop_;
    PointSet first_points_;
    const Payload& payload_;
    std::int64_t paths_;
    std::uint64_t key_;
    Sums sums_;
    double quantum_ = 0;    // sum of the channels of a particle where the density is 1
    std::vector<float> q_;  // share of the paths that starts on each patch
    std::optional<RayAllocation> allocation_;
};

/// What one batch brought.
struct Arrived {
    std::vector<Rgb> irradiance;  ///< Of every patch; of importance likewise per area.
    RgbD escaped{0, 0, 0};
    std::int64_t rays = 0;
};

/// Follows so many paths, and enters their rays.
Arrived follow_paths(SolverState& state, const Payload& payload, std::int64_t paths, std::uint64_t key) {
    if (!state.may_begin_step()) throw Interrupted();
    PathBatch batch(state, payload, paths, key);
    const Sums& sums = batch.follow();
    state.has_traced_step = true;
    state.escaped_rays += sums.escaped_rays;
    state.streams.used.resize(sums.started.size(), 0);
    Arrived arrived;
    for (std::uint32_t i = 0; i < sums.received.size(); ++i) {
        arrived.irradiance.push_back(Rgb(sums.unit.to_colour(sums.received[i])) / state.forest->area(i));
        state.streams.used[i] += static_cast<std::uint64_t>(sums.started[i]);
    }
    arrived.escaped = sums.unit.to_colour(sums.escaped);
    arrived.rays = sums.rays;
    return arrived;
}

/// What noise it has if all of it arrives in equal quanta, independently.
FreshEstimate independent_arrivals(const SolverState& state, const Arrived& arrived) {
    const double power = luminance(integral(*state.forest, arrived.irradiance));
    FreshEstimate fresh{arrived.irradiance, {}, {}};
    for (std::uint32_t i = 0; i < arrived.irradiance.size(); ++i)
        fresh.variance.push_back(static_cast<float>(luminance(arrived.irradiance[i]) * power /
                                                    (static_cast<double>(arrived.rays) * state.forest->area(i))));
    return fresh;
}

/// Follows as many paths as take about this many rays.
Arrived walk(SolverState& state, const Payload& payload, std::int64_t rays, PathSeries& series) {
    if (series.pilot_rays == 0) {  // what the pilot finds is thrown away: a batch must not choose its own size
        const std::int64_t paths = std::clamp<std::int64_t>(rays / rays_per_pilot_path, 1, pilot_paths);
        series.pilot_rays = follow_paths(state, payload, paths, sub_key(series.key, WalkPurpose::pilot)).rays;
        series.rays_per_path = static_cast<double>(series.pilot_rays) / static_cast<double>(paths);
    }
    const auto paths = std::llround(static_cast<double>(rays) / std::max(1.0, series.rays_per_path));
    const std::int64_t at_least_one = std::max<std::int64_t>(1, paths);
    Arrived arrived =
        follow_paths(state, payload, at_least_one, sub_key(series.key, WalkPurpose::batch, series.batches));
    series.rays_per_path = static_cast<double>(arrived.rays) / static_cast<double>(at_least_one);
    if (series.batches++ == 0) arrived.rays += series.pilot_rays;
    return arrived;
}

/// What should lead particles from where they are: Eq. 10 in place of Eq. 9 unless asked for, since what leaves a patch
/// matters by where it arrives.
std::vector<float> leading_importance(const Solution& so_far) {
    switch (importance_use(so_far)) {
        case ImportanceUse::off:
            return {};
        case ImportanceUse::direct:
            return so_far.view_importance;
        case ImportanceUse::full:
            break;
    }
    return so_far.options.total_importance ? total_importance(so_far) : so_far.indirect_importance;
}

/// beta + (1 - beta) psi, where psi is relative to its mean over the emitted power: then the share beta of the paths
/// starts by power alone.
std::vector<float> particle_density(const Solution& so_far, const std::vector<Rgb>& emitted) {
    std::vector<float> density = leading_importance(so_far);
    double power = 0, important = 0;
    for (std::size_t i = 0; i < density.size(); ++i) {
        const auto w = static_cast<double>(channel_sum(emitted[i]));
        power += w;
        important += w * density[i];
    }
    if (!(important > 0)) return std::vector<float>(emitted.size(), 1.0f);
    const double beta = so_far.options.beta;
    for (float& d : density) d = static_cast<float>(beta + (1 - beta) * d * power / important);
    return density;
}

Payload light(const SolverState& state) {
    Payload payload;
    for (std::uint32_t i = 0; i < state.forest->patch_count(); ++i) {
        payload.emitted.push_back(state.materials.exitance(i) * state.forest->area(i));
        payload.reflectance.push_back(state.materials.reflectance(i));
    }
    payload.density = particle_density(state.solution, payload.emitted);
    for (std::size_t i = 0; i < state.emission.part_count(); ++i) {
        payload.emitted.emplace_back(state.emission.power(i));
        payload.density.push_back(1);  // the mean: what parts matter to the views is not known
    }
    return payload;
}

Payload importance_from_cameras(const SolverState& state) {
    Payload payload;
    for (std::uint32_t i = 0; i < state.forest->patch_count(); ++i) {
        const float rho = state.materials.mean_reflectance(i);
        payload.emitted.emplace_back(rho * state.solution.view_importance[i] * state.forest->area(i));
        payload.reflectance.emplace_back(rho);
    }
    payload.density.assign(state.forest->patch_count(), 1.0f);
    return payload;
}

}  // namespace

RandomWalks::RandomWalks(const SolverState& state)
    : light_{sub_key(state.options.seed, WalkPurpose::light)},
      importance_{sub_key(state.options.seed, WalkPurpose::importance)} {}

void RandomWalks::prepare(SolverState& state) {
    walk_importance(state, std::min(state.schedule.start_rays(), lacking_importance(state, state.options.rays)));
    state.schedule.began_with(0, state.importance_rays);
}

/// What importance lacks of its share alpha of the rays, where so many are planned in all.
std::int64_t RandomWalks::lacking_importance(const SolverState& state, std::int64_t planned) const {
    if (importance_use(state.solution) != ImportanceUse::full) return 0;
    const std::int64_t share = std::llround(state.options.alpha * static_cast<double>(planned));
    return std::max<std::int64_t>(0, share - importance_history_);
}

void RandomWalks::walk_importance(SolverState& state, std::int64_t rays) {
    if (rays <= 0) return;
    const Arrived arrived = walk(state, importance_from_cameras(state), rays, importance_);
    state.importance_rays += arrived.rays;
    importance_history_ += rays;
    const auto tau = static_cast<float>(static_cast<double>(rays) / static_cast<double>(importance_history_));
    std::vector<float>& psi = state.solution.indirect_importance;
    for (std::size_t i = 0; i < psi.size(); ++i) psi[i] += tau * (arrived.irradiance[i].x - psi[i]);
}

void RandomWalks::walk_light(SolverState& state, std::int64_t rays, const IterationPlan& plan) {
    if (rays <= 0) return;
    const Arrived arrived = walk(state, light(state), rays, light_);
    state.power_rays += arrived.rays;
    const bool tells_of_error = plan.rays >= state.schedule.start_rays();  // a remainder of the rays tells too little
    if (tells_of_error) estimate_noise(state, independent_arrivals(state, arrived), plan.rays);
    const double before = state.history[0], now = before + static_cast<double>(plan.rays);
    const double tau = plan.warms_up ? 1 : static_cast<double>(plan.rays) / now;  // Eq. 6
    for (std::uint32_t i = 0; i < state.forest->size(); ++i)
        state.solution.irradiance[i] +=
            static_cast<float>(tau) * (arrived.irradiance[i] - state.solution.irradiance[i]);
    escaped_ += tau * (arrived.escaped - escaped_);
    std::fill(state.history.begin(), state.history.end(), plan.warms_up ? 0.0f : static_cast<float>(now));
}

void RandomWalks::retarget(SolverState& state) {
    IterationMethod::retarget(state);
    importance_history_ = 0;
    importance_.pilot_rays = 0;
    importance_is_done_ = false;
}

void RandomWalks::archive(StateArchive& archive) {
    archive("random_walk/light", light_);
    archive("random_walk/importance", importance_);
    archive("random_walk/escaped", escaped_);
    archive("random_walk/importance_history", importance_history_);
    archive("random_walk/importance_is_done", importance_is_done_);
    archive("random_walk/for_importance", for_importance_);
    archive("random_walk/rays_before", rays_before_);
}

RgbD RandomWalks::iterate(SolverState& state, IterationPlan& plan) {
    if (!importance_is_done_) {
        rays_before_ = state.power_rays + state.importance_rays;
        for_importance_ = std::min(plan.rays, lacking_importance(state, state.schedule.rays() + plan.rays));
        walk_importance(state, for_importance_);
        importance_is_done_ = true;
    }
    walk_light(state, plan.rays - for_importance_, plan);
    importance_is_done_ = false;
    const std::int64_t traced = state.power_rays + state.importance_rays - rays_before_;
    if (traced > 0) plan.rays = traced;  // else no view shows what reflects, and the plan is used up
    return escaped_;
}

std::unique_ptr<IterationMethod> make_random_walks(SolverState& state) { return std::make_unique<RandomWalks>(state); }

}  // namespace interflect
