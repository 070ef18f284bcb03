#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "interflect/colour.h"
#include "interflect/geometry/patch_geometry.h"
#include "interflect/path_tracer.h"
#include "interflect/ray_caster.h"
#include "interflect/raycast/camera.h"
#include "interflect/render/light_tree.h"
#include "interflect/render/path_samples.h"
#include "interflect/scene.h"

namespace interflect {

/// What all paths of a picture share.
struct PathScene {
    const Scene& scene;
    const RayCaster& ray_caster;
    Camera camera;
    std::vector<PatchGeometry> geometry;  // of each patch
    LightTree lights;
    Rgb sky;  // its radiance
    EmitterSampling sampling;
    std::uint64_t seed;
    int width;
    std::size_t batch_size;

    const Material& material(std::uint32_t patch) const { return scene.materials[scene.patches[patch].material]; }
};

/// One batch of a pixel, and its outcome: sums over the batch's paths.
struct BatchOfPaths {
    std::uint32_t pixel = 0, batch = 0;
    bool done = false;
    RgbD emitted{0, 0, 0};  // seen directly
    RgbD reflected{0, 0, 0};
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
        std::uint32_t index;  // in light_
        V3f normal;           // of the surface that its ray leaves
    };
    struct PathLight {
        Rgb emitted{0, 0, 0}, reflected{0, 0, 0};
    };
    /// The contribution of a shadow ray if it hits the patch that it is sent to, or nothing nearer than a luminaire.
    struct Connection {
        std::uint32_t patch, index;
        Rgb radiance;
        float distance;  // to the luminaire [m]
    };

    void start_paths(std::span<const BatchOfPaths> batches);
    /// Traces the rays of all paths and keeps those that go on.
    void advance_paths();
    /// What happens where a ray hits; afterwards `ray` and `path` are the reflected ones. @return Whether it goes on.
    bool interact(const Hit& hit, Ray& ray, Path& path);
    /// Light from the emitting patch that a ray has hit.
    void add_emission(const Hit& hit, const Ray& ray, const Path& path, const Rgb& exitance);
    /// Next event estimation. @param path  Of which the throughput has the reflectance at x.
    void connect_to_light(const V3f& x, const Path& path, const VertexSample& sample);
    /// The same for luminaires: one of them, chosen by what it would bring if nothing were in its way.
    void connect_to_luminaire(const V3f& x, const Path& path, const VertexSample& sample);
    void trace_shadow_rays();

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

}  // namespace interflect
