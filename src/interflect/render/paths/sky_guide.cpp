#include "interflect/render/paths/sky_guide.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "interflect/base/numbers/random.h"
#include "interflect/base/threads/parallel.h"
#include "interflect/base/threads/shared_ranges.h"
#include "interflect/geometry/textures/tangent_frame.h"

namespace interflect::detail {

namespace {

constexpr std::size_t guide_records_per_task = 256, guide_groups_per_task = 1;
constexpr int rounds = 8;                    // each round traces one ray per cell
constexpr float share_of_neighbours = 0.1f;  // weight of light in neighbouring cells and groups of records

/// A tangent frame that changes little between similar normals. Its singularity is far from the normals of walls and
/// floors.
struct SteadyFrame {
    V3f s, t, n;

    explicit SteadyFrame(const V3f& normal) : n(normal) {
        const V3f oblique(0.36f, 0.48f, 0.8f);
        s = oblique.cross(n);
        s = s.length() > 1e-4f ? s.normalized() : TangentFrame(n).s;
        t = n.cross(s);
    }
    /// Maps [0, 1)^2 to directions of density cosine / pi.
    V3f direction(float a, float b) const {
        const float radius = std::sqrt(a), turn = 2 * std::numbers::pi_v<float> * b;
        return s * (radius * std::cos(turn)) + t * (radius * std::sin(turn)) + n * std::sqrt(1 - a);
    }
};

template <std::size_t side>
V3f direction_in(std::size_t cell, const SteadyFrame& frame, float u, float v) {
    const std::size_t ring = cell / side, sector = cell % side;
    return frame.direction((static_cast<float>(ring) + u) / side, (static_cast<float>(sector) + v) / side);
}

/// Groups each record with the first record in whose reach it is. The first records are mostly far apart.
std::vector<std::uint32_t> groups_of(const IndirectField& field) {
    std::vector<std::uint32_t> groups(field.size());
    parallel_for_ranges(field.size(), guide_records_per_task, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const SurfacePoint point = field.point(i);
            groups[i] = static_cast<std::uint32_t>(i);
            field.visit_near(point.position, point.normal, point.patch,
                             [&](std::uint32_t record, float) { groups[i] = std::min(groups[i], record); });
        }
    });
    // Number the groups consecutively
    std::vector<std::uint32_t> number(field.size(), none);
    std::uint32_t count = 0;
    for (std::uint32_t& group : groups) {
        if (number[group] == none) number[group] = count++;
        group = number[group];
    }
    return groups;
}

/// Returns the groups of all records that have one of the points in their reach, without repetitions.
std::vector<std::uint32_t> groups_near(const IndirectField& field, std::span<const std::uint32_t> groups,
                                       std::span<const SurfacePoint> points) {
    std::vector<std::uint32_t> near;
    for (const SurfacePoint& point : points)
        field.visit_near(point.position, point.normal, point.patch,
                         [&](std::uint32_t record, float) { near.push_back(groups[record]); });
    std::sort(near.begin(), near.end());
    near.erase(std::unique(near.begin(), near.end()), near.end());
    return near;
}

}  // namespace

SkyGuide::SkyGuide(const TracedScene& scene, const IndirectField& field, std::uint64_t seed, const CommonStop& stop) {
    const Skies& skies = scene.sources.skies();
    if (!skies.can_sample() && !(channel_sum(skies.uniform_radiance()) > 0)) return;
    groups_ = groups_of(field);
    const std::size_t count = groups_.empty() ? 0 : *std::max_element(groups_.begin(), groups_.end()) + std::size_t{1};
    std::vector<std::vector<SurfacePoint>> points(count);
    for (std::size_t i = 0; i < field.size(); ++i) points[groups_[i]].push_back(field.point(i));

    // Find the light of the sky around each group, in all ranks together
    const auto is_stopped = [&] { return stop.within_process().is_due(); };
    std::vector<Cells> light(count, Cells{});
    std::vector<std::int64_t> rays(count);
    parallel_for_own_ranges(stop.ranks(), count, guide_groups_per_task, [&](std::size_t begin, std::size_t end) {
        for (std::size_t g = begin; g < end && !is_stopped(); ++g) {
            const Search searched = search(scene, points[g], mix(mix(seed, g), 1));
            light[g] = searched.light();
            rays[g] = searched.traced;
        }
    });
    collect_ranges(stop.ranks(), std::span(light), guide_groups_per_task, Destination::all_ranks);
    collect_ranges(stop.ranks(), std::span(rays), guide_groups_per_task, Destination::all_ranks);
    rays_ = std::accumulate(rays.begin(), rays.end(), std::int64_t{0});
    // Compute densities, with a share of the light around neighbouring groups
    densities_.resize(count);
    parallel_for_ranges(count, guide_groups_per_task, [&](std::size_t begin, std::size_t end) {
        for (std::size_t g = begin; g < end && !is_stopped(); ++g) {
            Cells around = light[g];
            for (const std::uint32_t near : groups_near(field, groups_, points[g]))
                for (std::size_t c = 0; c < cells; ++c) around[c] += share_of_neighbours * light[near][c];
            densities_[g] = density_of(around);
        }
    });
}

