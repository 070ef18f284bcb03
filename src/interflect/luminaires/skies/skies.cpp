#include "interflect/luminaires/skies/skies.h"

#include <algorithm>
#include <utility>

namespace interflect::detail {

namespace {

DirectionTable table_of(const SkyRadiance& sky) {
    const SkyGrid grid = sky.grid();
    const std::vector<Rgb> integrals = sky.cell_integrals(grid);
    std::vector<float> weights(integrals.size());
    std::transform(integrals.begin(), integrals.end(), weights.begin(), [](const Rgb& x) { return channel_sum(x); });
    return {grid, weights};
}

}  // namespace

Skies::Skies(const Scene& scene) {
    double all = 0;
    const auto add = [&](const auto& kind) {
        const SkyRadiance radiance(kind);
        DirectionTable table = table_of(radiance);
        if (!(table.sum() > 0)) return;
        all += table.sum();
        sampled_.push_back({radiance, std::move(table), all});
    };
    for (const Luminaire& luminaire : scene.luminaires) {
        if (const auto* sky = std::get_if<UniformSky>(&luminaire.kind)) uniform_ += sky->radiance;
        if (const auto* dome = std::get_if<SkyDome>(&luminaire.kind)) add(*dome);
        if (const auto* map = std::get_if<EnvironmentMap>(&luminaire.kind)) add(*map);
        if (const auto* light = std::get_if<DirectionalLight>(&luminaire.kind); light && light->diameter > 0)
            discs_.push_back({-light->direction.normalized(), light->disc_sine(), light->disc_radiance()});
    }
    for (Sampled& sky : sampled_) sky.share /= all;
}

Rgb Skies::sampled_radiance(const V3f& direction) const {
    Rgb sum(0);
    for (const Sampled& sky : sampled_) sum += sky.radiance.towards(direction);
    return sum;
}

Rgb Skies::radiance(const V3f& direction) const { return uniform_ + sampled_radiance(direction); }

Rgb Skies::radiance_with_suns(const V3f& direction) const {
    Rgb sum = radiance(direction);
    for (const Disc& disc : discs_)
        if (disc.towards.dot(direction) > 0 && disc.towards.cross(direction).length() < disc.sine) sum += disc.radiance;
    return sum;
}

Skies::Sample Skies::sample(double sky, float u, float v) const {
    if (sampled_.empty()) return {};
    std::size_t i = 0;
    while (i + 1 < sampled_.size() && sky >= sampled_[i].share) ++i;
    const V3f direction = sampled_[i].radiance.frame().direction(sampled_[i].table.sample(u, v));
    return {direction, density(direction)};
}

float Skies::density(const V3f& direction) const {
    double sum = 0, before = 0;
    for (const Sampled& sky : sampled_) {
        sum += (sky.share - before) * static_cast<double>(sky.table.density(sky.radiance.frame().place(direction)));
        before = sky.share;
    }
    return static_cast<float>(sum);
}

}  // namespace interflect::detail
