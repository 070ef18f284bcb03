#include "interflect/solver/detail.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "interflect/base/parallel.h"
#include "interflect/elements/forest.h"
#include "interflect/solver/transport_steps.h"

namespace interflect::inline detail {

namespace {

constexpr float unknown = std::numeric_limits<float>::infinity();

/// Assumed relative variation of irradiance in an unmeasured leaf.
constexpr float assumed_variation = 0.1f;

/// Bounds of the mean squared difference relative to the next coarser level. It is a quarter where irradiance is
/// smooth, and a half at edges.
constexpr double least_decay = 0.25, most_decay = 0.7;

/// Siblings are under-sampled below this fraction of their parent's rays.
constexpr float young = 0.125f, highest_expected_decay = 0.5f;

bool uses_shrinkage(const SolverState& state) {
    return state.options.experimental.shrinkage && refines_by_variance(state.options);
}

/// Mean square errors in addition to the parent's.
struct AddedError {
    float noise = 0, bias = 0;
};

AddedError added_error(const SolverState& state, std::uint32_t first) {
    const Detail detail = detail_of(state, first);
    if (detail.noise == unknown) return {};  // the siblings equal their parent
    if (!uses_shrinkage(state)) return {detail.noise, 0};
    const float kept = detail.shrinkage(), noise = kept * kept * detail.noise;
    // Largest variance of four non-negative numbers. Without this limit, rays with a large weight would dominate the
    // sum.
    const float mean = luminance(state.solution.irradiance[state.forest->parent(first)]), most = 3 * mean * mean;
    return {noise, std::clamp(detail.risk() - noise, -most, most)};
}

/// Fraction of the variance of a signal that remains after a box filter of width 1 (a pixel). Steps: independent
/// constant pieces of length `a`. Pairs: adjacent pieces of length `a` with opposite values.
float left_of_steps(float a) { return a > 1 ? 1 - 1 / (3 * a) : a * (1 - a / 3); }
float left_of_pairs(float a) {
    if (a > 1) return 1 - 1 / (2 * a);
    if (a < 0.5f) return 2 * a * a / 3;
    const float beyond = 2 * a * (1 - a) - (1 + 2 * a) * (1 - a * a) / 2 + (1 - a * a * a) / 3;
    return a / 2 - beyond / a;
}

/// Extents of an element along the edges of its patch [pixel widths].
struct Extents {
    float u, v;
};
Extents extents_in_pixels(const SolverState& state, std::uint32_t element) {
    const ElementForest& forest = *state.forest;
    const PatchGeometry::Shape& shape = forest.geometry(forest.patch(element)).shape();
    const float u2 = shape.edge_u.length2(), v2 = shape.edge_v.length2();
    const float across = shape.edge_u.cross(shape.edge_v).length();  // the shorter extent times the longer edge
    const float aspect = !(across > 0) ? 1 : u2 > v2 ? u2 / across : across / v2;
    const float pixels = forest.area(element) / pixel_area(state, element);
    return {std::sqrt(pixels * aspect), std::sqrt(pixels / aspect)};
}

/// The fractions in two dimensions. Differences of four siblings change sign along one side, the other, or both.
float left_of_patch(const Extents& patch) { return left_of_steps(patch.u) * left_of_steps(patch.v); }
float left_of_siblings(const Extents& sibling) {
    const float u = left_of_pairs(sibling.u), v = left_of_pairs(sibling.v);
    return (u * left_of_steps(2 * sibling.v) + left_of_steps(2 * sibling.u) * v + u * v) / 3;
}
float left_of_siblings(const SolverState& state, ErrorMeasure measure, std::uint32_t first) {
    return measure == ErrorMeasure::surfaces ? 1 : left_of_siblings(extents_in_pixels(state, first));
}

/// Returns the share of the variation among the descendants of a leaf that pictures show, by level. Gradients and edges
/// of shadows vary along one side only, and continue in the neighbours along the other. The share is small for elements
/// smaller than a pixel, but not 0, because elements are not aligned with pixels.
std::array<float, finer_levels> left_within(const SolverState& state, ErrorMeasure measure, std::uint32_t leaf) {
    std::array<float, finer_levels> left;
    left.fill(1);
    if (measure == ErrorMeasure::surfaces) return left;
    Extents extents = extents_in_pixels(state, leaf);
    for (float& of_level : left) {
        extents.u /= 2, extents.v /= 2;
        of_level = (left_of_pairs(extents.u) + left_of_pairs(extents.v)) / 2;
    }
    return left;
}

/// Mean square errors of every element; bias may be negative.
struct ElementErrors {
    std::vector<float> noise, bias;
    std::vector<float> noise_of_patch;  // variance of the patch mean, part of `noise`
};

/// Factors of the differences of four siblings from their parent, and the remaining noise variance of each, relative to
/// its area-weighted mean.
struct Shrinkage {
    std::array<float, 4> kept, noise;
};

/// The Wiener filter of each sibling has its own noise. The mean of the siblings does not change: their common loss is
/// divided in proportion to the remaining variance, as if the parent's mean were another measurement.
Shrinkage shrinkage_of(const SolverState& state, std::uint32_t first) {
    const ElementForest& forest = *state.forest;
    const Detail detail = detail_of(state, first);
    Shrinkage s{{1, 1, 1, 1}, state.noise.shares(forest, state.solution.irradiance, first, state.history[first])};
    if (!uses_shrinkage(state) || detail.noise == unknown) return s;
    const float kept = detail.shrinkage();
    float sum = 0, area = 0;
    for (std::uint32_t k = 0; k < 4; ++k) {
        s.kept[k] = kept > 0 ? kept / (kept + (1 - kept) * s.noise[k]) : 0;
        s.noise[k] = kept > 0 ? s.noise[k] * s.kept[k] : 1;
        sum += forest.area(first + k) * s.noise[k], area += forest.area(first + k);
    }
    for (float& noise : s.noise) noise = sum > 0 ? noise * area / sum : 1;
    return s;
}

ElementErrors element_errors(const SolverState& state, ErrorMeasure measure) {
    const ElementForest& forest = *state.forest;
    ElementErrors errors;
    errors.noise.assign(forest.size(), 0);
    errors.bias.assign(forest.size(), 0);
    for (std::uint32_t root = 0; root < forest.patch_count(); ++root) {
        const float left = measure == ErrorMeasure::pictures ? left_of_patch(extents_in_pixels(state, root)) : 1;
        const float rays = std::max(state.history[root], 1.0f);
        errors.noise[root] = left * state.noise.variance(forest, state.solution.irradiance, root, rays);
    }
    errors.noise_of_patch = errors.noise;
    forest.for_siblings_from_roots([&](std::uint32_t first) {
        const auto [noise, bias] = added_error(state, first);
        const std::uint32_t parent = forest.parent(first);
        const float left = left_of_siblings(state, measure, first);
        const Shrinkage shrinkage = shrinkage_of(state, first);
        for (std::uint32_t e = first; e < first + 4; ++e) {
            const float share = shrinkage.noise[e - first];
            errors.noise[e] = share * (errors.noise[parent] + left * noise);
            errors.noise_of_patch[e] = share * errors.noise_of_patch[parent];
            errors.bias[e] = errors.bias[parent] + left * bias;
        }
    });
    return errors;
}

std::uint32_t first_sibling(const ElementForest& forest, std::uint32_t e) {
    return forest.first_child(forest.parent(e));
}

/// Returns the signal of an element's siblings; 0 if unknown.
float signal_beside(const SolverState& state, std::uint32_t e) {
    if (e < state.forest->patch_count()) return 0;
    const Detail detail = detail_of(state, first_sibling(*state.forest, e));
    return detail.noise == unknown ? 0 : detail.signal();
}

struct ErrorSums {
    double weight = 0, noise = 0, bias = 0;
    double noise_of_patches = 0;  // variance of patch means, part of `noise`
    double assumed = 0;           // error by the variation within leaves without siblings

