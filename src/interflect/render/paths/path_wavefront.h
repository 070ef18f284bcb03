#pragma once

#include <array>
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
#include "interflect/render/lights/known_light.h"
#include "interflect/render/lights/light_tree.h"
#include "interflect/render/lights/luminaire_choice.h"
#include "interflect/render/lights/path_samples.h"
#include "interflect/render/lights/unoccluded_light.h"
#include "interflect/render/lights/virtual_lights.h"
#include "interflect/render/paths/gauge.h"
#include "interflect/render/paths/indirect_field.h"
#include "interflect/render/paths/sky_guide.h"
#include "interflect/render/smooth/smooth_normals.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// In hybrid shading, one path of each group of this size also samples lights by its direction, best near emitters.
constexpr std::uint32_t paths_per_direction = 4;

/// Camera, or one gauge per pixel.
struct PathStart {
    std::optional<Camera> camera;
    float pixel_angle = 0;  // [rad]
    std::span<const Gauge> gauges{};
    float pixel_size = 0;  // [m]
};

struct PathScene {
    const Scene& scene;
    const RayCaster& ray_caster;
    const PathStart* start;
    std::span<const PatchGeometry> geometry;
    const LightTree& lights;
    const LuminaireChoice& luminaires;
    const Skies& skies;
    const PictureOptions& options;
    std::size_t batch_size;
    Panes panes;
    bool splits;                                    // at panes or mirrors
    const UnoccludedLight& unoccluded;              // at the first vertex, with an indirect field
    const KnownLight* known = nullptr;              // ends paths; null: only Russian roulette does
    const SmoothNormals* smooth_normals = nullptr;  // of visible surfaces; null: flat patches
    const IndirectField* indirect_field = nullptr;  // replaces reflected paths at the first vertex
    const SkyGuide* sky_guide = nullptr;            // of its records; samples the sky at the first vertex
    const VirtualLights* virtual_lights = nullptr;  // light every vertex; paths only find the light beyond their bounds
    bool is_indirect_only = false;                  // omits light that is reflected once
    bool is_direct_only = false;                    // at the first vertex, of hybrid shading
    bool finds_points = false;                      // paths end at the first vertex

    bool is_hybrid() const { return indirect_field || is_direct_only; }
    /// Whether some direct light is not exact.
    bool directions_find_light() const {
        return !unoccluded.has_patches() || skies.can_sample() || channel_sum(skies.uniform_radiance()) > 0;
    }
    /// Projects x onto its patch, against rounding, and lifts it off.
    V3f lifted(std::uint32_t patch, const V3f& x) const {
        const PatchGeometry& g = geometry[patch];
        return g.point(g.parameters_of(x)) + g.normal() * ray_caster.ray_offset(patch);
    }
    const Material& material(std::uint32_t patch) const { return scene.materials[scene.patches[patch].material]; }
};

/// First hit of a camera ray, or a sum; 0 if the ray escapes.
struct FirstHit {
    RgbD albedo{0, 0, 0};
    Imath::V3d normal{0, 0, 0}, position{0, 0, 0};
    double distance = 0;        // from the camera, through panes and by mirrors [m]
    double level = 0;           // of the element, with a known solution
    double inverse_length = 0;  // 1 / length of the first ray from a gauge [1/m]

    FirstHit& operator+=(const FirstHit& o) {
        albedo += o.albedo, normal += o.normal, position += o.position, distance += o.distance, level += o.level;
        inverse_length += o.inverse_length;
        return *this;
    }
};

/// Sums over one batch of a pixel's paths.
struct BatchOfPaths {
    std::uint32_t pixel = 0, batch = 0;  // key of the points
    std::uint32_t first_point = 0;
    bool done = false;
    RgbD emitted{0, 0, 0};
    RgbD direct{0, 0, 0};
    RgbD indirect{0, 0, 0};
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

class PathWavefront {
  public:
    explicit PathWavefront(const PathScene& scene) : s_(scene) {}

    /// Call once.
    void trace(std::span<BatchOfPaths> batches);
    const RayCounts& counts() const { return counts_; }
    /// First vertices, with PathScene::finds_points.
    const std::vector<SurfacePoint>& points() const { return points_; }

  private:
    struct Path {
        Rgb throughput;
        std::uint32_t index;         // in light_
        V3f normal;                  // of the surface that the ray left
        std::uint32_t patch = none;  // that surface
        float travelled = 0;         // from there or the camera to the ray's origin [m]
        bool sets_first_hit = true;  // seen through clear panes and pure mirrors only
        std::uint32_t place = none;  // in seen_: ends at the next vertex
    };
    struct Sequence {
        std::uint64_t key;
        std::uint32_t first;
    };
    struct PathLight {
        Rgb emitted{0, 0, 0}, direct{0, 0, 0}, indirect{0, 0, 0};
        FirstHit first{};
    };
    /// Irradiance by the sources of a kind: exact without occlusion, and sampled by shadow rays.
    struct ExactLight {
        Rgb exact{0, 0, 0};
        // Contributions of all shadow rays, and of unoccluded ones, each in two halves.
        std::array<Rgb, 2> sampled{Rgb(0), Rgb(0)}, visible{Rgb(0), Rgb(0)};
        std::uint32_t next_half = 0;
        Rgb result() const;
    };
    /// Lit once for all paths of a pixel to the patch.
    struct SeenPlace {
        std::uint32_t batch = none, patch = none, index = 0;  // index: in light_
        V3f normal{0, 0, 0};
        Rgb throughput{0, 0, 0};      // sum over the paths
        std::optional<Rgb> indirect;  // irradiance
        std::uint32_t guide = none;   // record of PathScene::sky_guide that sees the sky
        ExactLight patches, luminaires;
    };
    /// Contribution of a shadow ray that hits `patch` or, for `none`, is free up to `distance`.
    struct Connection {
        std::uint32_t patch, index;
        Rgb radiance;
        float distance;  // [m]
        std::uint32_t bounces;
        std::uint32_t place = none;  // in seen_; then `radiance` only estimates the visible share of exact light
        std::uint32_t half = 0;      // of that estimate
        ExactLight SeenPlace::*kind = nullptr;
    };

