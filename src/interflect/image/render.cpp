#include "interflect/image/render.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <numbers>
#include <optional>
#include <vector>

#include "interflect/base/error.h"
#include "interflect/base/parallel.h"
#include "interflect/base/points.h"
#include "interflect/base/random.h"
#include "interflect/image/camera.h"
#include "interflect/scene/patch_geometry.h"

namespace interflect {

namespace {

/// Rays that are traced together, about: many enough to hide the cost of a batch, few enough to stay in the cache.
constexpr std::size_t rays_per_batch = 4096;

/// Luminance at points of the scene's surfaces.
class Shader {
  public:
    Shader(const Scene& scene, std::span<const Rgb> irradiance, const RenderOptions& options)
        : scene_(scene), irradiance_(irradiance) {
        if (options.shading == Shading::smooth) smooth_.emplace(scene, irradiance, options.smoothing);
    }

    /// L = B / pi with B = M + rho H, where `ray` hit.
    Rgb luminance_at(const Ray& ray, const Hit& hit) const {
        const Patch& patch = scene_.patches[hit.patch];
        const Material& material = scene_.materials[patch.material];
        const Rgb radiosity = material.exitance + material.reflectance * irradiance_at(ray, hit, patch);
        return radiosity / std::numbers::pi_v<float>;
    }

  private:
    Rgb irradiance_at(const Ray& ray, const Hit& hit, const Patch& patch) const {
        if (!smooth_) return irradiance_[hit.patch];
        const V3f point = ray.origin + hit.distance * ray.direction;
        return smooth_->at(hit.patch, PatchGeometry(scene_, patch).parameters_of(point));
    }

    const Scene& scene_;
    std::span<const Rgb> irradiance_;
    std::optional<SmoothIrradiance> smooth_;
};

/// The eye rays of one pixel after the other, jittered by a low-discrepancy sequence of each pixel's own.
void append_pixel_rays(const Camera& camera, std::size_t pixel, const RenderOptions& options, std::vector<Ray>& rays) {
    const auto left = static_cast<float>(pixel % static_cast<std::size_t>(options.width));
    const std::size_t row = pixel / static_cast<std::size_t>(options.width);
    const auto top = static_cast<float>(row);
    const auto samples = static_cast<std::size_t>(options.samples);
    thread_local PointBlock points;
    for (std::size_t first = 0; first < samples; first += PointBlock::capacity) {
        const std::size_t count = std::min(PointBlock::capacity, samples - first);
        fill_points(PointSet::sobol, mix(options.seed, pixel), first, count, points);
        for (std::size_t i = 0; i < count; ++i)
            rays.push_back(camera.ray(left + points.coordinate[0][i], top + points.coordinate[1][i]));
    }
}

void require_valid(const Scene& scene, std::span<const Rgb> irradiance, const RenderOptions& options) {
    if (irradiance.size() != scene.patches.size())
        throw InputError(fmt::format("irradiance has {} values, expected one for each of the scene's {} patches",
                                     irradiance.size(), scene.patches.size()));
    if (options.samples < 1) throw InputError(fmt::format("{} samples a pixel: expected 1 or more", options.samples));
}

}  // namespace

Rendering render(const Scene& scene, const RayCaster& ray_caster, const View& view, std::span<const Rgb> irradiance,
                 const RenderOptions& options) {
    require_valid(scene, irradiance, options);
    const Camera camera(view, options.width, options.height);
    const Shader shader(scene, irradiance, options);

    Rendering result;
    result.image = Image(options.width, options.height);
    std::vector<Rgb>& pixels = result.image.pixels;
    const auto samples = static_cast<std::size_t>(options.samples);
    const std::size_t pixels_per_batch = std::max<std::size_t>(1, rays_per_batch / samples);
    std::atomic<std::int64_t> escaped_rays{0};

    parallel_for_ranges(pixels.size(), pixels_per_batch, [&](std::size_t begin, std::size_t end) {
        std::vector<Ray> rays;
        rays.reserve((end - begin) * samples);
        for (std::size_t pixel = begin; pixel < end; ++pixel) append_pixel_rays(camera, pixel, options, rays);
        std::vector<Hit> hits(rays.size());
        ray_caster.trace(rays, hits);

        std::int64_t escaped = 0;
        for (std::size_t pixel = begin; pixel < end; ++pixel) {
            RgbD sum(0, 0, 0);
            for (std::size_t i = (pixel - begin) * samples; i < (pixel - begin + 1) * samples; ++i) {
                if (hits[i].patch == none)
                    ++escaped;
                else
                    sum += RgbD(shader.luminance_at(rays[i], hits[i]));
            }
            pixels[pixel] = Rgb(sum / static_cast<double>(samples));
        }
        escaped_rays += escaped;
    });

    result.rays = static_cast<std::int64_t>(pixels.size() * samples);
    result.escaped_rays = escaped_rays;
    result.non_finite_pixels = count_non_finite(result.image);
    return result;
}

}  // namespace interflect