    ErrorSums& operator+=(const ErrorSums& o) {
        weight += o.weight, noise += o.noise, bias += o.bias;
        noise_of_patches += o.noise_of_patches, assumed += o.assumed;
        return *this;
    }
};

/// Averaged differences y of siblings from their parent times new ones, z: the area-weighted mean of the four.
/// E y z = |d|^2 for true differences d.
double measured_signal(const SolverState& state, const FreshEstimate& fresh, std::uint32_t first) {
    const ElementForest& forest = *state.forest;
    const std::uint32_t parent = forest.parent(first);
    const auto difference = [&](const std::vector<Rgb>& irradiance, std::uint32_t e) {
        return luminance(irradiance[e]) - luminance(irradiance[parent]);
    };
    double product = 0, area = 0;
    for (std::uint32_t e = first; e < first + 4; ++e) {
        product += static_cast<double>(forest.area(e) * difference(state.solution.irradiance, e) *
                                       difference(fresh.irradiance, e));
        area += forest.area(e);
    }
    return product / area;
}

/// Measures squared errors with the next iteration. After shrinkage k, E |k y - d|^2 = E (k^2 |y|^2 + (1 - 2 k) y z).
/// Unlike Stein's estimate, this needs no noise model. It measures earlier iterations only.
RiskCheck check_risk(const SolverState& state, const FreshEstimate& fresh) {
    const ElementForest& forest = *state.forest;
    const std::uint32_t roots = forest.patch_count();
    const ErrorMeasure measure = default_measure(state);
    const auto check_siblings = [&](std::uint32_t first, RiskCheck& sum) {
        const Detail detail = detail_of(state, first);
        const std::uint32_t parent = forest.parent(first);
        const double w = error_weight(state, measure, parent) * forest.area(parent);
        if (detail.noise == unknown || !(w > 0)) return;
        const double signal = measured_signal(state, fresh, first), k = detail.shrinkage();
        const double left = left_of_siblings(state, measure, first);
        const AddedError expected = added_error(state, first);
        sum.measured += w * left * (k * k * detail.spread + (1 - 2 * k) * signal);
        sum.expected += w * left * static_cast<double>(expected.noise + expected.bias);
        const double of_parent = parent < roots ? 0 : measured_signal(state, fresh, first_sibling(forest, parent));
        for (std::uint32_t e = first; e < first + 4; ++e) {
            if (!forest.is_leaf(e)) continue;
            const double of_leaf = error_weight(state, measure, e) * forest.area(e);
            const std::array<float, finer_levels> left_of_level = left_within(state, measure, e);
            sum.signal += of_leaf * signal;
            sum.signal_of_parents += of_leaf * of_parent;
            for (std::size_t level = 0; level < finer_levels; ++level)
                sum.within[level] += of_leaf * left_of_level[level] * signal;
        }
    };
    RiskCheck sum = parallel_sum((forest.size() - roots) / 4, elements_at_once, RiskCheck(),
                                 [&](std::size_t begin, std::size_t end) {
                                     RiskCheck part;
                                     for (std::size_t i = begin; i < end; ++i)
                                         check_siblings(roots + 4 * static_cast<std::uint32_t>(i), part);
                                     return part;
                                 });
    sum.weight = 1;
    return sum;
}

/// Returns the squared error by variation within the leaves, extrapolated from that among them.
double error_within_leaves(const RiskCheck& check) {
    if (!(check.weight > 0)) return 0;
    const bool is_known = check.signal > 0 && check.signal_of_parents > 0;
    const double decay =
        is_known ? std::clamp(check.signal / check.signal_of_parents, least_decay, most_decay) : least_decay;
    double sum = 0, of_level = 1;
    for (const double within : check.within) sum += std::max(0.0, within) * (of_level *= decay);
    return sum / check.weight;
}

/// Returns the squared error of the differences between siblings. The noise model expects too much noise in hard
/// shadows, where points are well distributed. Its estimate of the error may then even be negative, and the
/// measurements of earlier iterations replace it.
double error_of_details(const RiskCheck& check, double noise, double bias) {
    const double expected = noise + bias;
    const bool is_reliable = bias > -noise / 2;
    return is_reliable || !(check.weight > 0) ? check.factor() * expected
                                              : std::max(0.0, check.measured / check.weight);
}

ErrorSums sum_errors(const SolverState& state, ErrorMeasure measure, const ElementErrors& errors) {
    const ElementForest& forest = *state.forest;
    return parallel_sum(forest.size(), elements_at_once, ErrorSums(), [&](std::size_t begin, std::size_t end) {
        ErrorSums sums;
        for (auto e = static_cast<std::uint32_t>(begin); e < end; ++e) {
            if (!forest.is_leaf(e)) continue;
            const double w = error_weight(state, measure, e) * forest.area(e);
            if (!(w > 0)) continue;
            sums.weight += w;
            sums.noise += w * errors.noise[e];
            sums.bias += w * errors.bias[e];
            sums.noise_of_patches += w * errors.noise_of_patch[e];
            if (e >= forest.patch_count()) continue;
            const float variation = assumed_variation * luminance(state.solution.irradiance[e]);
            sums.assumed += w * left_within(state, measure, e)[0] * variation * variation;
        }
        return sums;
    });
}

}  // namespace

float Detail::shrinkage() const {
    const float kept = spread > noise ? 1 - noise / spread : 0.0f;
    return is_young() && kept > 0 ? std::min(kept, assumed / (assumed + noise)) : kept;
}

float Detail::risk() const {
    if (is_young()) {
        const float kept = shrinkage();
        return kept * kept * noise + (1 - kept) * (1 - kept) * assumed;
    }
    // James-Stein: y = signal + noise in d = 3 dimensions, multiplied by max(0, 1 - d sigma^2 / |y|^2).
    return spread > noise ? noise + noise * (noise / (3 * spread)) : spread - noise;
}

Detail detail_of(const SolverState& state, std::uint32_t first) {
    const ElementForest& forest = *state.forest;
    const std::vector<Rgb>& irradiance = state.solution.irradiance;
    if (state.history[first] == 0) return {0, unknown};
    const float mean = luminance(irradiance[forest.parent(first)]);
    float area = 0, spread = 0, variance = 0;
    for (std::uint32_t e = first; e < first + 4; ++e) {
        const float difference = luminance(irradiance[e]) - mean, a = forest.area(e);
        area += a;
        spread += a * difference * difference;
        variance += a * state.noise.variance(forest, irradiance, e, state.history[first]);
    }
    Detail detail{spread / area, variance / area};
    // With few rays, shrinkage would leave more noise than any plausible signal. The parent's siblings bound it.
    const std::uint32_t parent = forest.parent(first);
    if (uses_shrinkage(state) && state.history[first] < young * state.history[parent])
        detail.assumed =
            parent < forest.patch_count()
                ? std::pow(assumed_variation * mean, 2.0f)
                : highest_expected_decay * std::max(0.0f, detail_of(state, first_sibling(forest, parent)).signal());
    return detail;
}

void estimate_noise(SolverState& state, const FreshEstimate& fresh, std::int64_t rays) {
    const ErrorMeasure measure = default_measure(state);
    const auto weight = [&](std::uint32_t e) { return error_weight(state, measure, e) * state.forest->area(e); };
    if (uses_shrinkage(state) && state.noise.is_known()) {
        constexpr double long_enough = 0.25;  // share of the rays averaged before
        const double before = long_enough * static_cast<double>(state.schedule.averaged_rays());
        state.risk_check.add(check_risk(state, fresh),
                             std::min(1.0, static_cast<double>(rays) / std::max(1.0, before)));
    }
    state.noise.add(*state.forest, fresh, state.solution.irradiance, state.history, static_cast<float>(rays), weight);
}

double SolutionError::total() const { return std::hypot(noise, discretisation); }

ErrorMeasure default_measure(const SolverState& state) {
    return state.view.empty() ? ErrorMeasure::surfaces : ErrorMeasure::pictures;
}

SolutionError solution_error(const SolverState& state, ErrorMeasure measure) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const double mean = error_reference(state, measure);
    if (!state.noise.is_known() || !(mean > 0)) return {infinity, infinity};
    const ErrorSums sums = sum_errors(state, measure, element_errors(state, measure));
    if (!(sums.weight > 0)) return {infinity, infinity};
    const double total_weight = measure == ErrorMeasure::surfaces ? sums.weight : 1;
    const double of_details = error_of_details(state.risk_check, sums.noise - sums.noise_of_patches, sums.bias);
    const double all = sums.noise_of_patches + of_details + error_within_leaves(state.risk_check) + sums.assumed;
    const double discretisation = state.options.method.refines ? std::max(0.0, all - sums.noise) : 0;
    // Pixels without a surface have no error, but count in the mean.
    const double shown = measure == ErrorMeasure::surfaces ? 1 : state.view.shown_share();
    const double scale = 1 / (mean * std::sqrt(total_weight * shown));
    return {std::sqrt(sums.noise) * scale, std::sqrt(discretisation) * scale};
}

