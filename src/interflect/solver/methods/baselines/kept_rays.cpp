#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "interflect/base/threads/parallel.h"
#include "interflect/elements/forest.h"
#include "interflect/raycast/panes.h"
#include "interflect/solver/deposit/contribution_units.h"
#include "interflect/solver/error/noise_update.h"
#include "interflect/solver/iteration/iteration_method.h"
#include "interflect/solver/iteration/merge.h"
#include "interflect/solver/iteration/outdoor_targets.h"
#include "interflect/solver/iteration/run_step.h"
#include "interflect/solver/methods/importance_transport.h"
#include "interflect/solver/methods/passes.h"
#include "interflect/solver/refinement/variance_refinement.h"
#include "interflect/solver/sampling/ray_maker.h"
#include "interflect/solver/sampling/ray_plan.h"
#include "interflect/solver/transport/received.h"

namespace interflect::detail {

namespace {

constexpr std::size_t kept_rays_per_task = 4096;

/// Parameters of a point on a patch, rounded to 16 bits.
struct RoundedParameters {
    std::uint16_t u = 0, v = 0;

    RoundedParameters() = default;
    explicit RoundedParameters(const Parameters& p) : u(rounded(p.u)), v(rounded(p.v)) {}
    Parameters parameters() const { return {middle(u), middle(v)}; }

  private:
    static constexpr float steps = 0x1p16f;
    static std::uint16_t rounded(float x) { return static_cast<std::uint16_t>(std::clamp(x * steps, 0.0f, steps - 1)); }
    static float middle(std::uint16_t x) { return (static_cast<float>(x) + 0.5f) / steps; }
};

struct KeptRay {
    std::uint32_t source;   // leaf or luminaire part
    ElementIndex receiver;  // leaf; no_element if the ray escaped
    RoundedParameters start, end;
};

/// Rays in the order in which they were shot. The continuations behind panes follow the other rays of a step.
struct RaySet {
    enum Kind : std::uint8_t { from_leaf = 0, from_part = 1, behind_pane = 2 };  // bits, which may be combined

    std::vector<KeptRay> rays;
    std::vector<std::uint8_t> kind;
    std::vector<Rgb> transmittance;  // transmittance of panes before the hit; empty in a scene without panes

    std::size_t size() const { return rays.size(); }
    bool is_from_part(std::size_t i) const { return (kind[i] & from_part) != 0; }
    void resize(std::size_t size) {
        rays.resize(size);
        kind.resize(size);
        if (!transmittance.empty()) transmittance.resize(size, Rgb(1));
    }
    /// Returns the index of the ray's source in Quotas.
    std::size_t source(std::size_t i, std::size_t elements) const {
        return rays[i].source + (is_from_part(i) ? elements : 0);
    }
};

/// ContributionUnits with more precise squares. Kept rays carry no importance, so its term stores the rounding errors
/// of the squares. The precision is needed: the squared payload of light through a small hole is 1e-19 of the sum over
/// a landscape.
class PayloadUnits {
  public:
    PayloadUnits(const PayloadTotals& all, std::size_t rays)
        : units_(all, /*max_deposits=*/1), remainder_(units_.square.to_number(1) * static_cast<double>(rays)) {}

    Contribution contribution_of(const RgbD& payload) const {
        Contribution contribution = units_.contribution_of(payload);
        const double square = std::pow(luminance(payload), 2);
        contribution[importance_term] = remainder_.from(square - units_.square.to_number(contribution[3]));
        return contribution;
    }
    RgbD power(const Contribution& sum) const { return units_.power.to_colour({sum[0], sum[1], sum[2]}); }
    double square(const Contribution& sum) const {
        return units_.square.to_number(sum[3]) + remainder_.to_number(sum[importance_term]);
    }

