#include "interflect/solver/iteration/outdoor_targets.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>
#include <utility>

#include "interflect/base/numbers/random.h"
#include "interflect/base/threads/parallel.h"
#include "interflect/raycast/panes.h"
#include "interflect/solver/sampling/payload.h"
#include "interflect/solver/sampling/ray_maker.h"
#include "interflect/solver/sampling/ray_plan.h"

namespace interflect::detail {

namespace {

constexpr std::size_t rays_per_task = 1024;
constexpr std::uint64_t aiming_stream = 0x61696d;  // "aim" in ASCII

/// Finds lines from important surfaces to skies and suns.
struct LineFinder {
    const SolverState& state;
    const RayPlan& plan;
    const RayMaker& maker;
    const Payload& payload;
    const Panes& panes;
    std::uint64_t key;

    void keep_escaping(std::span<const Ray> rays, std::span<const double> importance, std::uint32_t sun,
                       std::vector<OutdoorLine>& lines) const {
        std::vector<Hit> hits(rays.size());
        std::vector<Panes::HitBehind> behind;
        state.inputs.ray_caster.trace(rays, hits);
        panes.trace(rays, hits, behind);
        const auto keep = [&](std::size_t ray, double transmitted) {
            lines.push_back({{rays[ray].origin, -rays[ray].direction}, sun, importance[ray] * transmitted});
        };
        for (std::size_t r = 0; r < rays.size(); ++r)
            if (hits[r].patch == none) keep(r, 1);
        for (const Panes::HitBehind& b : behind)
            if (b.hit.patch == none) keep(b.ray, static_cast<double>(channel_sum(b.transmittance)) / 3);
    }

