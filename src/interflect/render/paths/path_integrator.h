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

/// Estimates the light along paths from the camera or from gauges. It is the only estimator of pictures, texels,
/// vertices, measuring points and probes (path tracing, Kajiya 1986; final gathering, Reichert 1992; hybrid shading).
///
/// At each vertex, shadow rays sample the light sources, and a cosine-distributed direction continues the path. If both
/// can find a light source, the balance heuristic weights them (Veach and Guibas 1995). The estimate is unbiased,
/// unless the plan ends paths at known light (biased by the error of the solution) or looks up records (FirstPoints).
/// It omits light reflected by mirrors that the camera does not see, light behind more than 32 panes and mirrors, and
/// paths that panes and mirrors weaken to a throughput below 0.001 (find_surfaces()).
class PathIntegrator {
  public:
    /// @param plan  Must outlive this.
    explicit PathIntegrator(const PathPlan& plan) : plan_(plan), first_points_(plan) {}

    /// Adds the light of all paths to their batches. Later calls reuse the memory.
    void trace(std::span<SampleBatch> batches);
    /// Returns the counts of the last call of trace().
    const RayCounts& counts() const { return counts_; }

  private:
    /// Light that a shadow ray contributes if it is unoccluded.
    struct Connection {
        std::uint32_t half_batch;
        std::uint32_t bounces;  // number of reflections between emitter and camera
        Rgb light;              // radiance at the camera or, for first points, irradiance
        std::uint32_t first_point = none;
        SourceKind kind = SourceKind::patches;
    };

    void start_at_camera(std::span<const SampleBatch> batches);
    /// Starts paths on the gauges, which are white surfaces.
    void start_at_gauges(std::span<const SampleBatch> batches);
    void arrive_at_surfaces();
    /// Moves the path to its hit and adds the light emitted there. Returns whether the path continues.
    bool arrive(const Hit& hit, const Ray& ray, Path& path);
    void illuminate_vertices();
    void leave_surfaces();
    void store(std::span<SampleBatch> batches) const;

    // Contributions of a surface or the sky to a path:
    void add_sky(const Path& path, const V3f& direction);
    /// Adds to PathLight::predicted and square_of_first_hit. @param emitted, predicted  Radiance of the first surface
    /// or the sky.
    void add_prediction(const Path& path, const Rgb& emitted, const Rgb& predicted);
    void add_emission(const Hit& hit, const V3f& direction, float distance, const Path& path, const Rgb& exitance);
    /// Adds the known light of the hit if the path ends there. Returns whether it does.
    bool end_at_known_light(const Hit& hit, const V3f& x, const V3f& direction, float distance, const Path& path);
    /// Returns the share of the light from the hit to the path's last vertex that virtual lights do not represent.
    float share_beyond_virtual_lights(const Hit& hit, const V3f& direction, float distance, const Path& path) const;

    // Shadow rays from a vertex:
    void light_first_point(Path& path);
    void sample_sources(Path& path);
    /// Returns the number of shadow rays that the vertices send to sources of a kind.
    std::uint32_t shadow_rays_to(SourceKind kind, std::uint32_t most) const;
    /// @param index        Index of the shadow ray among all shadow rays of the sequence at this vertex.
    /// @param first_point  Point of FirstPoints that receives the light, or none.
    void connect_to_source(const Path& path, SourceKind kind, std::uint32_t index, std::uint32_t rays,
                           std::uint32_t first_point);
    /// Adds a shadow ray to the sky. @param index  As for connect_to_source().
    void connect_to_sky(const Path& path, std::uint32_t index);
    void connect_to_known_light(const Path& path);
    void connect_to_virtual_lights(const Path& path);
    void add_light_of_shadow_rays();

    /// Returns the density of the directions that continue paths, times their expected number per path [1/sr].
    static float direction_density(const Path& path, const V3f& direction);
    /// Returns the radiance of the skies that shadow rays sample. They sample uniform skies only by a guide.
    Rgb sampled_sky(const Path& path, const V3f& direction) const;
    /// Returns the sum of the densities of a path's shadow rays to the sky [1/sr].
    float sky_density(const Path& path, const V3f& direction) const;
    void add(std::uint32_t half_batch, std::uint32_t bounces, const Rgb& radiance);

    const PathPlan& plan_;
    std::uint32_t vertex_ = 1;          // number of the current vertex of all paths; the camera is 0
    std::vector<std::uint64_t> keys_;   // random key of each half batch
    std::vector<PathLight> light_;      // light of each half batch
    std::vector<FirstHit> first_hits_;  // first hit of each sample
    PathRays paths_;
    ShadowRays shadow_rays_;
    std::vector<Connection> connections_;  // one for each shadow ray
    FirstPoints first_points_;
    RayCounts counts_;
};

}  // namespace interflect::detail