  private:
    ContributionUnits units_;
    FixedPoint remainder_;
};

ElementIndex leaf_within(const ElementForest& forest, ElementIndex e, RoundedParameters point) {
    return forest.is_leaf(e) ? e : forest.leaf_below(e, forest.cell(e), point.parameters());
}

/// Well-distributed rays with importance, which Prikryl et al. 2000 propose as future work. Both ends of every ray are
/// stored. A source of power P_s has a quota of n_s rays. Each of its rays has the payload P_s / n_s, no matter when it
/// was shot (balance heuristic, Veach and Guibas 1995). The children of a divided leaf share its quota by area. When
/// power or importance change, iterations shoot the missing rays.
class KeptRays : public IterationMethod {
  public:
    void prepare(SolverState& state) override;
    void update_importance(SolverState& state, TracedIteration& iteration) override;
    Estimate trace(SolverState& state, TracedIteration& iteration) override;
    void merge(SolverState& state, const Estimate& estimate, const TracedIteration& iteration) override;
    void refine(SolverState& state) override;
    void discard() override { set_.resize(merged_); }
    void change_views(SolverState& state) override;
    void archive(StateArchive& archive) override;
    bool is_consistent(const SolverState& state) const override;

  private:
    /// Number of rays of each element (unused for inner elements), then of each luminaire part.
    using Quotas = std::vector<double>;

    void drop_rays_of_parts(const SolverState& state);
    /// Divides the quotas of divided leaves, and replaces these leaves in the rays by their descendants.
    void follow_forest(const ElementForest& forest);
    void shoot(SolverState& state, const RayPlan& plan);
    /// Computes the light of the elements from `first` on from all rays.
    void receive_again(SolverState& state, std::uint32_t first = 0);
    /// Returns the light of the new rays, and of the kept rays of sources that shoot no new rays.
    Estimate fresh_estimate(SolverState& state, const Quotas& growth) const;
    struct Range {
        std::size_t begin, end;
    };
    /// Returns the light that these rays deposit on the elements from `first` on; only sources with a quota count. The
    /// rays carry the radiosity for which the quotas were planned, because a newer radiosity may be many times as large
    /// on elements with few rays.
    Estimate received(SolverState& state, Range rays, const Quotas& quotas, std::uint32_t first = 0) const;
    /// Returns the number of rays of each source, which may differ from its quota.
    std::vector<std::int64_t> count_rays(Range rays, std::size_t sources) const;
    /// Adds payloads to state.sampling.contributions; returns the escaped power.
    RgbD scatter(SolverState& state, Range rays, const std::vector<RgbD>& payload, const PayloadUnits& units,
                 std::uint32_t first) const;
    static Estimate collect(const LightState& light, SamplingState& sampling, const PayloadUnits& units);

