#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "interflect/core.h"
#include "interflect/geometry/patch_geometry.h"
#include "interflect/luminaires/skies.h"
#include "interflect/ray_caster.h"
#include "interflect/raycast/camera.h"
#include "interflect/raycast/panes.h"
#include "interflect/render.h"
#include "interflect/render/gauge.h"
#include "interflect/render/known_light.h"
#include "interflect/render/light_tree.h"
#include "interflect/render/luminaire_choice.h"
#include "interflect/render/path_samples.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Starts of paths, one per pixel: in the squares of a picture, or at gauges.
struct PathStart {
    std::optional<Camera> camera;
    float pixel_angle = 0;            // of a pixel's side at the centre [rad]; 0 if orthographic
    std::span<const Gauge> gauges{};  // without a camera
    float pixel_size = 0;             // side of a pixel of an orthographic picture [m]
};

struct PathScene {
    const Scene& scene;
    const RayCaster& ray_caster;
    const PathStart& start;
    std::span<const PatchGeometry> geometry;  // per patch
    const LightTree& lights;                  // emitting patches
    const LuminaireChoice& luminaires;
    const Skies& skies;
    const PathOptions& options;
    std::size_t batch_size;
    Panes panes;
    bool splits;                        // paths split at panes or mirrors
    const KnownLight* known = nullptr;  // ends the paths; null: Russian roulette

    const Material& material(std::uint32_t patch) const { return scene.materials[scene.patches[patch].material]; }
};

/// First hit of a camera ray; all 0 if the ray escapes.
struct FirstHit {
    RgbD albedo{0, 0, 0};  // reflectance
    Imath::V3d normal{0, 0, 0}, position{0, 0, 0};
    double distance = 0;  // from the camera [m]
    double level = 0;     // of the element, if a solution is known

    FirstHit& operator+=(const FirstHit& o) {
        albedo += o.albedo, normal += o.normal, position += o.position, distance += o.distance, level += o.level;
        return *this;
    }
};

/// One batch of a pixel and its result: sums over its paths.
struct BatchOfPaths {
    std::uint32_t pixel = 0, batch = 0;
    bool done = false;
    RgbD emitted{0, 0, 0};   // visible directly
    RgbD direct{0, 0, 0};    // reflected once between emitter and camera
    RgbD indirect{0, 0, 0};  // reflected more than once
    FirstHit first{};
};

struct RayCounts {
    std::int64_t rays = 0, shadow_rays = 0, escaped_rays = 0;
    RayCounts& operator+=(const RayCounts& o) {
        rays += o.rays;
        shadow_rays += o.shadow_rays;
        escaped_rays += o.escaped_rays;
        return *this;
    }
};

/// Traces the paths of several batches together, breadth first: one bounce of all paths, then the next bounce.
class PathWavefront {
  public:
    explicit PathWavefront(const PathScene& scene) : s_(scene) {}

    /// Adds the light of the paths to their batches.
    void trace(std::span<BatchOfPaths> batches);
    const RayCounts& counts() const { return counts_; }

  private:
    struct Path {
        Rgb throughput;
        std::uint32_t index;   // in light_
        V3f normal;            // of the surface that its ray leaves
        float travelled = 0;   // distance from that surface to the origin of the ray, behind panes [m]
        bool is_first = true;  // the picture shows no diffuse reflection before it
    };
    struct PathLight {
        Rgb emitted{0, 0, 0}, direct{0, 0, 0}, indirect{0, 0, 0};
        FirstHit first{};
    };
    /// Contribution of a shadow ray that hits `patch` or, without a patch, hits no surface within `distance`.
    struct Connection {
        std::uint32_t patch, index;
        Rgb radiance;
        float distance;         // from the ray's origin to the luminaire [m]
        std::uint32_t bounces;  // number of reflections of its light
    };

    void start_at_camera(std::span<const BatchOfPaths> batches);
    /// Starts paths at gauges, which act as white surfaces: paths begin with leave().
    void start_at_gauges(std::span<const BatchOfPaths> batches);
    /// Traces the rays of all paths and keeps the paths that continue.
    void advance_paths();
    /// Returns the point where a path left the last surface.
    static V3f start_of(const Ray& ray, const Path& path);
    /// Adds the paths behind panes of glass and in mirrors seen by the camera.
    void split_paths();
    /// Splits off a path unless its throughput is negligible.
    void add_path(const Ray& ray, const Path& path, const Rgb& share, const Rgb& reflectance);
    Rgb reflectance_of_hit(const Ray& ray, const Hit& hit) const;
    /// Handles a hit; afterwards `ray` and `path` are the reflected ones. @return Whether the path continues.
    bool interact(const Hit& hit, Ray& ray, Path& path);
    /// Connects `ray.origin`, on a surface with `path.normal`, to the lights, and samples the next direction.
    /// @return Whether the path continues.
    bool leave(Ray& ray, Path& path);
    void add_sky(const Ray& ray, const Path& path);
    void add_emission(const Hit& hit, const Ray& ray, const Path& path, const Rgb& exitance);
    /// Returns the shadow rays per kind of light at a vertex: more if paths end after the next vertex, where all other
    /// work is small.
    std::uint32_t shadow_rays_at(std::uint32_t vertex) const;
    /// Adds a shadow ray to an emitting patch. The throughput of `path` includes the reflectance at x.
    void connect_to_light(const V3f& x, const Path& path, const LightSample& sample);
    void connect_to_luminaire(const V3f& x, const Path& path, const LightSample& sample);
    /// @param index  Index of the ray in its batch at this vertex.
    void connect_to_sky(const V3f& x, const Path& path, std::uint32_t index);
    void trace_shadow_rays();
    void pass_panes();
    /// Ends a path with the light of the solution, unless the element is too near.
    /// @return Whether it has ended.
    bool end_at_known_light(const Hit& hit, const Ray& ray, const Path& path);
    /// Returns the density per solid angle of KnownLight::sample() in the direction from x to a place [1/sr].
    float density_towards(const KnownLight::Place& place, const V3f& x, const V3f& n, const V3f& direction,
                          float distance2) const;
    void connect_to_known_light(const V3f& x, const Path& path);
    /// @param bounces  Number of reflections between emitter and camera.
    void add(std::uint32_t index, std::uint32_t bounces, const Rgb& radiance);

    const PathScene& s_;
    std::uint32_t vertex_ = 1;         // next vertex of the paths; the camera is vertex 0
    std::vector<std::uint64_t> keys_;  // per batch
    std::vector<PathLight> light_;     // per path, including ended ones
    std::vector<Path> paths_;          // paths that continue, parallel to rays_
    std::vector<Ray> rays_, shadow_rays_;
    std::vector<Hit> hits_;
    std::vector<Connection> connections_;
    RayCounts counts_;
};

}  // namespace interflect::detail
