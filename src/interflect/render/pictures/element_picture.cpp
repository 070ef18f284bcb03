#include "interflect/render/pictures/element_picture.h"

#include <atomic>
#include <numbers>
#include <optional>
#include <vector>

#include "interflect/elements/forest.h"
#include "interflect/geometry/textures/texture_mapping.h"
#include "interflect/luminaires/skies/skies.h"
#include "interflect/raycast/panes.h"
#include "interflect/render/pictures/camera_samples.h"
#include "interflect/render/smooth/element_vertices.h"
#include "interflect/render/smooth/smooth_field.h"

namespace interflect::detail {

namespace {

class Shader {
  public:
    Shader(const Scene& scene, const ElementForest& forest, std::span<const Rgb> irradiance,
           const PictureOptions& options)
        : scene_(scene),
          forest_(forest),
          irradiance_(irradiance),
          shows_irradiance_(options.quantity == PictureQuantity::irradiance) {
        if (options.shading == Shading::flat) return;
        vertices_.emplace(scene, forest, options.smoothing);
        smooth_.emplace(forest, *vertices_, irradiance);
    }
    Shader(const Shader&) = delete;  // smooth_ refers to vertices_
    Shader& operator=(const Shader&) = delete;

    /// Returns H, or L = (M + rho H) / pi.
    Rgb value_at(const Ray& ray, const Hit& hit) const {
        if (shows_irradiance_) return irradiance_at(ray, hit);
        const Patch& patch = scene_.patches[hit.patch];
        const Material& material = scene_.materials[patch.material];
        Rgb exitance = material.exitance, reflectance = material.reflectance;
        if (material.is_textured()) {
            const Parameters p = parameters_of_hit(forest_, ray, hit);
            exitance = exitance_at(scene_, patch, p);
            reflectance = reflectance_at(scene_, patch, p);
        }
        const Rgb radiosity = exitance + reflectance * irradiance_at(ray, hit);
        return radiosity / std::numbers::pi_v<float>;
    }

  private:
    Rgb irradiance_at(const Ray& ray, const Hit& hit) const {
        return smooth_ ? smooth_->at(hit.patch, parameters_of_hit(forest_, ray, hit))
                       : irradiance_[leaf_of_hit(forest_, ray, hit)];
    }

    const Scene& scene_;
    const ElementForest& forest_;
    std::span<const Rgb> irradiance_;
    bool shows_irradiance_;
    std::optional<ElementVertices> vertices_;
    std::optional<SmoothField> smooth_;
};

}  // namespace

Rendering draw_elements(const Scene& scene, const ElementForest& forest, const RayCaster& ray_caster, const View& view,
                        std::span<const Rgb> irradiance, const PictureOptions& options, const Monitor& monitor) {
    ray_caster.require_made_for(scene);
    forest.require_made_for(scene);
    require_values_of_elements(forest, irradiance.size(), "irradiance");
    const Camera camera(view, options.width, options.height, scene.origin);
    const Skies skies(scene);
    const Shader shader(scene, forest, irradiance, options);

    Rendering result;
    result.image = Image(options.width, options.height);
    std::atomic<std::int64_t> escaped_rays{0};
    const CameraSampling sampling{options.width, options.height, options.samples, options.seed};
    const Panes panes(scene, ray_caster);
    const bool shows_irradiance = options.quantity == PictureQuantity::irradiance;
    trace_pixels(camera, ray_caster, sampling, monitor, [&](const PixelSamples& samples) {
        RgbD sum(0, 0, 0);
        std::int64_t escaped = 0;
        const auto value = [&](const Ray& ray, const Hit& hit) {
            escaped += hit.patch == none ? 1 : 0;
            if (hit.patch != none) return RgbD(shader.value_at(ray, hit));
            return shows_irradiance ? RgbD(0) : RgbD(skies.radiance_with_suns(ray.direction));
        };
        for (std::size_t i = 0; i < samples.rays.size(); ++i) sum += value(samples.rays[i], samples.hits[i]);
        thread_local std::vector<Panes::HitBehind> behind;
        behind.clear();
        if (!shows_irradiance)
            panes.trace(samples.rays, samples.hits, behind);  // a picture of irradiance shows that of panes
        for (const auto& [ray, transmittance, hit] : behind) sum += value(samples.rays[ray], hit) * RgbD(transmittance);
        result.image.pixels[samples.pixel] = Rgb(sum / static_cast<double>(samples.rays.size()));
        if (escaped > 0) escaped_rays += escaped;
    });

    result.rays = static_cast<std::int64_t>(result.image.pixels.size()) * options.samples;
    result.escaped_rays = escaped_rays;
    result.non_finite_pixels = count_non_finite(result.image);
    result.interrupted = monitor.stop && *monitor.stop;
    return result;
}

}  // namespace interflect::detail
