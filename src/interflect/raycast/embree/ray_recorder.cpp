#include "interflect/raycast/embree/ray_recorder.h"

#include "interflect/raycast/embree/embree.h"

namespace interflect::detail {

RayRecorder::RayRecorder(const RayCaster& ray_caster, std::size_t max_rays)
    : ray_caster_(ray_caster), max_rays_(max_rays) {
    ray_caster_.embree_->recorder = this;
}

RayRecorder::~RayRecorder() { ray_caster_.embree_->recorder = nullptr; }

void RayRecorder::record(std::span<const Ray> rays) {
    const std::lock_guard lock(mutex_);
    traced_ += static_cast<std::int64_t>(rays.size());
    if (!std::bernoulli_distribution(probability_)(random_)) return;
    calls_.emplace_back(rays.begin(), rays.end());
    kept_rays_ += rays.size();
    while (kept_rays_ > max_rays_ && calls_.size() > 1) keep_half();
}

void RayRecorder::keep_half() {
    probability_ /= 2;
    std::erase_if(calls_, [&](const std::vector<Ray>& call) {
        const bool is_dropped = std::bernoulli_distribution(0.5)(random_);
        if (is_dropped) kept_rays_ -= call.size();
        return is_dropped;
    });
}

std::vector<Ray> RayRecorder::kept() const {
    std::vector<Ray> result;
    result.reserve(kept_rays_);
    for (const std::vector<Ray>& call : calls_) result.insert(result.end(), call.begin(), call.end());
    return result;
}

}  // namespace interflect::detail
