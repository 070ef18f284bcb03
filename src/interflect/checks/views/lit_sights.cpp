#include "interflect/checks/views/lit_sights.h"

#include <algorithm>
#include <numbers>
#include <numeric>
#include <variant>

#include "interflect/base/numbers/random.h"
#include "interflect/checks/search/one_way.h"
#include "interflect/core.h"
#include "interflect/geometry/polygons/patch_geometry.h"
#include "interflect/luminaires/illumination.h"

namespace interflect::detail {

namespace {

constexpr std::uint64_t seed_of_bounces = 71, seed_of_sources = 72;

/// Limit of the luminaires that paths sample, and of the emitting patches. Beyond it, paths sample every k-th one.
constexpr std::size_t max_sources = 256;

/// Shadow rays end before the source by this share of their length, because sources lie in or on faces.
constexpr float gap_before_source = 1e-3f;

template <class T>
std::vector<T> every_kth(const std::vector<T>& all) {
    const std::size_t step = (all.size() + max_sources - 1) / max_sources;
    std::vector<T> chosen;
    for (std::size_t i = 0; i < all.size(); i += step) chosen.push_back(all[i]);
    return chosen;
}

V3f place_of(const Luminaire& luminaire) {
    if (const auto* point = std::get_if<PointLight>(&luminaire.kind)) return point->position;
    if (const auto* spot = std::get_if<SpotLight>(&luminaire.kind)) return spot->position;
    return std::get<MeasuredLight>(luminaire.kind).position;
}

}  // namespace

LitSights::LitSights(const Scene& scene, const RayCaster& ray_caster)
    : scene_(scene),
      ray_caster_(ray_caster),
      lines_(scene, ray_caster),
      has_panes_(std::any_of(scene.materials.begin(), scene.materials.end(),
                             [](const Material& m) { return largest_channel(m.transmittance) > 0; })),
      has_one_sided_faces_(std::any_of(scene.patches.begin(), scene.patches.end(),
                                       [](const Patch& patch) { return patch.other_side == none; })) {
    std::vector<const Luminaire*> local;
    for (const Luminaire& luminaire : scene.luminaires) {
        if (!(largest_channel(rating(luminaire)) > 0)) continue;
        if (is_sky(luminaire))
            has_sky_ = true;
        else
            (std::holds_alternative<DirectionalLight>(luminaire.kind) ? suns_ : local).push_back(&luminaire);
    }
    std::vector<PatchIndex> emitting;
    for (PatchIndex i{0}; i < scene.patches.size(); ++i)
        if (largest_channel(scene.materials[scene.patches[i].material].exitance) > 0) emitting.push_back(i);
    for (const Luminaire* luminaire : every_kth(local))
        sources_.push_back({place_of(*luminaire), largest_channel(rating(*luminaire)), luminaire, {}});
    for (const PatchIndex i : every_kth(emitting)) {
        const PatchGeometry geometry(scene, scene.patches[i]);
        const float exitance = largest_channel(scene.materials[scene.patches[i].material].exitance);
        sources_.push_back({geometry.centre(), geometry.area() * exitance * std::numbers::inv_pi_v<float>, nullptr, i});
    }
    for (const Patch& patch : scene.patches)
        for (int k = 0; k < patch.vertex_count(); ++k)
            beyond_ = std::max(beyond_, 2 * scene.vertices[patch.vertices[static_cast<std::size_t>(k)]].length());
}

std::vector<Sight> LitSights::look(const V3f& eye, std::span<const V3f> directions) const {
    const Weights weights = weights_at(eye);
    std::vector<Sight> sights;
    for (const V3f& direction : directions) sights.push_back(sight({eye, direction}, weights, sights.size()));
    return sights;
}

Sight LitSights::sight(const Ray& ray, const Weights& weights, std::uint64_t index) const {
    Meeting point = meet(ray);
    Sight sight{ray.direction, point.distance, point.patch != none, point.is_back};
    if (point.patch == none) return sight;
    sight.is_lit = largest_channel(material(point).exitance) > 0;
    for (std::uint64_t k = 0; k < max_reflections; ++k) {
        // Test the direct light of this point, unless it is black
        const std::uint64_t vertex = index * max_reflections + k;
        const Material& surface = material(point);
        const bool reflects =
            largest_channel(surface.reflectance) > 0 || largest_channel(surface.specular_reflectance) > 0;
        sight.is_lit = sight.is_lit || (reflects && receives_light(point, weights, vertex));
        if (k > 0 && (sight.is_lit || !reflects)) break;
        // Continue in a random direction, which also tests whether the first surface is enclosed
        const Meeting next =
            meet({point.position, SightLines::cosine_direction(point.normal, seed_of_bounces, vertex)});
        if (k == 0) sight.is_enclosed = next.patch != none;
        if (!reflects || sight.is_lit) break;
        sight.is_lit = next.patch == none ? has_sky_ && next.escapes() : largest_channel(material(next).exitance) > 0;
        if (next.patch == none) break;
        point = next;
    }
    return sight;
}

LitSights::Weights LitSights::weights_at(const V3f& eye) const {
    constexpr float least_distance2 = 1e-6f;  // [m^2]
    Weights weights;
    for (const Source& source : sources_)
        weights.push_back(source.intensity / std::max(least_distance2, (source.position - eye).length2()));
    std::partial_sum(weights.begin(), weights.end(), weights.begin());
    return weights;
}

LitSights::Meeting LitSights::meet(const Ray& ray) const {
    Hit hit;
    ray_caster_.trace({&ray, 1}, {&hit, 1});
    if (has_one_sided_faces_ && passes_back(ray, hit)) return {.is_back = true};
    if (hit.patch == none) return {};
    if (has_panes_) hit = lines_.first_surface(ray);
    if (hit.patch == none) return {};
    const V3f normal = PatchGeometry(scene_, scene_.patches[hit.patch]).normal();
    const V3f x = ray.origin + hit.distance * ray.direction;
    return {hit.patch, false, hit.distance, x + ray_caster_.ray_offset(hit.patch) * normal, normal};
}

bool LitSights::passes_back(const Ray& ray, const Hit& hit) const {
    constexpr float rounding = 1e-4f;  // excludes the surface from which the ray starts
    if (hit.patch != none) return is_one_way(scene_, ray_caster_, ray, hit);
    const Ray reversed{ray.origin + beyond_ * ray.direction, -ray.direction};
    Hit front;
    ray_caster_.trace({&reversed, 1}, {&front, 1});
    return front.patch != none && front.distance < (1 - rounding) * beyond_;
}

const Material& LitSights::material(const Meeting& point) const {
    return scene_.materials[scene_.patches[point.patch].material];
}

bool LitSights::receives_light(const Meeting& point, const Weights& weights, std::uint64_t index) const {
    const auto words = random_words(seed_of_sources, index);
    const float u = unit_float(words[0]), v = unit_float(words[1]);
    for (const Luminaire* sun : suns_) {
        const V3f towards = illumination(*sun, point.position, u, v).towards;
        if (towards.dot(point.normal) > 0 && meet({point.position, towards}).escapes()) return true;
    }
    if (weights.empty()) return false;
    const auto chosen = std::upper_bound(weights.begin(), weights.end(), unit_float(words[2]) * weights.back());
    const auto last = static_cast<std::ptrdiff_t>(sources_.size()) - 1;
    return receives_light(point, sources_[static_cast<std::size_t>(std::min(chosen - weights.begin(), last))], u, v);
}

bool LitSights::receives_light(const Meeting& point, const Source& source, float u, float v) const {
    if (source.luminaire) {
        const Illumination light = illumination(*source.luminaire, point.position, u, v);
        return largest_channel(light.irradiance) > 0 && is_unoccluded(point, light.towards, light.distance);
    }
    const PatchGeometry geometry(scene_, scene_.patches[source.patch]);
    const V3f line = geometry.point(geometry.uniform_parameters(u, v)) - point.position;
    return line.dot(geometry.normal()) < 0 && is_unoccluded(point, line.normalized(), line.length());
}

bool LitSights::is_unoccluded(const Meeting& point, const V3f& towards, float distance) const {
    return towards.dot(point.normal) > 0 &&
           lines_.is_clear(point.position, point.position + (1 - gap_before_source) * distance * towards);
}

}  // namespace interflect::detail
