#include <cstddef>
#include <vector>

#include "interflect/rates/embree_rates.h"
#include "interflect/raycast/embree/ray_recorder.h"

namespace interflect {

using namespace detail;

PictureMeasurement measure_picture(const Scene& scene, const Solution* solution, const RayCaster& ray_caster,
                                   const View& view, const PictureOptions& options, std::int64_t max_rays, int rounds) {
    const auto draw = [&] {
        return solution ? render(scene, *solution, ray_caster, view, options)
                        : render(scene, ray_caster, view, options);
    };
    PictureMeasurement measured;
    std::vector<Ray> sample;
    {
        const RayRecorder recorder(ray_caster, static_cast<std::size_t>(max_rays));
        const Rendering picture = draw();
        const auto share = [&](std::int64_t rays) {
            return static_cast<double>(rays) / static_cast<double>(picture.rays);
        };
        sample = recorder.kept();
        measured.rays = recorder.traced();
        measured.recorded = sample.size();
        measured.camera = share(picture.paths);
        measured.reflected = share(picture.rays - picture.shadow_rays - picture.paths);
        measured.shadow = share(picture.shadow_rays);
    }
    for (int round = 0; round < rounds; ++round) {
        const EmbreeRates embree = measure_embree(ray_caster, sample);
        measured.rounds.push_back({seconds_for(draw), embree});
    }
    return measured;
}

}  // namespace interflect