double error_reference(const SolverState& state, ErrorMeasure measure) {
    const ElementForest& forest = *state.forest;
    const bool of_pictures = measure == ErrorMeasure::pictures;
    struct Sums {
        double light = 0, weight = 0;
        Sums& operator+=(const Sums& o) { return light += o.light, weight += o.weight, *this; }
    };
    const Sums sums = parallel_sum(forest.size(), elements_at_once, Sums(), [&](std::size_t begin, std::size_t end) {
        Sums sum;
        for (auto e = static_cast<std::uint32_t>(begin); e < end; ++e) {
            if (!forest.is_leaf(e)) continue;
            const double w =
                forest.area(e) * (of_pictures ? static_cast<double>(state.solution.view_importance[e]) : 1.0);
            const Rgb& h = state.solution.irradiance[e];
            const Rgb& rho = state.materials.surface(forest.patch(e), e).reflectance;
            sum.light += w * luminance(of_pictures ? Rgb(rho * h) : h);
            sum.weight += w;
        }
        return sum;
    });
    // The view importance of the surfaces that pixels show first sums to 1; those behind panes only add light.
    return of_pictures ? sums.light : sums.light / sums.weight;
}

double error_weight(const SolverState& state, ErrorMeasure measure, std::uint32_t element) {
    if (measure == ErrorMeasure::surfaces) return 1;
    const Rgb rho = state.materials.surface(state.forest->patch(element), element).reflectance;
    Rgb h = state.solution.irradiance[element];
    for (int c = 0; c < 3; ++c) h[c] = std::max(0.0f, h[c]);  // may be negative as a sum of noisy differences
    const float all = luminance(h), reflected = luminance(Rgb(rho * h));
    const float factor = all > 0 ? reflected / all : luminance(rho);
    return static_cast<double>(state.solution.view_importance[element]) * factor * factor;
}

