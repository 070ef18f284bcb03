#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "interflect/colour.h"
#include "interflect/geometry/patch_geometry.h"
#include "interflect/luminaires/skies.h"
#include "interflect/path_tracer.h"
#include "interflect/ray_caster.h"
#include "interflect/raycast/camera.h"
#include "interflect/raycast/panes.h"
#include "interflect/render/gauge.h"
#include "interflect/render/known_light.h"
#include "interflect/render/light_tree.h"
#include "interflect/render/luminaire_choice.h"
#include "interflect/render/path_samples.h"
#include "interflect/scene.h"

namespace interflect::inline detail {

/// Where paths start, one pixel each: on the squares of a picture, or at gauges.
struct PathStart {
    std::optional<Camera> camera;
    float pixel_angle = 0;            // that a pixel's side fills in the middle of the picture [rad]; 0 if orthographic
    std::span<const Gauge> gauges{};  // without a camera
    float pixel_size = 0;             // of an orthographic picture [m]
};

/// What all paths of a picture share.
struct PathScene {
    const Scene& scene;
    const RayCaster& ray_caster;
    const PathStart& start;
    std::span<const PatchGeometry> geometry;  // of each patch
    const LightTree& lights;                  // patches
    const LuminaireChoice& luminaires;
    const Skies& skies;
    const PathOptions& options;
    std::size_t batch_size;
    Panes panes;
    bool splits;                        // at panes, or at mirrors
    const KnownLight* known = nullptr;  // that paths end at; null: they go on until roulette ends them

    const Material& material(std::uint32_t patch) const { return scene.materials[scene.patches[patch].material]; }
};

/// What a camera ray hits first; all 0 where it escapes.
struct FirstHit {
    RgbD albedo{0, 0, 0};  // its reflectance
    Imath::V3d normal{0, 0, 0}, position{0, 0, 0};
    double distance = 0;  // from the eye [m]
    double level = 0;     // of the element, where a solution is known

    FirstHit& operator+=(const FirstHit& o) {
        albedo += o.albedo, normal += o.normal, position += o.position, distance += o.distance, level += o.level;
        return *this;
    }
};

/// One batch of a pixel, and its outcome: sums over the batch's paths.
struct BatchOfPaths {
    std::uint32_t pixel = 0, batch = 0;
    bool done = false;
    RgbD emitted{0, 0, 0};   // seen directly
    RgbD direct{0, 0, 0};    // reflected once, from where it was emitted to the camera
    RgbD indirect{0, 0, 0};  // reflected more often
    FirstHit first{};
};

/// Counts of rays, summed over batches.
struct RayCounts {
    std::int64_t rays = 0, shadow_rays = 0, escaped_rays = 0;
    RayCounts& operator+=(const RayCounts& o) {
        rays += o.rays;
        shadow_rays += o.shadow_rays;
        escaped_rays += o.escaped_rays;
        return *this;
    }
};

/// Traces the paths of some batches together, breadth first: all of them by a bounce, then all by the next.
class PathWavefront {
  public:
    explicit PathWavefront(const PathScene& scene) : s_(scene) {}

    /// Adds to each batch the light of its paths.
    void trace(std::span<BatchOfPaths> batches);
    const RayCounts& counts() const { return counts_; }

  private:
    struct Path {
        Rgb throughput;
        std::uint32_t index;   // in light_
        V3f normal;            // of the surface that its ray leaves
        float travelled = 0;   // from there to where its ray starts, behind panes [m]
        bool is_first = true;  // nothing that reflects diffusely lies before it in the picture
    };
    struct PathLight {
        Rgb emitted{0, 0, 0}, direct{0, 0, 0}, indirect{0, 0, 0};
        FirstHit first{};
    };
    /// The contribution of a shadow ray if it hits the patch that it is sent to, or nothing nearer than a luminaire.
    struct Connection {
        std::uint32_t patch, index;
        Rgb radiance;
        float distance;         // to the luminaire, from where the shadow ray starts [m]
        std::uint32_t bounces;  // of the light that it brings
    };

    void start_at_camera(std::span<const BatchOfPaths> batches);
    /// Their light is gathered as a white surface would, so that paths begin by leaving it.
    void start_at_gauges(std::span<const BatchOfPaths> batches);
    /// Traces the rays of all paths and keeps those that go on.
    void advance_paths();
    /// Where a path left the last surface.
    static V3f start_of(const Ray& ray, const Path& path);
    /// Adds the paths that go straight on behind panes of glass, and from the camera's point of view in mirrors.
    void split_paths();
    /// A path that splits off another; where its throughput would not count it is not added.
    void add_path(const Ray& ray, const Path& path, const Rgb& share, const Rgb& reflectance);
    Rgb reflectance_of_hit(const Ray& ray, const Hit& hit) const;
    /// What happens where a ray hits; afterwards `ray` and `path` are the reflected ones. @return Whether it goes on.
    bool interact(const Hit& hit, Ray& ray, Path& path);
    /// Joins `ray.origin`, on a surface with `path.normal`, to the light, and chooses the direction in which the path
    /// leaves it. @return Whether it goes on.
    bool leave(Ray& ray, Path& path);
    /// Light of the skies that a ray escapes to.
    void add_sky(const Ray& ray, const Path& path);
    /// Light from the emitting patch that a ray has hit.
    void add_emission(const Hit& hit, const Ray& ray, const Path& path, const Rgb& exitance);
    /// Of each kind of light that is sampled at a vertex. Where paths end after the next one, all else costs little.
    std::uint32_t shadow_rays_at(std::uint32_t vertex) const;
    /// Next event estimation by one of shadow_rays_at() rays.
    /// @param path   Of which the throughput has the reflectance at x.
    /// @param index  Of the ray among those of the batch.
    void connect_to_light(const V3f& x, const Path& path, const LightSample& sample);
    /// The same for luminaires.
    void connect_to_luminaire(const V3f& x, const Path& path, const LightSample& sample);
    /// The same for skies.
    void connect_to_sky(const V3f& x, const Path& path, std::uint32_t index);
    void trace_shadow_rays();
    /// Lets shadow rays that have hit a pane of glass on their way go on behind it.
    void pass_panes();
    /// Ends a path at the solution's light, unless the element that its ray hit is too near.
    /// @return Whether it has ended.
    bool end_at_known_light(const Hit& hit, const Ray& ray, const Path& path);
    /// Density per solid angle with which KnownLight::sample() takes the direction from x to a place.
    float density_towards(const KnownLight::Place& place, const V3f& x, const V3f& n, const V3f& direction,
                          float distance2) const;
    /// A shadow ray to what is bright in the solution.
    void connect_to_known_light(const V3f& x, const Path& path);
    /// @param bounces  Of the light, until it reaches the camera.
    void add(std::uint32_t index, std::uint32_t bounces, const Rgb& radiance);

    const PathScene& s_;
    std::uint32_t vertex_ = 1;         // which vertex of the paths comes next; the camera is vertex 0
    std::vector<std::uint64_t> keys_;  // of each batch
    std::vector<PathLight> light_;     // of each path, those that have ended too
    std::vector<Path> paths_;          // those that go on, as are rays_
    std::vector<Ray> rays_, shadow_rays_;
    std::vector<Hit> hits_;
    std::vector<Connection> connections_;
    RayCounts counts_;
};

}  // namespace interflect::inline detail