SkyGuide::Search SkyGuide::search(const TracedScene& scene, std::span<const SurfacePoint> points, std::uint64_t key) {
    constexpr std::ptrdiff_t few_cells = 32;  // if fewer cells find the sky, uniform rays are traced once more
    Search search{scene, points, key};
    search.trace_uniformly();
    const std::ptrdiff_t dark = std::count(search.squares.begin(), search.squares.end(), 0.0f);
    if (dark == cells) return search;
    if (static_cast<std::ptrdiff_t>(cells) - dark < few_cells) search.trace_uniformly();
    search.trace_guided_by(density_of(search.light()));
    return search;
}

void SkyGuide::Search::trace_uniformly() {
    std::array<std::uint8_t, cells> all_cells;
    std::iota(all_cells.begin(), all_cells.end(), std::uint8_t{0});
    for (int round = 0; round < rounds; ++round) trace(all_cells);
}

void SkyGuide::Search::trace_guided_by(const Cumulative& density) {
    std::array<std::uint8_t, cells> likely;
    for (std::size_t i = 0; i < cells; ++i)
        likely[i] = static_cast<std::uint8_t>(cell_at(density, (static_cast<double>(i) + 0.5) / cells));
    for (int round = 0; round < rounds; ++round) trace(likely);
}

void SkyGuide::Search::trace(std::span<const std::uint8_t, cells> cells_of_rays) {
    std::array<Ray, cells> sent;
    std::array<Hit, cells> hits;
    for (std::size_t i = 0; i < cells; ++i) {
        const auto words = random_words(key, static_cast<std::uint64_t>(traced) + i);
        const SurfacePoint& point = points[words[2] % points.size()];
        const std::size_t c = cells_of_rays[i];
        sent[i] = {point.position,
                   direction_in<side>(c, SteadyFrame(point.normal), unit_float(words[0]), unit_float(words[1]))};
        ++rays[c];
    }
    scene.ray_caster.trace(sent, hits);
    const auto add = [&](std::size_t i, const Rgb& transmittance) {
        const float light = luminance(transmittance * scene.sources.skies().radiance(sent[i].direction));
        squares[cells_of_rays[i]] += light * light;
    };
    for (std::size_t i = 0; i < cells; ++i)
        if (hits[i].patch == none) add(i, Rgb(1));
    traced += cells;
    if (scene.panes.empty()) return;
    std::vector<Panes::HitBehind> behind;
    scene.panes.trace(sent, hits, behind);
    for (const Panes::HitBehind& b : behind)
        if (b.hit.patch == none) add(b.ray, b.transmittance);
    traced += static_cast<std::int64_t>(behind.size());
}

SkyGuide::Cells SkyGuide::Search::light() const {
    Cells light{};
    for (std::size_t c = 0; c < cells; ++c)
        if (rays[c] > 0) light[c] = std::sqrt(squares[c] / rays[c]);
    return light;
}

SkyGuide::Cumulative SkyGuide::density_of(const Cells& light) {
    Cells weights;
    for (std::size_t c = 0; c < cells; ++c) {
        const std::size_t ring = c / side, sector = c % side;
        float around = 0;
        for (std::size_t i = std::max<std::size_t>(ring, 1) - 1; i <= std::min(ring + 1, side - 1); ++i)
            for (const std::size_t turn : {side - 1, std::size_t{0}, std::size_t{1}})
                around += light[i * side + (sector + turn) % side];
        weights[c] = light[c] + share_of_neighbours * around;
    }
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    Cumulative cumulative{};
    if (!(sum > 0)) return cumulative;
    double below = 0;
    for (std::size_t c = 0; c < cells; ++c) {
        below += static_cast<double>(weights[c]);
        cumulative[c] =
            static_cast<std::uint16_t>(std::min<double>(max_cumulative, std::round(max_cumulative * below / sum)));
    }
    cumulative.back() = max_cumulative;
    return cumulative;
}

std::size_t SkyGuide::cell_at(const Cumulative& density, double x) {
    const auto below = static_cast<std::uint16_t>(x * max_cumulative);
    return static_cast<std::size_t>(std::upper_bound(density.begin(), density.end(), below) - density.begin());
}

V3f SkyGuide::sample(std::uint32_t record, const V3f& n, double cell, float u, float v) const {
    return direction_in<side>(cell_at(densities_[groups_[record]], cell), SteadyFrame(n), u, v);
}

float SkyGuide::density(std::uint32_t record, const V3f& n, const V3f& direction) const {
    const float cosine = n.dot(direction);
    if (!(cosine > 0)) return 0;
    const SteadyFrame frame(n);
    const float turn = std::atan2(direction.dot(frame.t), direction.dot(frame.s)) / (2 * std::numbers::pi_v<float>);
    const auto cell = [](float x) { return std::min(static_cast<std::size_t>(x * side), side - 1); };
    const std::size_t c =
        cell(std::max(0.0f, 1 - cosine * cosine)) * side + cell(turn < 0 ? std::max(0.0f, turn + 1) : turn);
    const Cumulative& cumulative = densities_[groups_[record]];
    const auto width = static_cast<float>(cumulative[c] - (c > 0 ? cumulative[c - 1] : 0));
    return width / max_cumulative * (static_cast<float>(cells) * cosine / std::numbers::pi_v<float>);
}

}  // namespace interflect::detail