    Passes passes_;
    RaySet set_;
    std::size_t merged_ = 0;  // number of kept rays of complete iterations
    std::uint32_t elements_ = 0;
    std::int64_t all_rays_ = 0;          // number of rays that complete iterations have shot
    Quotas quotas_, next_quotas_;        // quotas of complete iterations, and with the iteration in progress
    std::vector<Rgb> reflected_;         // irradiance that this iteration reflects
    std::vector<Imath::Box3f> targets_;  // targets of the kept rays from luminaire parts
    bool needs_importance_ = false;      // whether the next iteration starts with transport_importance()
};

/// Returns max(quota, x q) for each source; x is chosen so that the sum of the quotas grows by `rays`.
std::vector<double> raised(std::vector<double> quotas, const std::vector<float>& q, double rays) {
    const auto growth = [&](double x) {
        return parallel_sum(q.size(), elements_per_task, 0.0, [&](std::size_t begin, std::size_t end) {
            double sum = 0;
            for (std::size_t s = begin; s < end; ++s) sum += std::max(0.0, x * static_cast<double>(q[s]) - quotas[s]);
            return sum;
        });
    };
    double low = 0, high = 1;
    while (growth(high) < rays) {
        low = high;
        high *= 2;
    }
    constexpr int bisections = 24;
    for (int i = 0; i < bisections; ++i) {
        const double middle = (low + high) / 2;
        (growth(middle) < rays ? low : high) = middle;
    }
    for (std::size_t s = 0; s < q.size(); ++s) quotas[s] = std::max(quotas[s], high * static_cast<double>(q[s]));
    return quotas;
}

void KeptRays::prepare(SolverState& state) {
    passes_.make_first_estimate(state);
    elements_ = state.light.forest->size();
    targets_ = state.inputs.targets;
    quotas_.assign(elements_ + state.inputs.emission.part_count(), 0.0);
}

void KeptRays::update_importance(SolverState& state, TracedIteration& iteration) {
    if (importance_use(state.light.solution) != ImportanceUse::full) return;
    const std::int64_t before = state.rays.importance;
    if (needs_importance_) {
        transport_importance(state, state.rays.schedule.start_rays());
        aim_outdoor_light(state);
        iteration.rays_for_new_views = state.rays.importance - before;
    }
    iteration.importance_rays =
        std::llround(state.light.options().experimental.alpha * static_cast<double>(iteration.plan.rays));
    if (iteration.importance_rays == 0) return;
    const RayPlan rays = plan_importance(state.inputs.materials, state.light.solution,
                                         importance_of(state.light.solution), iteration.importance_rays);
    merge_importance(state.light, state.rays, run_step(state, TransportStep(rays)).importance, iteration);
    state.rays.importance += iteration.importance_rays;
}

Estimate KeptRays::trace(SolverState& state, TracedIteration& iteration) {
    const ElementForest& forest = *state.light.forest;
    const std::int64_t rays = iteration.plan.rays - iteration.importance_rays;
    if (rays == 0) return {};
    if (state.inputs.targets != targets_) drop_rays_of_parts(state);
    follow_forest(forest);
    reflected_ = state.light.solution.irradiance;
    const Radiosity light(state.inputs.materials, reflected_);
    const ImportanceWeights weights = importance_weights(state.light.solution, state.sampling.neighbourhoods,
                                                         state.inputs.emission, state.sampling.part_importance);
    PowerPlan power = plan_power(state.inputs.materials, state.inputs.emission, state.light.solution, light, weights,
                                 /*combined=*/false, rays);
    state.light.solution.non_finite += power.non_finite_leaves;
    if (!(power.power > 0)) return {};
    std::vector<float>& q = power.plan.q;
    // By systematic sampling, the expected number of rays of a source is its quota, also if that is below 1. Quotas
    // must not be compared with the number of existing rays. This would add light, because sources with too few rays by
    // chance would shoot more, while sources with too many rays could not shoot less.
    next_quotas_ = raised(quotas_, q, static_cast<double>(rays));
    for (std::size_t s = 0; s < q.size(); ++s) q[s] = static_cast<float>(next_quotas_[s] - quotas_[s]);
    shoot(state, power.plan);
    state.rays.power += rays;
    return fresh_estimate(state, Quotas(q.begin(), q.end()));
}

Estimate KeptRays::fresh_estimate(SolverState& state, const Quotas& growth) const {
    Estimate fresh = received(state, {merged_, set_.size()}, growth);
    Quotas paused = quotas_;
    for (std::size_t s = 0; s < paused.size(); ++s)
        if (growth[s] > 0) paused[s] = 0;
    if (std::none_of(paused.begin(), paused.end(), [](double quota) { return quota > 0; })) return fresh;
    Estimate shared = received(state, {0, merged_}, paused);
    for (std::size_t e = 0; e < fresh.irradiance.size(); ++e) fresh.irradiance[e] += shared.irradiance[e];
    fresh.shared_variance = std::move(shared.variance);
    return fresh;
}

void KeptRays::drop_rays_of_parts(const SolverState& state) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < merged_; ++i) {
        if (set_.is_from_part(i)) continue;
        set_.rays[kept] = set_.rays[i];
        set_.kind[kept] = set_.kind[i];
        if (!set_.transmittance.empty()) set_.transmittance[kept] = set_.transmittance[i];
        ++kept;
    }
    merged_ = kept;
    set_.resize(kept);
    quotas_.resize(elements_);
    quotas_.resize(elements_ + state.inputs.emission.part_count(), 0.0);
    targets_ = state.inputs.targets;
}