    std::vector<OutdoorLine> find(std::size_t begin, std::size_t end) const {
        RayBatch batch;
        maker.make(static_cast<std::int64_t>(begin), static_cast<std::int64_t>(end), batch);

        // Look up the importance and the normal at the origin of each ray
        std::vector<double> importance(batch.rays.size());
        std::vector<V3f> normals(batch.rays.size());
        for (const SourceRays& source : batch.sources)
            for (std::uint32_t r = source.begin; r < source.end; ++r) {
                importance[r] = payload.importance(source.source);
                normals[r] =
                    state.light.forest->geometry(state.light.forest->patch(ElementIndex(source.source))).normal();
            }
        std::vector<OutdoorLine> lines;
        if (state.inputs.emission.has_sky()) {
            // Directions have the density cos(theta) / pi, so irradiance is pi times the mean radiance.
            std::vector<double> importance_per_radiance;
            importance_per_radiance.reserve(importance.size());
            for (const double i : importance) importance_per_radiance.push_back(i * std::numbers::pi);
            keep_escaping(batch.rays, importance_per_radiance, none, lines);
        }
        // Rays towards the suns start at the same points
        for (std::uint32_t sun = 0; sun < state.inputs.emission.sun_count(); ++sun) {
            std::vector<Ray> rays;
            std::vector<double> importance_per_irradiance;
            for (std::size_t r = 0; r < batch.rays.size(); ++r) {
                const auto words = random_words(mix(key, sun), begin + r);
                const V3f towards =
                    -state.inputs.emission.sun_direction(sun, unit_float(words[0]), unit_float(words[1]));
                const float cosine = normals[r].dot(towards);
                if (!(cosine > 0)) continue;
                rays.push_back({batch.rays[r].origin, towards});
                importance_per_irradiance.push_back(importance[r] * static_cast<double>(cosine));
            }
            keep_escaping(rays, importance_per_irradiance, sun, lines);
        }
        return lines;
    }
};

/// Returns a part of the lines with the same total importance.
std::vector<OutdoorLine> thinned(const std::vector<OutdoorLine>& lines) {
    constexpr std::size_t enough = 1 << 14;
    const std::size_t stride = (lines.size() + enough - 1) / enough;
    std::vector<OutdoorLine> some;
    for (std::size_t i = 0; i < lines.size(); i += stride) {
        some.push_back(lines[i]);
        some.back().importance *= static_cast<double>(stride);
    }
    return some;
}

std::vector<OutdoorLine> outdoor_lines(const SolverState& state, std::int64_t rays) {
    const RayPlan plan =
        plan_importance(state.inputs.materials, state.light.solution, importance_of(state.light.solution), rays);
    const std::uint64_t key = mix(state.sampling.streams.seed, aiming_stream);
    const SampleStreams streams(state.sampling.streams.points, key);
    const RayMaker maker(*state.light.forest, state.inputs.ray_caster, plan, streams);
    if (!(maker.allocation().q_sum() > 0)) return {};
    const Payload payload(state.inputs.materials, *state.light.forest, plan, maker.allocation().q_sum());
    const Panes panes(state.inputs.scene, state.inputs.ray_caster);
    const LineFinder finder{state, plan, maker, payload, panes, key};
    const auto count = static_cast<std::size_t>(rays);
    std::vector<std::vector<OutdoorLine>> found((count + rays_per_task - 1) / rays_per_task);
    parallel_for_ranges(count, rays_per_task, [&](std::size_t begin, std::size_t end) {
        found[begin / rays_per_task] = finder.find(begin, end);
    });
    std::vector<OutdoorLine> lines;
    for (const std::vector<OutdoorLine>& some : found) lines.insert(lines.end(), some.begin(), some.end());
    return thinned(lines);
}

struct WeightedLine {
    Ray light;
    double weight;
};
double weight_of(const std::vector<WeightedLine>& lines) {
    return std::accumulate(lines.begin(), lines.end(), 0.0,
                           [](double sum, const WeightedLine& l) { return sum + l.weight; });
}
std::vector<WeightedLine> crossing(const std::vector<WeightedLine>& lines, const Imath::Box3f& box) {
    std::vector<WeightedLine> found;
    std::copy_if(lines.begin(), lines.end(), std::back_inserter(found),
                 [&](const WeightedLine& line) { return line_crosses(box, line.light); });
    return found;
}

/// Returns the weight of the lines that cross the box. The weight of a line decreases with its distance from the
/// centre, to 0 at the corners.
double centred_weight(const std::vector<WeightedLine>& lines, const Imath::Box3f& box) {
    const float largest_square = (box.size() / 2).length2();
    double sum = 0;
    for (const WeightedLine& line : lines) {
        if (!line_crosses(box, line.light)) continue;
        const float square = line.light.direction.cross(box.center() - line.light.origin).length2();
        sum += line.weight * std::max(0.0, 1 - static_cast<double>(square / largest_square));
    }
    return sum;
}

/// Returns the box of half the size along the long axes, among overlapping positions, that has the largest centred
/// weight.
Imath::Box3f best_half(const std::vector<WeightedLine>& lines, const Imath::Box3f& box) {
    const V3f size = box.size();
    const float widest = std::max({size.x, size.y, size.z});
    const auto positions = [&](int axis) { return size[axis] > widest / 2 ? 3 : 1; };
    Imath::Box3f best = box;
    double most = -1;
    for (int i = 0; i < positions(0); ++i)
        for (int j = 0; j < positions(1); ++j)
            for (int k = 0; k < positions(2); ++k) {
                Imath::Box3f part = box;
                const V3f position(static_cast<float>(i), static_cast<float>(j), static_cast<float>(k));
                for (int axis = 0; axis < 3; ++axis) {
                    if (positions(axis) == 1) continue;
                    part.min[axis] = box.min[axis] + position[axis] * size[axis] / 4;
                    part.max[axis] = part.min[axis] + size[axis] / 2;
                }
                const double weight = centred_weight(lines, part);
                if (weight > most) {
                    most = weight;
                    best = part;
                }
            }
    return best;
}

}  // namespace

std::vector<Imath::Box3f> find_targets(const std::vector<OutdoorLine>& lines, const std::vector<double>& weights,
                                       const Imath::Box3f& scene_box) {
    constexpr std::size_t max_lines = 4096, fewest_lines = 16;
    static_assert(max_targets % max_chains == 0);
    constexpr double share_of_rest = 0.05;      // minimum weight of the remaining lines for another chain
    constexpr double worthwhile_share = 0.4;    // minimum weight in a half; evenly spread lines have 0.25
    constexpr float widest_target = 1.0f / 16;  // relative to the diagonal; the scene's box suffices for wider targets

    // Select lines at regular intervals
    std::vector<WeightedLine> rest;
    const std::size_t stride = std::max<std::size_t>(1, lines.size() / max_lines);
    for (std::size_t i = 0; i < lines.size(); i += stride)
        if (weights[i] > 0) rest.push_back({lines[i].light, weights[i]});
    const double all = weight_of(rest);

    // Find chains of nested boxes; each chain serves lines that miss the smallest boxes of earlier chains
    std::vector<Imath::Box3f> targets;
    for (int chain = 0; chain < max_chains && rest.size() >= fewest_lines && weight_of(rest) > share_of_rest * all;
         ++chain) {
        // Start at the last target that most of these lines cross, else at the scene's box
        Imath::Box3f box = scene_box;
        std::vector<WeightedLine> inside = rest;
        for (const Imath::Box3f& target : targets) {
            std::vector<WeightedLine> in_target = crossing(rest, target);
            if (weight_of(in_target) > weight_of(rest) / 2) {
                box = target;
                inside = std::move(in_target);
            }
        }
        // Halve the box repeatedly, up to the last half with a large share of the lines
        std::vector<Imath::Box3f> halves;
        std::size_t worthwhile = 0;
        for (int level = 0; level < max_targets / max_chains && inside.size() >= fewest_lines; ++level) {
            box = best_half(inside, box);
            std::vector<WeightedLine> in_half = crossing(inside, box);
            halves.push_back(box);
            if (in_half.size() >= fewest_lines && weight_of(in_half) >= worthwhile_share * weight_of(inside))
                worthwhile = halves.size();
            inside = std::move(in_half);
        }
        if (worthwhile == 0 || halves[worthwhile - 1].size().length() > widest_target * scene_box.size().length())
            break;
        halves.resize(worthwhile);
        targets.insert(targets.end(), halves.begin(), halves.end());
        std::vector<WeightedLine> others;
        std::copy_if(rest.begin(), rest.end(), std::back_inserter(others),
                     [&](const WeightedLine& line) { return !line_crosses(halves.back(), line.light); });
        rest = std::move(others);
    }
    return targets;
}

namespace {

/// Returns the light along each line, over the square root of the total of its source. This raises the weight of the
/// dimmer sky, because the parallel lines of a sun do not locate windows along its direction.
std::vector<double> weights_of(const Emission& emission, const std::vector<OutdoorLine>& lines) {
    const auto source = [&](const OutdoorLine& line) { return line.sun == none ? emission.sun_count() : line.sun; };
    std::vector<double> weights, of_sources(emission.sun_count() + 1, 0.0);
    for (const OutdoorLine& line : lines) {
        double brightness = 0;
        for (const Emission::PartAlong& along : emission.parts_along(line.light, line.sun))
            brightness += along.brightness;
        weights.push_back(line.importance * brightness);
        of_sources[source(line)] += weights.back();
    }
    for (std::size_t i = 0; i < lines.size(); ++i)
        if (weights[i] > 0) weights[i] /= std::sqrt(of_sources[source(lines[i])]);
    return weights;
}

/// Returns the importance of each part, which is light per power. A mean line in each box is added, so that the
/// importance of every part is positive.
std::vector<PartImportance> importance_of_parts(const Emission& emission, const std::vector<OutdoorLine>& lines) {
    constexpr double rays_of_lines = 8;  // number of rays per part that the lines count as
    std::vector<double> weights(emission.part_count(), 0.0), power_of_box(emission.box_count(), 0.0);
    double all = 0;
    for (const OutdoorLine& line : lines)
        for (const Emission::PartAlong& along : emission.parts_along(line.light, line.sun)) {
            weights[along.part] += line.importance * along.brightness;
            all += line.importance * along.brightness;
        }
    for (std::size_t i = 0; i < weights.size(); ++i) power_of_box[emission.box(i)] += channel_sum(emission.power(i));
    std::vector<PartImportance> parts(weights.size());
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const double power = channel_sum(emission.power(i)), of_box = power_of_box[emission.box(i)];
        if (!(power > 0)) continue;
        const double of_mean_line = all / static_cast<double>(lines.size()) / of_box;
        parts[i] = {rays_of_lines * (weights[i] / power + of_mean_line), rays_of_lines};
    }
    return parts;
}

}  // namespace

std::vector<OutdoorLine> aim_outdoor_light(SolverState& state) {
    // Many rays are needed, because a small window transmits little importance. At most 1 / 32 of the run's rays are
    // used.
    constexpr std::int64_t max_rays = 1 << 18, all_over_rays = 32;
    if (importance_use(state.light.solution) != ImportanceUse::full) return {};
    const auto suns = static_cast<std::int64_t>(state.inputs.emission.sun_count());
    const std::int64_t sources = suns + (state.inputs.emission.has_sky() ? 1 : 0);
    if (sources == 0) return {};
    const std::int64_t rays = std::min(max_rays, state.light.options().limits.rays / all_over_rays) / sources;
    if (rays == 0) return {};
    std::vector<OutdoorLine> lines = outdoor_lines(state, rays);
    std::vector<Imath::Box3f> targets =
        find_targets(lines, weights_of(state.inputs.emission, lines), state.inputs.emission.scene_box());
    if (!targets.empty() || !state.inputs.targets.empty()) {
        set_targets(state.inputs, state.sampling, std::move(targets));
        if (!lines.empty()) state.sampling.part_importance = importance_of_parts(state.inputs.emission, lines);
    }
    state.rays.importance += rays * sources;
    return lines;
}

}  // namespace interflect::detail
