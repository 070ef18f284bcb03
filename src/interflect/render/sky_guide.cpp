#include "interflect/render/sky_guide.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "interflect/base/parallel.h"
#include "interflect/base/random.h"
#include "interflect/geometry/tangent_frame.h"
#include "interflect/render/path_wavefront.h"

namespace interflect::detail {

namespace {

constexpr float pi = std::numbers::pi_v<float>;
constexpr std::size_t records_per_task = 64;

/// Nearly the same for nearly the same normals: those of walls and floors are far from its singularity.
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
        const float radius = std::sqrt(a), turn = 2 * pi * b;
        return s * (radius * std::cos(turn)) + t * (radius * std::sin(turn)) + n * std::sqrt(1 - a);
    }
};

}  // namespace

SkyGuide::SkyGuide(const PathScene& scene, const IndirectField& field, const std::atomic<bool>* stop) {
    if (!scene.skies.can_sample() && !(channel_sum(scene.skies.uniform_radiance()) > 0)) return;
    std::vector<Cells> seen(field.size(), Cells{});
    rays_ = parallel_sum(field.size(), records_per_task, std::int64_t{0}, [&](std::size_t begin, std::size_t end) {
        std::int64_t rays = 0;
        for (std::size_t i = begin; i < end && !(stop && *stop); ++i)
            rays += add_visible_sky(scene, field.place(i), mix(mix(scene.options.seed, i), 1), seen[i]);
        return rays;
    });
    std::vector<Cells> nearby(field.size(), Cells{});
    parallel_for_ranges(field.size(), records_per_task, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end && !(stop && *stop); ++i) {
            const SurfacePoint& place = field.place(i);
            field.visit_near(place.position, place.normal, place.patch, [&](std::uint32_t record, float) {
                for (std::size_t c = 0; c < cells; ++c) nearby[i][c] += seen[record][c];
            });
        }
    });
    rows_.assign(field.size(), none);
    for (std::size_t i = 0; i < field.size(); ++i) {
        if (std::all_of(nearby[i].begin(), nearby[i].end(), [](float square) { return square == 0; })) continue;
        rows_[i] = static_cast<std::uint32_t>(densities_.size());
        densities_.push_back(cumulative_of(nearby[i]));
    }
}

std::int64_t SkyGuide::add_visible_sky(const PathScene& s, const SurfacePoint& place, std::uint64_t key,
                                       Cells& squares) {
    std::array<Ray, cells> rays;
    std::array<Hit, cells> hits;
    const SteadyFrame frame(place.normal);
    for (std::size_t c = 0; c < cells; ++c) {
        const auto words = random_words(key, c);
        const float a = (static_cast<float>(c / side) + unit_float(words[0])) / side,
                    b = (static_cast<float>(c % side) + unit_float(words[1])) / side;
        rays[c] = {place.position, frame.direction(a, b)};
    }
    s.ray_caster.trace(rays, hits);
    const auto add = [&](std::size_t c, const Rgb& transmittance) {
        const float found = luminance(transmittance * s.skies.radiance(rays[c].direction));
        squares[c] += found * found;
    };
    for (std::size_t c = 0; c < cells; ++c)
        if (hits[c].patch == none) add(c, Rgb(1));
    if (s.panes.empty()) return cells;
    std::vector<Panes::HitBehind> behind;
    s.panes.trace(rays, hits, behind);
    for (const Panes::HitBehind& b : behind)
        if (b.hit.patch == none) add(b.ray, b.transmittance);
    return static_cast<std::int64_t>(cells + behind.size());
}

SkyGuide::Cumulative SkyGuide::cumulative_of(const Cells& squares) {
    constexpr float share_of_neighbours = 0.1f;
    Cells weights;
    float sum = 0;
    for (std::size_t c = 0; c < cells; ++c) {
        const std::size_t ring = c / side, sector = c % side;
        float around = 0;
        for (std::size_t i = std::max<std::size_t>(ring, 1) - 1; i <= std::min(ring + 1, side - 1); ++i)
            for (const std::size_t turn : {side - 1, std::size_t{0}, std::size_t{1}})
                around += std::sqrt(squares[i * side + (sector + turn) % side]);
        weights[c] = std::sqrt(squares[c]) + share_of_neighbours * around;
        sum += weights[c];
    }
    Cumulative cumulative;
    double below = 0;
    for (std::size_t c = 0; c < cells; ++c) {
        below += static_cast<double>(weights[c]);
        cumulative[c] = static_cast<std::uint16_t>(
            std::min<double>(max_cumulative, std::round(max_cumulative * below / static_cast<double>(sum))));
    }
    cumulative.back() = max_cumulative;
    return cumulative;
}

V3f SkyGuide::sample(std::uint32_t record, const V3f& n, double cell, float u, float v) const {
    const Cumulative& cumulative = densities_[rows_[record]];
    const auto below = static_cast<std::uint16_t>(cell * max_cumulative);
    const auto c =
        static_cast<std::size_t>(std::upper_bound(cumulative.begin(), cumulative.end(), below) - cumulative.begin());
    return SteadyFrame(n).direction((static_cast<float>(c / side) + u) / side,
                                    (static_cast<float>(c % side) + v) / side);
}

float SkyGuide::density(std::uint32_t record, const V3f& n, const V3f& direction) const {
    const float cosine = n.dot(direction);
    if (!(cosine > 0)) return 0;
    const SteadyFrame frame(n);
    const float turn = std::atan2(direction.dot(frame.t), direction.dot(frame.s)) / (2 * pi);
    const auto cell = [](float x) { return std::min(static_cast<std::size_t>(x * side), side - 1); };
    const std::size_t c =
        cell(std::max(0.0f, 1 - cosine * cosine)) * side + cell(turn < 0 ? std::max(0.0f, turn + 1) : turn);
    const Cumulative& cumulative = densities_[rows_[record]];
    const auto width = static_cast<float>(cumulative[c] - (c > 0 ? cumulative[c - 1] : 0));
    return width / max_cumulative * (static_cast<float>(cells) * cosine / pi);
}

}  // namespace interflect::detail