void KeptRays::follow_forest(const ElementForest& forest) {
    if (forest.size() == elements_) return;
    const Quotas of_parts(quotas_.begin() + elements_, quotas_.end());
    quotas_.resize(elements_);
    for (ElementIndex e(elements_); e < forest.size(); ++e)
        quotas_.push_back(quotas_[forest.parent(e)] * forest.area(e) / forest.area(forest.parent(e)));
    quotas_.insert(quotas_.end(), of_parts.begin(), of_parts.end());
    inherit(forest, elements_, reflected_);
    elements_ = forest.size();
    parallel_for_ranges(set_.size(), kept_rays_per_task, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            KeptRay& ray = set_.rays[i];
            if (!set_.is_from_part(i)) ray.source = leaf_within(forest, ElementIndex(ray.source), ray.start);
            if (ray.receiver != none) ray.receiver = leaf_within(forest, ray.receiver, ray.end);
        }
    });
}

void KeptRays::shoot(SolverState& state, const RayPlan& plan) {
    const ElementForest& forest = *state.light.forest;
    const RayMaker maker(forest, state.inputs.ray_caster, plan, state.sampling.streams);
    const Panes panes(state.inputs.scene, state.inputs.ray_caster);
    const auto count = static_cast<std::size_t>(plan.rays);
    set_.resize(merged_ + count);

    // Trace the rays, and store continuations behind panes apart
    struct Behind {
        KeptRay ray;
        std::uint8_t kind;
        Rgb transmittance;
    };
    std::vector<std::vector<Behind>> behind((count + kept_rays_per_task - 1) / kept_rays_per_task);
    const auto kept = [&](const Hit& hit, KeptRay ray, const Ray& traced) {
        if (hit.patch == none) return ray;
        const Parameters p = forest.geometry(hit.patch).parameters_of(traced.origin + hit.distance * traced.direction);
        ray.receiver = forest.leaf_at(hit.patch, RoundedParameters(p).parameters());
        ray.end = RoundedParameters(p);
        return ray;
    };
    parallel_for_ranges(
        count, kept_rays_per_task, state.work.stop.within_process(), [&](std::size_t begin, std::size_t end) {
            thread_local RayBatch batch;
            thread_local std::vector<Hit> hits;
            thread_local std::vector<Panes::HitBehind> hits_behind;
            maker.make(static_cast<std::int64_t>(begin), static_cast<std::int64_t>(end), batch);
            hits.resize(batch.rays.size());
            state.inputs.ray_caster.trace(batch.rays, hits);
            panes.trace(batch.rays, hits, hits_behind);
            auto next = hits_behind.begin();
            for (const SourceRays& of_source : batch.sources) {
                const bool is_part = of_source.source >= forest.size();
                const std::uint8_t kind = is_part ? RaySet::from_part : RaySet::from_leaf;
                const std::uint32_t source = is_part ? of_source.source - forest.size() : of_source.source;
                for (std::uint32_t i = of_source.begin; i < of_source.end; ++i) {
                    const KeptRay ray{
                        source, no_element, is_part ? RoundedParameters() : RoundedParameters(batch.origins[i]), {}};
                    set_.rays[merged_ + begin + i] = kept(hits[i], ray, batch.rays[i]);
                    set_.kind[merged_ + begin + i] = kind;
                    for (; next != hits_behind.end() && next->ray == i; ++next)
                        behind[begin / kept_rays_per_task].push_back(
                            {kept(next->hit, ray, batch.rays[i]), static_cast<std::uint8_t>(kind | RaySet::behind_pane),
                             next->transmittance});
                }
            }
        });

    // Append the continuations in the order of their rays
    if (!panes.empty()) set_.transmittance.resize(set_.size(), Rgb(1));
    for (const std::vector<Behind>& some : behind)
        for (const Behind& b : some) {
            set_.rays.push_back(b.ray);
            set_.kind.push_back(b.kind);
            set_.transmittance.push_back(b.transmittance);
        }
    advance(state.sampling.streams, maker.allocation(), forest.size(), plan.part_count());
    state.rays.escaped += std::count_if(set_.rays.begin() + static_cast<std::ptrdiff_t>(merged_), set_.rays.end(),
                                        [](const KeptRay& ray) { return ray.receiver == none; });
}

