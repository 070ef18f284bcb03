#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interflect/render/paths/first_points.h"
#include "interflect/render/rays/path_plan.h"
#include "interflect/render/rays/path_rays.h"
#include "interflect/render/rays/sample_batch.h"
#include "interflect/render/rays/shadow_rays.h"

namespace interflect::detail {

/// Light along paths from the camera or from gauges: the one estimator of pictures, texels, vertices, measuring points
/// and probes (Kajiya 1986; final gathering, Reichert 1992; hybrid shading).
///
/// At each vertex, shadow rays sample the light sources, and a cosine-distributed direction continues the path. Light
/// sources that both can find are weighted by the balance heuristic (Veach and Guibas 1995). Unbiased unless the plan
/// ends paths at known light (biased by the error of the solution) or looks up records (FirstPoints). Omits light
/// of mirrors that the camera does not see, light behind more than 32 panes and mirrors, and paths that panes and
/// mirrors weaken to a throughput below 0.001 (find_surfaces()).
class PathIntegrator {
  public:
    /// @param plan  Must outlive this.
    explicit PathIntegrator(const PathPlan& plan) : plan_(plan), first_points_(plan) {}

    /// Adds the light of all paths to their batches. Call once.
    void trace(std::span<SampleBatch> batches);
    const RayCounts& counts() const { return counts_; }

  private:
    /// Light that a shadow ray brings if it is free.
    struct Connection {
        std::uint32_t half;
        std::uint32_t bounces;  // reflections between emitter and camera
        Rgb light;              // radiance at the camera or, for first points, irradiance
        std::uint32_t first_point = none;
        SourceKind kind = SourceKind::patches;
    };

    void start_at_camera(std::span<const SampleBatch> batches);
    /// Gauges are white surfaces: paths start on them.
    void start_at_gauges(std::span<const SampleBatch> batches);
    void arrive_at_surfaces();
    bool arrive(const Hit& hit, const Ray& ray, Path& path);
    void light_vertices();
    void leave_surfaces();
    void store(std::span<SampleBatch> batches) const;

    // Contributions of a surface or the sky to a path:
    void add_sky(const Path& path, const V3f& direction);
    void add_emission(const Hit& hit, const V3f& direction, float distance, const Path& path, const Rgb& exitance);
    bool end_at_known_light(const Hit& hit, const V3f& x, const V3f& direction, float distance, const Path& path);
    /// Share of the light reflected at the hit towards the path's last vertex that virtual lights do not represent.
    float share_beyond_bound(const Hit& hit, const V3f& direction, float distance, const Path& path) const;

    // Shadow rays from a vertex:
    void light_first_point(Path& path);
    void sample_sources(Path& path);
    /// @param index        Index of the shadow ray among all shadow rays of the sequence at this vertex.
    /// @param first_point  Point of FirstPoints that receives the light, or none.
    void connect_to_source(const Path& path, SourceKind kind, std::uint32_t index, std::uint32_t rays,
                           std::uint32_t first_point);
    void connect_to_sky(const Path& path, std::uint32_t index);
    void connect_to_known_light(const Path& path);
    void connect_to_virtual_lights(const Path& path);
    void add_light_of_shadow_rays();

    /// Density of the path's own directions [1/sr], per path.
    static float direction_density(const Path& path, const V3f& direction);
    /// Radiance of the skies that shadow rays sample; uniform skies need a guide.
    Rgb sampled_sky(const Path& path, const V3f& direction) const;
    /// Density of all shadow rays of a path to the sky [1/sr].
    float sky_density(const Path& path, const V3f& direction) const;
    void add(std::uint32_t half, std::uint32_t bounces, const Rgb& radiance);

    const PathPlan& plan_;
    std::uint32_t vertex_ = 1;          // surface that paths meet next or have met; the camera is 0
    std::vector<std::uint64_t> keys_;   // of the half batches
    std::vector<PathLight> light_;      // of the half batches
    std::vector<FirstHit> first_hits_;  // of the samples
    PathRays paths_;
    ShadowRays shadow_rays_;
    std::vector<Connection> connections_;  // of the shadow rays
    FirstPoints first_points_;
    RayCounts counts_;
};

}  // namespace interflect::detail
