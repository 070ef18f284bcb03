#include "interflect/checks/search/shell.h"

#include <ImathBox.h>

#include <algorithm>

#include "interflect/geometry/polygons/patch_geometry.h"
#include "interflect/scene/core/core.h"

namespace interflect::detail {

namespace {

/// Limits of escaping rays, of SightLines::rays_per_point, on inner sides and on outer sides.
constexpr int max_escaped_inside = 2;
constexpr int min_escaped_outside = SightLines::rays_per_point / 4;  // walls on a ground have half
constexpr std::uint64_t seed_of_origins = 11, seed_of_directions = 12, seed_of_sides = 13;

/// Random lines through the sphere around the scene, uniform and isotropic.
class OuterLines {
  public:
    explicit OuterLines(const Scene& scene) {
        const Imath::Box3f box = core_bounds(scene);
        centre_ = box.center();
        constexpr float margin = 1.01f;
        radius_ = margin * box.size().length() / 2;
    }
    Ray operator()(std::uint64_t index) const {
        const V3f out = SightLines::uniform_direction(seed_of_origins, index);
        return {centre_ + radius_ * out, SightLines::cosine_direction(-out, seed_of_directions, index)};
    }

  private:
    V3f centre_;
    float radius_;
};

/// First face that a line meets.
struct MetFace {
    V3f front, back;  ///< Points just off both sides [m].
    V3f normal;       ///< Towards the start of the line.
};

MetFace met_face(const Scene& scene, const RayCaster& ray_caster, const Ray& line, const Hit& hit) {
    const V3f normal = PatchGeometry(scene, scene.patches[hit.patch]).normal();
    const V3f x = line.origin + hit.distance * line.direction, offset = ray_caster.ray_offset(hit.patch) * normal;
    return {x + offset, x - offset, normal};
}

bool is_seen_inside(const Scene& scene, const SightLines& lines) {
    constexpr float min_extent = 2;  // of a room [m]
    if (scene.views.empty()) {
        const V3f extent = core_bounds(scene).size();
        return std::min({extent.x, extent.y, extent.z}) >= min_extent;
    }
    return std::any_of(scene.views.begin(), scene.views.end(),
                       [&](const View& view) { return !lines.is_open(V3f(view.eye - scene.origin)); });
}

}  // namespace

Shell find_shell(const Scene& scene, const RayCaster& ray_caster, const SightLines& lines) {
    constexpr std::uint64_t count = 128;
    constexpr int min_met = 32;
    const OuterLines line(scene);
    // Lines that meet a face, pass a solid or find an inner side; number and sum of free paths from inner sides.
    int met = 0, solid = 0, enclosing = 0, paths = 0;
    float length = 0;
    for (std::uint64_t i = 0; i < count; ++i) {
        const Hit hit = lines.first_surface(line(i));
        if (hit.patch == none) continue;
        ++met;
        const MetFace face = met_face(scene, ray_caster, line(i), hit);
        // Few rays leave the inner side, which is the back of the face or, for lines through an opening, its front.
        SightLines::RayOutcomes inner =
            lines.trace_from_surface(face.back, -face.normal, seed_of_sides, max_escaped_inside);
        if (inner.escaped > max_escaped_inside)
            inner = lines.trace_from_surface(face.front, face.normal, seed_of_sides, min_escaped_outside);
        if (inner.escaped > min_escaped_outside && scene.patches[hit.patch].other_side == none) {
            // In a thick wall, the inner side is on the next face of the line.
            const Ray behind{face.back, line(i).direction};
            const Hit inner_hit = lines.first_surface(behind);
            if (inner_hit.patch == none) {
                ++solid;
                continue;
            }
            const MetFace inner_face = met_face(scene, ray_caster, behind, inner_hit);
            inner = lines.trace_from_surface(inner_face.front, inner_face.normal, seed_of_sides, max_escaped_inside);
        }
        if (inner.escaped > max_escaped_inside) continue;
        ++enclosing;
        paths += inner.hits;
        length += inner.distance_sum;
    }
    if (met < min_met || 2 * solid > met || 10 * enclosing < 9 * (met - solid)) return {};
    return {true, is_seen_inside(scene, lines), length / static_cast<float>(paths)};
}

bool has_opening(const Scene& scene, const RayCaster& ray_caster, const SightLines& lines) {
    constexpr std::uint64_t count = 1 << 14;
    const OuterLines line(scene);
    for (std::uint64_t i = 0; i < count; ++i) {
        const Hit hit = lines.first_surface(line(i));
        if (hit.patch == none) continue;
        const MetFace face = met_face(scene, ray_caster, line(i), hit);
        const SightLines::RayOutcomes outcomes =
            lines.trace_from_surface(face.front, face.normal, seed_of_sides, max_escaped_inside);
        if (outcomes.escaped <= max_escaped_inside) return true;
    }
    return false;
}

}  // namespace interflect::detail