Estimate KeptRays::received(SolverState& state, Range rays, const Quotas& quotas, std::uint32_t first) const {
    const ElementForest& forest = *state.light.forest;
    const Radiosity light(state.inputs.materials, reflected_);
    const std::vector<std::int64_t> count = count_rays(rays, quotas.size());
    std::vector<RgbD> payload(quotas.size(), RgbD(0));  // payload of each source's rays
    PayloadTotals totals;
    for (std::uint32_t s = 0; s < quotas.size(); ++s) {
        const ElementIndex leaf(s);
        const bool is_leaf = s < forest.size() && forest.is_leaf(leaf);
        if (!(quotas[s] > 0) || (s < forest.size() && !is_leaf)) continue;
        const RgbD power = is_leaf ? RgbD(light.of(forest, leaf)) * static_cast<double>(forest.area(leaf))
                                   : state.inputs.emission.power(s - forest.size());
        payload[s] = power / quotas[s];
        totals.power += static_cast<double>(count[s]) * payload[s];
        totals.square += static_cast<double>(count[s]) * std::pow(luminance(payload[s]), 2);
    }
    const PayloadUnits units(totals, rays.end - rays.begin);
    const RgbD escaped = scatter(state, rays, payload, units, first);
    Estimate estimate = collect(state.light, state.sampling, units);
    estimate.escaped_power = escaped - state.inputs.emission.repeated_power();
    return estimate;
}

std::vector<std::int64_t> KeptRays::count_rays(Range rays, std::size_t sources) const {
    std::vector<std::int64_t> count(sources, 0);
    parallel_for_ranges(rays.end - rays.begin, kept_rays_per_task, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = rays.begin + begin; i < rays.begin + end;) {
            const std::size_t first = i, source = set_.source(i, elements_);
            while (i < rays.begin + end && set_.source(i, elements_) == source) ++i;
            add_concurrently(count[source], static_cast<std::int64_t>(i - first));
        }
    });
    return count;
}

RgbD KeptRays::scatter(SolverState& state, Range rays, const std::vector<RgbD>& payload, const PayloadUnits& units,
                       std::uint32_t first) const {
    const std::uint32_t elements = state.light.forest->size();
    std::vector<Contribution> contribution(payload.size());
    for (std::size_t s = 0; s < payload.size(); ++s) contribution[s] = units.contribution_of(payload[s]);
    ContributionSums& sums = state.sampling.contributions;
    sums.begin_step(elements);
    using ScatterBuffer = ContributionSums::ScatterBuffer;
    PerThread<ScatterBuffer> buffers([&] { return ScatterBuffer(sums); });
    Contribution escaped{};
    parallel_for_ranges(rays.end - rays.begin, kept_rays_per_task, [&](std::size_t begin, std::size_t end) {
        ScatterBuffer& buffer = buffers.local();
        Contribution escaped_here{};
        for (std::size_t i = rays.begin + begin; i < rays.begin + end; ++i) {
            if (set_.rays[i].receiver < first) continue;
            const std::size_t source = set_.source(i, elements);
            if (payload[source] == RgbD(0)) continue;
            const Contribution power = (set_.kind[i] & RaySet::behind_pane) != 0
                                           ? units.contribution_of(payload[source] * RgbD(set_.transmittance[i]))
                                           : contribution[source];
            if (set_.rays[i].receiver == none)
                for (std::size_t c = 0; c < power.size(); ++c) escaped_here[c] += power[c];
            else
                buffer.add(set_.rays[i].receiver, buffer.add_payload(power), ScatterBuffer::Terms::both);
        }
        buffer.release_payloads();
        for (std::size_t c = 0; c < escaped.size(); ++c) add_concurrently(escaped[c], escaped_here[c]);
    });
    for (ScatterBuffer& buffer : buffers) buffer.flush_all();
    return units.power(escaped);
}

