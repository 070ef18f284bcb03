#include "interflect/solver/iteration/outdoor_targets.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>
#include <utility>

#include "interflect/base/parallel.h"
#include "interflect/base/random.h"
#include "interflect/raycast/panes.h"
#include "interflect/solver/sampling/payload.h"
#include "interflect/solver/sampling/ray_maker.h"
#include "interflect/solver/sampling/ray_plan.h"

namespace interflect::detail {

namespace {

constexpr std::size_t rays_at_once = 1024;
constexpr std::uint64_t purpose = 0x61696d;  // distinct from other streams

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
        state.ray_caster.trace(rays, hits);
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
        std::vector<double> importance(batch.rays.size());
        std::vector<V3f> normals(batch.rays.size());
        for (const SourceRays& source : batch.sources)
            for (std::uint32_t r = source.begin; r < source.end; ++r) {
                importance[r] = payload.importance(source.source);
                normals[r] = state.forest->geometry(state.forest->patch(source.source)).normal();
            }
        std::vector<OutdoorLine> lines;
        if (state.emission.has_sky()) {
            // Directions have density cos(theta) / pi: irradiance is pi times the mean radiance.
            std::vector<double> of_radiance;
            of_radiance.reserve(importance.size());
            for (const double i : importance) of_radiance.push_back(i * std::numbers::pi);
            keep_escaping(batch.rays, of_radiance, none, lines);
        }
        for (std::uint32_t sun = 0; sun < state.emission.sun_count(); ++sun) {
            std::vector<Ray> rays;
            std::vector<double> of_irradiance;
            for (std::size_t r = 0; r < batch.rays.size(); ++r) {
                const auto words = random_words(mix(key, sun), begin + r);
                const V3f towards = -state.emission.sun_direction(sun, unit_float(words[0]), unit_float(words[1]));
                const float cosine = normals[r].dot(towards);
                if (!(cosine > 0)) continue;
                rays.push_back({batch.rays[r].origin, towards});
                of_irradiance.push_back(importance[r] * static_cast<double>(cosine));
            }
            keep_escaping(rays, of_irradiance, sun, lines);
        }
        return lines;
    }
};

/// Preserves the total importance.
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
    const RayPlan plan = plan_importance(state.materials, state.solution, importance_of(state.solution), rays);
    const std::uint64_t key = mix(state.streams.seed, purpose);
    const SampleStreams streams(state.streams.points, key);
    const RayMaker maker(*state.forest, state.ray_caster, plan, streams);
    if (!(maker.allocation().q_sum() > 0)) return {};
    const Payload payload(state.materials, *state.forest, plan, maker.allocation().q_sum());
    const Panes panes(state.scene, state.ray_caster);
    const LineFinder finder{state, plan, maker, payload, panes, key};
    const auto count = static_cast<std::size_t>(rays);
    std::vector<std::vector<OutdoorLine>> found((count + rays_at_once - 1) / rays_at_once);
    parallel_for_ranges(count, rays_at_once, [&](std::size_t begin, std::size_t end) {
        found[begin / rays_at_once] = finder.find(begin, end);
    });
    std::vector<OutdoorLine> lines;
    for (const std::vector<OutdoorLine>& some : found) lines.insert(lines.end(), some.begin(), some.end());
    return thinned(lines);
}

struct Weighed {
    Ray light;
    double weight;
};
double weight_of(const std::vector<Weighed>& lines) {
    return std::accumulate(lines.begin(), lines.end(), 0.0,
                           [](double sum, const Weighed& l) { return sum + l.weight; });
}
std::vector<Weighed> crossing(const std::vector<Weighed>& lines, const Imath::Box3f& box) {
    std::vector<Weighed> found;
    std::copy_if(lines.begin(), lines.end(), std::back_inserter(found),
                 [&](const Weighed& line) { return line_crosses(box, line.light); });
    return found;
}

double centred_weight(const std::vector<Weighed>& lines, const Imath::Box3f& box) {
    const float farthest = (box.size() / 2).length2();
    double sum = 0;
    for (const Weighed& line : lines) {
        if (!line_crosses(box, line.light)) continue;
        const float distance = line.light.direction.cross(box.center() - line.light.origin).length2();
        sum += line.weight * std::max(0.0, 1 - static_cast<double>(distance / farthest));
    }
    return sum;
}

