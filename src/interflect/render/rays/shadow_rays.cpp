#include "interflect/render/rays/shadow_rays.h"

#include "interflect/core.h"

namespace interflect::detail {

void ShadowRays::add(const Ray& ray, PatchIndex patch, float distance) {
    rays_.push_back(ray);
    targets_.push_back({patch, distance});
}

std::span<const Rgb> ShadowRays::trace(const RayCaster& ray_caster, const Panes& panes, RayCounts& counts) {
    hits_.resize(rays_.size());
    ray_caster.trace(rays_, hits_);
    counts.rays += static_cast<std::int64_t>(rays_.size());
    counts.shadow_rays += static_cast<std::int64_t>(rays_.size());
    transmittance_.assign(rays_.size(), Rgb(1));
    if (!panes.empty()) pass_panes(ray_caster, panes, counts);
    for (std::size_t i = 0; i < rays_.size(); ++i)
        if (!targets_[i].is_met(hits_[i])) transmittance_[i] = Rgb(0);
    rays_.clear();
    targets_.clear();
    return transmittance_;
}

void ShadowRays::pass_panes(const RayCaster& ray_caster, const Panes& panes, RayCounts& counts) {
    std::vector<std::size_t> passing;  // indices of the rays that pass a pane
    std::vector<Ray> rest;             // their parts behind the pane
    std::vector<Hit> behind;
    for (int round = 0; round < Panes::max_consecutive_panes; ++round) {
        passing.clear();
        rest.clear();
        for (std::size_t i = 0; i < rays_.size(); ++i) {
            if (targets_[i].is_met(hits_[i])) continue;
            const Rgb through = panes.transmittance(rays_[i], hits_[i]);
            if (!(largest_channel(through) > 0)) continue;
            passing.push_back(i);
            rest.push_back(panes.behind(rays_[i], hits_[i]));
            transmittance_[i] *= through;
            targets_[i].distance -= hits_[i].distance;
        }
        if (passing.empty()) return;
        behind.resize(rest.size());
        ray_caster.trace(rest, behind);
        counts.rays += static_cast<std::int64_t>(rest.size());
        for (std::size_t k = 0; k < passing.size(); ++k) rays_[passing[k]] = rest[k], hits_[passing[k]] = behind[k];
    }
}

}  // namespace interflect::detail