Estimate KeptRays::collect(const LightState& light, SamplingState& sampling, const PayloadUnits& units) {
    const ElementForest& forest = *light.forest;
    Estimate estimate;
    estimate.irradiance.resize(forest.size());
    estimate.variance.resize(forest.size());
    parallel_for_ranges(forest.size(), elements_per_task, [&](std::size_t begin, std::size_t end) {
        for (ElementIndex e(begin); e < end; ++e) {
            const Contribution sum = sampling.contributions.take(e);
            const float area = forest.area(e);
            estimate.irradiance[e] = Rgb(units.power(sum)) / area;
            estimate.variance[e] = static_cast<float>(units.square(sum) / area / area);
        }
    });
    pull(forest, estimate.irradiance);
    pull_variance(forest, estimate.variance);
    return estimate;
}

void KeptRays::merge(SolverState& state, const Estimate& estimate, const TracedIteration& iteration) {
    state.rays.schedule.count_other_rays(iteration.rays_for_new_views);
    needs_importance_ = false;
    if (estimate.irradiance.empty()) return;
    estimate_noise(state, estimate, iteration.weight);
    merged_ = set_.size();
    quotas_ = std::move(next_quotas_);
    all_rays_ += iteration.weight;
    receive_again(state);
}

void KeptRays::receive_again(SolverState& state, std::uint32_t first) {
    Estimate total = received(state, {0, set_.size()}, quotas_, first);
    state.light.history.assign(state.light.forest->size(), static_cast<float>(all_rays_));
    state.light.noise.set_variance(total.variance, state.light.history, first);
    std::copy(total.irradiance.begin() + first, total.irradiance.end(),
              state.light.solution.irradiance.begin() + first);
    pull(*state.light.forest, state.light.solution.irradiance);
    state.light.escaped_power = total.escaped_power;
}

void KeptRays::refine(SolverState& state) {
    constexpr int rounds = 2;
    if (!refines_by_variance(state.light.options()) || !state.light.noise.is_known()) return;
    // The kept rays determine the light of new elements. Other elements do not change, because the rays of the children
    // of a source keep its payload.
    for (int i = 0; i < rounds; ++i) {
        const std::uint32_t first = elements_;
        refine_by_variance(state);
        if (state.light.forest->size() == first) return;
        follow_forest(*state.light.forest);
        receive_again(state, first);
    }
}

void KeptRays::change_views(SolverState& state) {
    IterationMethod::change_views(state);
    // Before the first iteration, prepare() transports importance.
    const bool has_begun = !state.light.solution.iterations.empty();
    needs_importance_ = has_begun && importance_use(state.light.solution) == ImportanceUse::full;
}

void KeptRays::archive(StateArchive& archive) {
    passes_.archive(archive);
    archive("kept_rays/rays", set_.rays);
    archive("kept_rays/kind", set_.kind);
    archive.amounts("kept_rays/transmittance", set_.transmittance);
    archive("kept_rays/merged", merged_);
    archive("kept_rays/elements", elements_);
    archive("kept_rays/all_rays", all_rays_);
    archive.amounts("kept_rays/quotas", quotas_);
    archive("kept_rays/targets", targets_);
    archive("kept_rays/needs_importance", needs_importance_);
}

bool KeptRays::is_consistent(const SolverState& state) const {
    const std::size_t parts = state.inputs.emission.part_count();
    if (!passes_.is_consistent(state) || elements_ > state.light.forest->size() || merged_ != set_.size()) return false;
    if (set_.kind.size() != set_.size()) return false;
    if (!set_.transmittance.empty() && set_.transmittance.size() != set_.size()) return false;
    if (elements_ > 0 && targets_ == state.inputs.targets && quotas_.size() != elements_ + parts) return false;
    for (std::size_t i = 0; i < set_.size(); ++i) {
        const KeptRay& ray = set_.rays[i];
        if (set_.source(i, elements_) >= quotas_.size() || (!set_.is_from_part(i) && ray.source >= elements_))
            return false;
        if (ray.receiver != none && ray.receiver >= elements_) return false;
        if ((set_.kind[i] & RaySet::behind_pane) != 0 && set_.transmittance.empty()) return false;
    }
    return true;
}

}  // namespace

std::unique_ptr<IterationMethod> make_kept_rays(SolverState&) { return std::make_unique<KeptRays>(); }

}  // namespace interflect::detail
