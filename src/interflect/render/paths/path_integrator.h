#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interflect/render/direct/direct_light.h"
#include "interflect/render/paths/record_lookups.h"
#include "interflect/render/rays/nearby_light.h"
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
/// unless the plan ends paths at known light (the elements of a solution, whose errors bias it) or looks up records
/// (RecordLookups). The estimate omits:
/// - light that mirrors reflect, if the camera does not see the mirror,
/// - light behind more than 32 panes and mirrors,
/// - paths that panes and mirrors reduce to a throughput below 0.001 (find_surfaces()).
class PathIntegrator {
  public:
    /// @param plan  Must outlive this.
    explicit PathIntegrator(const PathPlan& plan)
        : plan_(plan), record_lookups_(plan), direct_light_(plan.scene.unoccluded_light) {}

    /// Traces the paths of all batches and stores their light there. Later calls reuse the memory.
    /// @param nearby  Predicts the light of first hits, with the elements of the solution; null: these alone do.
    void trace(std::span<SampleBatch> batches, const NearbyLight* nearby = nullptr);
    /// Returns the counts of the last call of trace().
    const RayCounts& counts() const { return counts_; }

  private:
    /// Light that a shadow ray contributes if it is unoccluded.
    struct Connection {
        std::uint32_t half_batch;
        std::uint32_t bounces;            // number of reflections between emitter and camera
        Rgb light{0, 0, 0};               // radiance at the camera or, for DirectLight, irradiance
        std::uint32_t direct_ray = none;  // ray of DirectLight that receives the light; none: the path
    };
    /// Shadow ray from a vertex to the sources of a kind.
    struct SourceRay {
        SourceKind kind;
        std::uint32_t number;  // number of the ray, from 0 to count - 1
        std::uint32_t count;   // number of rays from the vertex to this kind
    };
    /// Next surface of a path.
    struct SurfaceHit {
        PatchIndex patch;
        V3f x;           // position
        V3f direction;   // unit direction of the ray
        float distance;  // length from the path's last vertex, through panes and by mirrors [m]
        Rgb exitance, reflectance;
    };

    // Start of the paths:
    void make_keys(std::span<const SampleBatch> batches);
    void start_at_camera(std::span<const SampleBatch> batches);
    /// Starts paths on the gauges, which are white surfaces.
    void start_at_gauges(std::span<const SampleBatch> batches);

    // Next surface of each path:
    /// Finds the next surfaces, adds the light that they emit, and removes the paths that end.
    void find_next_vertices();
    /// Adds the light that the path finds along its ray. Returns whether the path continues from the surface.
    bool move_to_hit(const Hit& hit, const Ray& ray, Path& path);
    SurfaceHit surface_hit(const Hit& hit, const Ray& ray, const Path& path) const;
    void record_first_hit(const SurfaceHit& hit, const Path& path);
    /// Whether the next surfaces count as white and without emission: first surfaces in pictures of irradiance.
    bool next_surfaces_are_white() const { return vertex_ == 1 && plan_.shows_irradiance(); }
    void add_sky(const Path& path, const V3f& direction);
    void add_emission(const SurfaceHit& hit, const Path& path);
    /// Predicts the reflected radiance of a first hit.
    Rgb predicted_radiance(const SurfaceHit& hit, const Path& path);
    /// Adds the light of a first hit that is known without further rays.
    /// @param emitted    Radiance of the sky or surface.
    /// @param predicted  Predicted reflected radiance of the surface.
    void add_prediction(const Path& path, const Rgb& emitted, const Rgb& predicted);
    /// Adds the known light of the hit if the path ends there. Returns whether it does.
    bool end_at_known_light(const SurfaceHit& hit, const Path& path);
    /// Returns the share of the light from the hit to the path's last vertex that virtual lights do not represent.
    float share_beyond_virtual_lights(const SurfaceHit& hit, const Path& path) const;

    // Shadow rays from a vertex:
    void illuminate_vertices();
    /// Illuminates a first point of hybrid shading by recorded indirect light and by shadow rays. Does nothing and
    /// returns false if no record is in reach.
    bool light_first_point(Path& path);
    /// Returns the sampling at a first point with recorded indirect light. @param guide  Guide of the record, or none.
    SourceSampling sampling_with_record(std::uint32_t guide) const;
    /// Sends shadow rays to the light sources and the sky.
    /// @param is_first_point  Whether the path's vertex is the last point of DirectLight.
    void connect_to_sources(const Path& path, bool is_first_point);
    /// @param uses_direct_light  Whether DirectLight receives the light.
    void connect_to_source(const Path& path, const SourceRay& ray, bool uses_direct_light);
    /// @param index  Index of the shadow ray in the sequence of all rays from this vertex to the sky.
    void connect_to_sky(const Path& path, std::uint32_t index);
    V3f sample_sky_direction(const Path& path, std::uint32_t index) const;
    void connect_to_known_light(const Path& path);
    void connect_to_virtual_lights(const Path& path);
    void add_light_of_shadow_rays();

    // Densities of samples, and the radiance of skies:
    /// Returns the density of the direction that continues the path, times the expected number of such directions per
    /// path [1/sr].
    static float direction_density(const Path& path, const V3f& direction);
    /// Returns the sum of the densities of a path's shadow rays to the sky [1/sr].
    float sky_density(const Path& path, const V3f& direction) const;
    /// Returns the radiance of the skies that shadow rays sample: all skies with a guide, else only non-uniform skies.
    Rgb sampled_sky(const Path& path, const V3f& direction) const;

    // End of a bounce:
    /// Samples the direction in which each path continues. Russian roulette ends some paths.
    void choose_directions();

    // Results:
    /// Adds radiance at the camera. @param bounces  Number of reflections between emitter and camera.
    void add(std::uint32_t half_batch, std::uint32_t bounces, const Rgb& radiance);
    void store(std::span<SampleBatch> batches) const;

    const PathPlan& plan_;
    std::uint32_t vertex_ = 1;  // number of the current vertex: 0 for the camera, 1 for first surfaces and gauges
    const NearbyLight* nearby_ = nullptr;
    NearbyLightLookups nearby_lookups_;
    std::vector<std::uint32_t> pixels_;  // pixel of each batch
    std::vector<std::uint64_t> keys_;    // random key of each half batch
    std::vector<PathLight> light_;       // light of each half batch
    std::vector<FirstHit> first_hits_;   // first hit of each sample
    PathRays paths_;
    ShadowRays shadow_rays_;
    std::vector<Connection> connections_;  // one for each shadow ray
    RecordLookups record_lookups_;
    DirectLight direct_light_;
    RayCounts counts_;
};

}  // namespace interflect::detail
