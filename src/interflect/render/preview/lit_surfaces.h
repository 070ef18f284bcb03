#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "interflect/raycast/camera.h"
#include "interflect/render.h"
#include "interflect/render/preview/coarse_light.h"
#include "interflect/render/rays/path_rays.h"
#include "interflect/render/rays/traced_scene.h"
#include "interflect/solution.h"

namespace interflect::detail {

/// Draws surfaces in the light of a coarser picture, and in that of suns, whose shadows are sharp. Immutable,
/// thread-safe.
class LitSurfaces {
  public:
    /// Arguments must outlive this.
    /// @param options  Options of the picture. @param light  Light without that of suns at first points.
    /// @param coarse   Options of the coarser picture. Both pictures have the same view, and their centres coincide
    ///                 horizontally.
    LitSurfaces(const TracedScene& scene, const Solution& solution, const View& view, const PictureOptions& options,
                const CoarseLight& light, const PictureOptions& coarse, std::uint32_t camera_rays);

    /// Draws the pixels from `begin` on, row by row. Returns the counts of rays.
    RayCounts draw(std::size_t begin, std::span<Rgb> pixels) const;

  private:
    using Sums = std::vector<RgbD>;  // light of all camera rays, by pixel

    /// @param raster  Receives the position of each camera ray in the picture [pixels].
    PathRays camera_rays(std::size_t begin, std::size_t count, std::vector<V2f>& raster) const;
    Rgb emitted_light(const Ray& ray, const Hit& hit) const;
    /// Returns the reflectance over pi, or 1 in a picture of irradiance.
    Rgb per_irradiance(const Hit& hit, const V3f& x) const;
    /// Returns the light per reflectance. @param raster  Position in the picture [pixels].
    std::optional<Rgb> light_at(const Hit& hit, const V3f& x, const V2f& raster) const;
    Rgb irradiance_of_element(PatchIndex patch, const V3f& x) const;
    /// @param is_lit  Whether each path has this light already.
    void add_light_of_suns(std::size_t begin, const PathRays& rays, const std::vector<bool>& is_lit, Sums& sums,
                           RayCounts& counts) const;

    const TracedScene& scene_;
    const Solution& solution_;
    const PictureOptions& options_;
    const CoarseLight& light_;
    const Camera camera_;
    const float scale_;                // pixels of the coarser picture per pixel
    const float coarse_axis_;          // column of the middle of the coarser picture [pixels]
    const std::uint32_t camera_rays_;  // number per pixel
    const bool shows_irradiance_, splits_;
};

}  // namespace interflect::detail
