// Steps of PathIntegrator for known reflected light, from the elements of a solution or from virtual lights.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "interflect/render/paths/path_integrator.h"
#include "interflect/render/reflections/known_light.h"
#include "interflect/render/reflections/virtual_lights.h"

namespace interflect::detail {

namespace {

/// Number of shadow rays to virtual lights at the first vertex.
constexpr std::uint32_t virtual_shadow_rays = 4;

/// Returns the expected density, per path, of rays towards a place of KnownLight [1/sr]; 0 from behind its patch.
/// @param of_place   Density of KnownLight::sample() [1/m^2].
/// @param distance2  Squared distance of the place [m^2].
float density_towards(const PathPlan& plan, const KnownLight::Place& place, float of_place, const V3f& direction,
                      float distance2) {
    const float cosine = -plan.scene.geometry[place.patch].normal().dot(direction);
    return cosine > 0 ? of_place * distance2 / (cosine * static_cast<float>(plan.paths_per_place)) : 0;
}

}  // namespace

bool PathIntegrator::end_at_known_light(const Hit& hit, const V3f& x, const V3f& direction, float distance,
                                        const Path& path) {
    if (!plan_.known || vertex_ == 1) return false;
    const KnownLight::Place place = plan_.known->place(hit.patch, x);
    const float distance2 = distance * distance;
    if (!plan_.known->is_far(place, distance2)) return false;
    const float light_density =
        density_towards(plan_, place, plan_.known->density(place, path.position, path.normal), direction, distance2);
    const float weight = balance(path.normal.dot(direction) / std::numbers::pi_v<float>, light_density);
    add(path.half_batch, vertex_, path.throughput * plan_.known->reflected_radiance(place) * weight);
    return true;
}

void PathIntegrator::connect_to_known_light(const Path& path) {
    if (path.index_in_sequence % plan_.paths_per_place != 0) return;
    const LightSample numbers = light_sample(keys_[path.half_batch], vertex_, LightStream::reflections,
                                             path.index_in_sequence / plan_.paths_per_place);
    const auto [place, density] = plan_.known->sample(path.position, path.normal, numbers.choice, numbers.u, numbers.v);
    if (place.patch == none) return;
    const V3f to_light = plan_.scene.geometry[place.patch].point(place.parameters) - path.position;
    const float distance2 = to_light.length2();
    if (!(distance2 > 0) || !plan_.known->is_far(place, distance2)) return;
    const V3f direction = to_light / std::sqrt(distance2);
    const float direction_density = path.normal.dot(direction) / std::numbers::pi_v<float>;
    const float light_density = density_towards(plan_, place, density, direction, distance2);
    if (!(direction_density > 0 && light_density > 0)) return;
    const float weight = balance(light_density, direction_density);
    shadow_rays_.add({path.position, direction}, place.patch, 0);
    connections_.push_back(
        {path.half_batch, vertex_ + 1,
         path.throughput * plan_.known->reflected_radiance(place) * (direction_density / light_density * weight)});
}

void PathIntegrator::connect_to_virtual_lights(const Path& path) {
    const VirtualLights& lights = *plan_.virtual_lights;
    const std::uint32_t count = vertex_ == 1 ? virtual_shadow_rays : 1;
    for (std::uint32_t k = 0; k < count; ++k) {
        const double uniform =
            light_sample(keys_[path.half_batch], vertex_, LightStream::reflections, path.index_in_sequence * count + k)
                .choice;
        const LightTree::Choice choice = lights.choose(path.position, path.normal, uniform);
        if (choice.index == none) continue;
        const VirtualLights::Light& light = lights.lights()[choice.index];
        const V3f to_light = light.position - path.position;
        const float distance2 = to_light.length2();
        if (!(distance2 > 0)) continue;
        const V3f direction = to_light / std::sqrt(distance2);
        const float cosine = path.normal.dot(direction),
                    other = -plan_.scene.geometry[light.patch].normal().dot(direction);
        if (!(cosine > 0 && other > 0)) continue;
        const float bounded = std::min(cosine * other / distance2, lights.bound(light.patch));
        const float per_flux = bounded / (std::numbers::pi_v<float> * std::numbers::pi_v<float> * choice.probability *
                                          static_cast<float>(count));
        shadow_rays_.add({path.position, direction}, light.patch, 0);
        connections_.push_back({path.half_batch, vertex_ + 1, path.throughput * light.flux * per_flux});
    }
}

float PathIntegrator::share_beyond_virtual_lights(const Hit& hit, const V3f& direction, float distance,
                                                  const Path& path) const {
    const float other = -plan_.scene.geometry[hit.patch].normal().dot(direction);
    const float geometric_term = path.normal.dot(direction) * std::max(0.0f, other) / (distance * distance);
    const float bound = plan_.virtual_lights->bound(hit.patch);
    return geometric_term > bound ? 1 - bound / geometric_term : 0;
}

}  // namespace interflect::detail
