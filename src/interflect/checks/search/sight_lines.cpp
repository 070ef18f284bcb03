#include "interflect/checks/search/sight_lines.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "interflect/base/numbers/random.h"
#include "interflect/geometry/textures/tangent_frame.h"

namespace interflect::detail {

SightLines::SightLines(const Scene& scene, const RayCaster& ray_caster)
    : ray_caster_(ray_caster), panes_(scene, ray_caster) {}

Hit SightLines::first_surface(const Ray& ray) const {
    Hit hit;
    ray_caster_.trace({&ray, 1}, {&hit, 1});
    std::vector<Panes::HitBehind> behind;
    panes_.trace({&ray, 1}, {&hit, 1}, behind);
    return behind.empty() ? hit : behind.back().hit;
}

bool SightLines::is_clear(const V3f& a, const V3f& b) const {
    constexpr float rounding = 1e-4f;
    const float length = (b - a).length();
    const auto reaches = [&](const V3f& from, const V3f& to) {
        const Hit hit = first_surface({from, (to - from) / length});
        return hit.patch == none || hit.distance > (1 - rounding) * length;
    };
    // Rounding hides surfaces close to the target; the reverse ray finds them.
    return !(length > 0) || (reaches(a, b) && reaches(b, a));
}

SightLines::RayOutcomes SightLines::trace_from_surface(const V3f& x, const V3f& normal, std::uint64_t key,
                                                       int max_escaped) const {
    RayOutcomes outcomes;
    for (std::uint64_t i = 0; i < rays_per_point && outcomes.escaped <= max_escaped; ++i) {
        const Hit hit = first_surface({x, cosine_direction(normal, key, i)});
        if (hit.patch == none) {
            ++outcomes.escaped;
        } else {
            ++outcomes.hits;
            outcomes.distance_sum += hit.distance;
        }
    }
    return outcomes;
}

bool SightLines::is_open(const V3f& x) const {
    constexpr std::uint64_t rays = 64, seed = 21;
    std::uint64_t escaped = 0;
    for (std::uint64_t i = 0; i < rays; ++i) escaped += first_surface({x, uniform_direction(seed, i)}).patch == none;
    return 4 * escaped >= rays;
}

V3f SightLines::uniform_direction(std::uint64_t key, std::uint64_t index) {
    const auto words = random_words(key, index);
    const float z = 1 - 2 * unit_float(words[0]), radius = std::sqrt(std::max(0.0f, 1 - z * z));
    const float angle = 2 * std::numbers::pi_v<float> * unit_float(words[1]);
    return {radius * std::cos(angle), radius * std::sin(angle), z};
}

V3f SightLines::cosine_direction(const V3f& normal, std::uint64_t key, std::uint64_t index) {
    const auto words = random_words(key, index);
    const float radius = std::sqrt(unit_float(words[0])), angle = 2 * std::numbers::pi_v<float> * unit_float(words[1]);
    const TangentFrame frame(normal);
    return (radius * std::cos(angle) * frame.s + radius * std::sin(angle) * frame.t +
            std::sqrt(1 - radius * radius) * normal)
        .normalized();
}

}  // namespace interflect::detail
