#pragma once

#include <cstdint>
#include <vector>

#include "interflect/ray_caster.h"
#include "interflect/render/rays/sample_batch.h"
#include "interflect/render/rays/traced_scene.h"

namespace interflect::detail {

/// How light sources were sampled at a path's last vertex. The weight of the next hit depends on it.
struct SourceSampling {
    std::uint32_t rays = 1;      ///< Most shadow rays to each kind of source, and to skies.
    std::uint32_t guide = none;  ///< Record of the SkyGuide that samples the sky.
    float directions = 1;        ///< Sampled directions per path; below 1 for a share of the paths.
    bool is_last = false;        ///< The path only looks for light sources and ends at its next surface.
    bool has_patches = true;     ///< Whether directions sample emitting patches.
};

struct Path {
    Rgb throughput{1, 1, 1};
    std::uint32_t half = 0;    ///< Half batch.
    std::uint32_t sample = 0;  ///< In all half batches.
    std::uint32_t point = 0;   ///< In the sequence of its half.
    // Last vertex:
    V3f position{0, 0, 0};  ///< Lifted off the surface; or the camera [m].
    V3f lookup{0, 0, 0};    ///< Where records are looked up: there, or the middle of the gauge [m].
    V3f normal{0, 0, 0};    ///< For shading.
    PatchIndex patch{};     ///< Patch of the vertex; none for the camera and gauges in space.
    SourceSampling sampling{};
    float travelled = 0;         ///< From there to the ray's origin, through panes and by mirrors [m].
    bool sets_first_hit = true;  ///< Seen through clear panes and pure mirrors only.
};

/// Paths with their rays and, after find_surfaces(), first hits.
struct PathRays {
    std::vector<Path> paths;
    std::vector<Ray> rays;
    std::vector<Hit> hits;

    void add(const Path& path, const Ray& ray) {
        paths.push_back(path);
        rays.push_back(ray);
    }
};

/// Finds the first surface of each path. Adds paths behind panes, and in mirrors for rays from the camera.
/// @param splits  Whether paths are split at panes and mirrors.
void find_surfaces(const TracedScene& scene, bool splits, bool has_mirrors, PathRays& paths, RayCounts& counts);

}  // namespace interflect::detail