/// Returns the half of a box, along its long axes, with the largest centred weight.
Imath::Box3f best_half(const std::vector<Weighed>& lines, const Imath::Box3f& box) {
    const V3f size = box.size();
    const float widest = std::max({size.x, size.y, size.z});
    const auto places = [&](int axis) { return size[axis] > widest / 2 ? 3 : 1; };
    Imath::Box3f best = box;
    double most = -1;
    for (int i = 0; i < places(0); ++i)
        for (int j = 0; j < places(1); ++j)
            for (int k = 0; k < places(2); ++k) {
                Imath::Box3f part = box;
                const V3f place(static_cast<float>(i), static_cast<float>(j), static_cast<float>(k));
                for (int axis = 0; axis < 3; ++axis) {
                    if (places(axis) == 1) continue;
                    part.min[axis] = box.min[axis] + place[axis] * size[axis] / 4;
                    part.max[axis] = part.min[axis] + size[axis] / 2;
                }
                const double weight = centred_weight(lines, part);
                if (weight > most) most = weight, best = part;
            }
    return best;
}

}  // namespace

std::vector<Imath::Box3f> find_targets(const std::vector<OutdoorLine>& lines, const std::vector<double>& weights,
                                       const Imath::Box3f& scene_box) {
    constexpr std::size_t most_lines = 4096, fewest_lines = 16;
    static_assert(most_targets % most_places == 0);
    constexpr double share_of_rest = 0.05;  // minimum share of the weight for another place
    // docs/method.md, Light sources that are not surfaces
    constexpr double worthwhile_share = 0.4;
    constexpr float widest_target = 1.0f / 16;
    std::vector<Weighed> rest;
    const std::size_t stride = std::max<std::size_t>(1, lines.size() / most_lines);
    for (std::size_t i = 0; i < lines.size(); i += stride)
        if (weights[i] > 0) rest.push_back({lines[i].light, weights[i]});
    const double all = weight_of(rest);
    std::vector<Imath::Box3f> targets;
    for (int place = 0; place < most_places && rest.size() >= fewest_lines && weight_of(rest) > share_of_rest * all;
         ++place) {
        // Smallest target that most lines cross.
        Imath::Box3f box = scene_box;
        std::vector<Weighed> inside = rest;
        for (const Imath::Box3f& target : targets) {
            std::vector<Weighed> in_target = crossing(rest, target);
            if (weight_of(in_target) > weight_of(rest) / 2) box = target, inside = std::move(in_target);
        }
        std::vector<Imath::Box3f> halves;
        std::size_t worthwhile = 0;
        for (int level = 0; level < most_targets / most_places && inside.size() >= fewest_lines; ++level) {
            box = best_half(inside, box);
            std::vector<Weighed> in_half = crossing(inside, box);
            halves.push_back(box);
            if (in_half.size() >= fewest_lines && weight_of(in_half) >= worthwhile_share * weight_of(inside))
                worthwhile = halves.size();
            inside = std::move(in_half);
        }
        if (worthwhile == 0 || halves[worthwhile - 1].size().length() > widest_target * scene_box.size().length())
            break;
        halves.resize(worthwhile);
        targets.insert(targets.end(), halves.begin(), halves.end());
        std::vector<Weighed> others;
        std::copy_if(rest.begin(), rest.end(), std::back_inserter(others),
                     [&](const Weighed& line) { return !line_crosses(halves.back(), line.light); });
        rest = std::move(others);
    }
    return targets;
}

namespace {

/// Light along each line over the square root of its source's total. Lines of a sun are parallel: only the dimmer sky
/// can locate a window along them.
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

/// Adds a mean line to each box, so no part starts at zero.
std::vector<PartImportance> importance_of_parts(const Emission& emission, const std::vector<OutdoorLine>& lines) {
    constexpr double rays_of_lines = 8;
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
        const double anywhere = all / static_cast<double>(lines.size()) / of_box;
        parts[i] = {rays_of_lines * (weights[i] / power + anywhere), rays_of_lines};
    }
    return parts;
}

}  // namespace

std::int64_t aim_outdoor_light(SolverState& state) {
    // Many rays: a small window transmits little importance.
    constexpr std::int64_t most_rays = 1 << 18, all_over_rays = 32;
    if (importance_use(state.solution) != ImportanceUse::full) return 0;
    const auto suns = static_cast<std::int64_t>(state.emission.sun_count());
    const std::int64_t sources = suns + (state.emission.has_sky() ? 1 : 0);
    if (sources == 0) return 0;
    const std::int64_t rays = std::min(most_rays, state.options.limits.rays / all_over_rays) / sources;
    if (rays == 0) return 0;
    const std::vector<OutdoorLine> lines = outdoor_lines(state, rays);
    std::vector<Imath::Box3f> targets =
        find_targets(lines, weights_of(state.emission, lines), state.emission.scene_box());
    if (!targets.empty() || !state.targets.empty()) {
        set_targets(state, std::move(targets));
        if (!lines.empty()) state.part_importance = importance_of_parts(state.emission, lines);
    }
    return rays * sources;
}

}  // namespace interflect::detail