namespace {

/// Clamps the irradiance of each group to zero, then rescales the groups to sum to the total.
void share_among_groups(const std::vector<Rgb>& irradiance, GroupLight& groups) {
    for (std::size_t e = 0; e < irradiance.size() && !groups.empty(); ++e)
        for (int c = 0; c < 3; ++c) {
            float sum = 0;
            for (std::vector<Rgb>& of_group : groups) sum += of_group[e][c] = std::max(0.0f, of_group[e][c]);
            for (std::vector<Rgb>& of_group : groups) of_group[e][c] *= sum > 0 ? irradiance[e][c] / sum : 0;
        }
}

}  // namespace

void finish_solution(SolverState& state) {
    const ElementForest& forest = *state.forest;
    Solution& solution = state.solution;
    const ElementErrors errors = element_errors(state, ErrorMeasure::surfaces);
    solution.standard_error.resize(forest.size());
    solution.discretisation_error.resize(forest.size());
    for (std::uint32_t e = 0; e < forest.size(); ++e) {
        const float within = std::max(0.0f, signal_beside(state, e)) / 3;  // 1/4 + 1/16 + ... of the signal
        solution.standard_error[e] = std::sqrt(errors.noise[e]);
        solution.discretisation_error[e] = std::sqrt(std::max(0.0f, errors.bias[e]) + within);
    }
    state.streams.used.resize(forest.size(), 0);
    solution.rays.assign(state.streams.used.begin(), state.streams.used.end());
    std::vector<Rgb> reduced = solution.irradiance;
    GroupLight reduced_groups = solution.groups;
    forest.for_siblings_from_roots([&](std::uint32_t first) {
        const std::uint32_t parent = forest.parent(first);
        const Shrinkage shrinkage = shrinkage_of(state, first);
        const auto differences = [&](const std::vector<Rgb>& irradiance) {
            std::array<Rgb, 4> difference;
            Rgb sum(0);
            float area = 0;
            for (std::uint32_t k = 0; k < 4; ++k) {
                difference[k] = shrinkage.kept[k] * (irradiance[first + k] - irradiance[parent]);
                sum += forest.area(first + k) * difference[k], area += forest.area(first + k);
            }
            for (std::uint32_t k = 0; k < 4; ++k) difference[k] -= shrinkage.noise[k] * sum / area;
            return difference;
        };
        const std::array<Rgb, 4> difference = differences(solution.irradiance);
        Rgb factor(1);  // If a child would become negative, scale all four differences equally.
        for (int c = 0; c < 3; ++c) {
            float lowest = 0;
            for (const Rgb& d : difference) lowest = std::min(lowest, d[c]);
            const float mean = reduced[parent][c];
            if (-lowest > mean) factor[c] = mean / -lowest;
            for (std::uint32_t k = 0; k < 4; ++k)
                reduced[first + k][c] = std::max(0.0f, mean + factor[c] * difference[k][c]);
        }
        for (std::size_t g = 0; g < reduced_groups.size(); ++g) {
            const std::array<Rgb, 4> of_group = differences(solution.groups[g]);
            for (std::uint32_t k = 0; k < 4; ++k)
                reduced_groups[g][first + k] = reduced_groups[g][parent] + factor * of_group[k];
        }
    });
    solution.irradiance = std::move(reduced);
    for (std::size_t g = 0; g < reduced_groups.size(); ++g)
        if (solution.dimming[g] == 0) reduced_groups[g].assign(forest.size(), Rgb(0));
    share_among_groups(solution.irradiance, reduced_groups);
    solution.groups = std::move(reduced_groups);
}

}  // namespace interflect::inline detail