    void start_at_camera(std::span<const BatchOfPaths> batches);
    /// Gauges act as white surfaces: paths begin with leave().
    void start_at_gauges(std::span<const BatchOfPaths> batches);
    void advance_paths();
    /// In pictures of irradiance, the first surface is white, opaque and does not emit.
    bool shows_irradiance() const;
    static V3f start_of(const Ray& ray, const Path& path);
    /// Adds paths behind panes and in mirrors.
    void split_paths();
    void add_path(const Ray& ray, const Path& path, const Rgb& share, const Rgb& reflectance);
    Rgb reflectance_of_hit(const Ray& ray, const Hit& hit) const;
    /// Reflects `ray` and `path`; returns whether the path continues.
    bool interact(const Hit& hit, Ray& ray, Path& path);
    /// Connects `ray.origin` to the lights and samples a direction. Returns as interact().
    /// @param middle  Of the pixel's or texel's part of the surface.
    bool leave(Ray& ray, Path& path, const V3f& middle);
    /// Returns the index in seen_, added if new; none without indirect light.
    std::uint32_t seen_place(const V3f& x, const Path& path);
    void add_light_of_seen_places();
    void estimate_visible_share(Connection& connection, const Path& path, ExactLight SeenPlace::*kind);
    void add_sky(const Ray& ray, const Path& path);
    void add_emission(const Hit& hit, const Ray& ray, const Path& path, const Rgb& exitance);
    /// Returns the density of the path's own direction [1/sr], per path.
    float direction_density(const Path& path, const V3f& direction) const;
    /// Returns the MIS weight of the path's own direction. Densities in [1/sr].
    float direction_weight(float direction_density, float light_density) const;
    std::uint32_t shadow_rays_at(std::uint32_t vertex) const;
    const Sequence& sequence(const Path& path) const { return sequences_[path.index / s_.batch_size]; }
    std::uint32_t point_index(const Path& path) const {
        return sequence(path).first + path.index % static_cast<std::uint32_t>(s_.batch_size);
    }
    /// @param path  Its throughput includes the reflectance at x; also below.
    void connect_to_patch(const V3f& x, const Path& path, const LightSample& sample);
    void connect_to_luminaire(const V3f& x, const Path& path, const LightSample& sample);
    /// Returns SeenPlace::guide at the first vertex.
    std::uint32_t guide_of(const Path& path) const;
    /// Returns the radiance of the skies that shadow rays sample; uniform skies need a guide.
    Rgb sky_of_shadow_rays(const Path& path, const V3f& direction) const;
    /// Returns the density of all shadow rays of a path to the sky [1/sr].
    float sky_density(const Path& path, std::uint32_t vertex, const V3f& direction) const;
    /// @param index  Ray in its batch at this vertex.
    void connect_to_sky(const V3f& x, const Path& path, std::uint32_t index);
    void trace_shadow_rays();
    void pass_panes();
    static bool is_unoccluded(const Connection& connection, const Hit& hit);
    /// Returns whether the path ends.
    bool end_at_known_light(const Hit& hit, const Ray& ray, const Path& path);
    /// Paths for each ray to a place of KnownLight::sample().
    std::uint32_t paths_per_place() const;
    /// Returns the density of KnownLight::sample() [1/sr], per path.
    float density_towards(const KnownLight::Place& place, const V3f& x, const V3f& n, const V3f& direction,
                          float distance2) const;
    void connect_to_known_light(const V3f& x, const Path& path);
    void connect_to_virtual_lights(const V3f& x, const Path& path);
    /// Share of the light reflected at the hit towards the path's last vertex that virtual lights do not represent.
    float share_beyond_bound(const Hit& hit, const Ray& ray, const Path& path) const;
    /// @param bounces  Reflections between emitter and camera.
    void add(std::uint32_t index, std::uint32_t bounces, const Rgb& radiance);

    const PathScene& s_;
    // Next vertex; the camera is 0.
    std::uint32_t vertex_ = 1;
    std::vector<Sequence> sequences_;  // of each batch
    std::vector<PathLight> light_;
    std::vector<Path> paths_;  // parallel to rays_
    std::vector<Ray> rays_, shadow_rays_;
    std::vector<Hit> hits_;
    std::vector<Connection> connections_;
    std::vector<SurfacePoint> points_;
    std::vector<SeenPlace> seen_;  // with an indirect field
    RayCounts counts_;
};

}  // namespace interflect::detail
