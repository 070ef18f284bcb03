#include "tests/support/brute_force.h"

#include <limits>
#include <random>
#include <vector>

#include "interflect/base/threads/parallel.h"

namespace interflect::testing_support {

using namespace detail;

namespace {

using Random = std::mt19937_64;

struct Target {
    V3d corner, normal, to_u, to_v;  // to_u . (x - corner) is the coordinate along u, in [0, 1] inside
    explicit Target(const Rectangle& r)
        : corner(r.corner), normal(r.normal()), to_u(r.u / r.u.length2()), to_v(r.v / r.v.length2()) {}
};

double uniform(Random& random) { return std::uniform_real_distribution<double>()(random); }

/// Returns a point of the unit sphere on top of the unit normal: its direction is cosine-distributed.
V3d cosine_direction(const V3d& normal, Random& random) {
    for (;;) {
        const V3d p(2 * uniform(random) - 1, 2 * uniform(random) - 1, 2 * uniform(random) - 1);
        const double length = p.length();
        if (length > 1 || length < 1e-3) continue;
        return (normal + p / length).normalized();
    }
}

/// Returns the index of the nearest rectangle whose lit side the ray hits, or targets.size().
std::size_t nearest(const std::vector<Target>& targets, const V3d& origin, const V3d& direction) {
    constexpr double start = 1e-9;   // [m], prevents hits on the starting rectangle
    constexpr double slack = 1e-12;  // closes gaps between rectangles
    double distance = std::numeric_limits<double>::infinity();
    std::size_t hit = targets.size();
    for (std::size_t i = 0; i < targets.size(); ++i) {
        const Target& t = targets[i];
        const double facing = t.normal.dot(direction);
        if (facing >= 0) continue;
        const double s = t.normal.dot(t.corner - origin) / facing;
        if (s < start || s >= distance) continue;
        const V3d offset = origin + s * direction - t.corner;
        const double u = t.to_u.dot(offset), v = t.to_v.dot(offset);
        if (u < -slack || u > 1 + slack || v < -slack || v > 1 + slack) continue;
        distance = s;
        hit = i;
    }
    return hit;
}

}  // namespace

FormFactors traced_form_factors(const Scene& scene, std::int64_t rays_per_patch, std::uint64_t seed) {
    const std::vector<Rectangle> rectangles = rectangles_of(scene);
    const std::vector<Target> targets(rectangles.begin(), rectangles.end());
    FormFactors f(rectangles.size());
    parallel_for_ranges(rectangles.size(), 1, [&](std::size_t i, std::size_t) {
        const Rectangle& from = rectangles[i];
        std::seed_seq sequence{seed, static_cast<std::uint64_t>(i)};
        Random random(sequence);
        for (std::int64_t ray = 0; ray < rays_per_patch; ++ray) {
            const V3d origin = from.corner + uniform(random) * from.u + uniform(random) * from.v;
            const std::size_t hit = nearest(targets, origin, cosine_direction(targets[i].normal, random));
            if (hit < targets.size()) f(i, hit) += 1.0 / static_cast<double>(rays_per_patch);
        }
    });
    return f;
}

}  // namespace interflect::testing_support
