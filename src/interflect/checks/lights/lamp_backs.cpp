#include "interflect/checks/lights/lamp_backs.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>

#include "interflect/base/numbers/random.h"
#include "interflect/checks/search/finder.h"
#include "interflect/geometry/polygons/patch_geometry.h"

namespace interflect::detail {

namespace {

constexpr std::uint64_t points_behind = 32, rays_per_point_behind = 8;
constexpr std::uint64_t seed_of_places = 61, seed_behind = 62, seed_of_lit_rays = 63;
/// Minimum gap between a face and the surface behind it [m]: closer faces are flush.
constexpr float min_back_gap = 0.002f;
/// Minimum fraction of a point's hemisphere that the back of the face covers. Path tracing sees light through it.
constexpr float min_hidden_share = 0.1f;
/// Minimum fraction of the rays from the back that hit such points.
constexpr float min_close_points = 0.1f;
/// Minimum fraction of the rays from these points that end on surfaces lit by the face. Narrow gaps are nearly dark.
constexpr float min_lit_share = 0.03f;
/// Minimum area of a lamp [m^2], and maximum distance of its faces [m]. Smaller lamps affect only a spot of their own
/// size, such as the inside of a lamp shade.
constexpr float min_area = 0.02f, lamp_radius = 0.15f;

struct LitPoint {
    V3f position, normal;
};

class LampBacks {
  public:
    LampBacks(const Scene& scene, const RayCaster& ray_caster, const SightLines& lines)
        : scene_(scene), ray_caster_(ray_caster), lines_(lines) {}

    /// Whether light of the face, reflected once, arrives at surfaces close behind it.
    bool is_open(PatchIndex patch) const {
        const std::vector<LitPoint> points = points_close_behind(patch);
        if (static_cast<float>(points.size()) < min_close_points * points_behind) return false;
        std::size_t lit = 0;
        for (std::size_t i = 0; i < points.size(); ++i)
            for (std::uint64_t k = 0; k < rays_per_point_behind; ++k)
                lit += is_lit(
                    points[i],
                    SightLines::cosine_direction(points[i].normal, seed_of_lit_rays, i * rays_per_point_behind + k),
                    patch);
        return static_cast<float>(lit) >= min_lit_share * static_cast<float>(points.size() * rays_per_point_behind);
    }

  private:
    LitPoint point_at(const Ray& ray, const Hit& hit) const {
        const V3f normal = PatchGeometry(scene_, scene_.patches[hit.patch]).normal();
        return {ray.origin + hit.distance * ray.direction + ray_caster_.ray_offset(hit.patch) * normal, normal};
    }

    /// Returns points on surfaces close behind a face, without another face in between.
    std::vector<LitPoint> points_close_behind(PatchIndex patch) const {
        const PatchGeometry face(scene_, scene_.patches[patch]);
        std::vector<LitPoint> points;
        for (std::uint64_t i = 0; i < points_behind; ++i) {
            const auto words = random_words(seed_of_places, i);
            const V3f x = face.point(face.uniform_parameters(unit_float(words[0]), unit_float(words[1])));
            const Ray ray{x - ray_caster_.ray_offset(patch) * face.normal(),
                          SightLines::cosine_direction(-face.normal(), seed_behind, i)};
            const Hit hit = lines_.first_surface(ray);
            if (hit.patch == none) continue;
            const LitPoint point = point_at(ray, hit);
            const float cosine = -ray.direction.dot(face.normal()), cosine_there = -ray.direction.dot(point.normal);
            const float hidden_share =
                face.area() * cosine * cosine_there / (std::numbers::pi_v<float> * hit.distance * hit.distance);
            if (cosine * hit.distance >= min_back_gap && hidden_share >= min_hidden_share &&
                lines_.is_clear(ray.origin, point.position))
                points.push_back(point);
        }
        return points;
    }

    /// Whether a ray from a point ends on a surface that is lit by the face.
    bool is_lit(const LitPoint& from, const V3f& direction, PatchIndex patch) const {
        const Ray ray{from.position, direction};
        const Hit hit = lines_.first_surface(ray);
        if (hit.patch == none) return false;
        const LitPoint end = point_at(ray, hit);
        const PatchGeometry face(scene_, scene_.patches[patch]);
        const V3f lamp = face.centre() + ray_caster_.ray_offset(patch) * face.normal(), to_lamp = lamp - end.position;
        return to_lamp.dot(end.normal) > 0 && to_lamp.dot(face.normal()) < 0 &&
               lines_.is_clear(from.position, end.position) && lines_.is_clear(end.position, lamp);
    }

    const Scene& scene_;
    const RayCaster& ray_caster_;
    const SightLines& lines_;
};

struct EmittingFace {
    PatchIndex patch;
    V3f centre;
    float area;  // [m^2]
};

std::vector<EmittingFace> emitting_faces(const Scene& scene) {
    std::vector<EmittingFace> faces;
    for (PatchIndex i{0}; i < scene.patches.size(); ++i) {
        const Patch& patch = scene.patches[i];
        if (patch.other_side != none || !(largest_channel(scene.materials[patch.material].exitance) > 0)) continue;
        const PatchGeometry face(scene, patch);
        faces.push_back({i, face.centre(), face.area()});
    }
    return faces;
}

/// Returns the area of the emitting faces around a face, including its own [m^2].
float area_around(const EmittingFace& face, std::span<const EmittingFace> faces) {
    float area = 0;
    for (const EmittingFace& other : faces)
        if ((other.centre - face.centre).length() < lamp_radius) area += other.area;
    return area;
}

}  // namespace

std::vector<Finding> find_open_lamp_backs(const Scene& scene, const RayCaster& ray_caster, const SightLines& lines,
                                          std::size_t places) {
    constexpr std::size_t most = 512;
    Finder open(scene, places,
                {"open-lamp-back",
                 true,
                 "emitting faces hang close before a surface with open backs: their fronts stop its light, but path "
                 "tracing and gathering look through their backs",
                 "close them with a back or a housing, or set them flush with the surface",
                 0,
                 {}});
    const std::vector<EmittingFace> emitting = emitting_faces(scene);
    const LampBacks backs(scene, ray_caster, lines);
    const std::size_t step = std::max<std::size_t>(1, (emitting.size() + most - 1) / most);
    for (std::size_t k = 0; k < emitting.size(); k += step)
        if (backs.is_open(emitting[k].patch) && area_around(emitting[k], emitting) >= min_area)
            open.add_patch(emitting[k].patch);
    std::vector<Finding> findings;
    open.append_to(findings);
    return findings;
}

}  // namespace interflect::detail
