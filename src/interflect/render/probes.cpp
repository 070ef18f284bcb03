#include "interflect/measure.h"

#include <ImathBox.h>
#include <ImathMatrix.h>
#include <ImathQuat.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "interflect/base/common_stop.h"
#include "interflect/base/random.h"
#include "interflect/base/shared_ranges.h"
#include "interflect/core.h"
#include "interflect/elements/forest.h"
#include "interflect/geometry/texture_mapping.h"
#include "interflect/luminaires/illumination.h"
#include "interflect/luminaires/skies.h"
#include "interflect/raycast/panes.h"
#include "interflect/render/sharing/light_order.h"
#include "interflect/render/smooth/element_vertices.h"
#include "interflect/render/smooth/smooth_field.h"
#include "interflect/render/sphere_quadrature.h"

namespace interflect {

using namespace detail;

namespace {

constexpr float pi = std::numbers::pi_v<float>;
constexpr std::size_t rays_per_report = std::size_t{1} << 20;
/// Cosine convolution per harmonic (Ramamoorthi and Hanrahan 2001, Eq. 8).
constexpr std::array<float, 9> cosine_factors{pi,     2 * pi / 3, 2 * pi / 3, 2 * pi / 3, pi / 4,
                                              pi / 4, pi / 4,     pi / 4,     pi / 4};

/// Relative to the scene's origin [m].
Imath::Box3d bounds_of(const Scene& scene) {
    Imath::Box3d bounds;
    for (const Patch& patch : scene.patches)
        for (int k = 0; k < patch.vertex_count(); ++k) bounds.extendBy(Imath::V3d(scene.vertices[patch.vertices[k]]));
    return bounds;
}

/// @param irradiance  On a surface that faces `towards`.
void add(IrradianceProbe& probe, const V3f& towards, const Rgb& irradiance) {
    const std::array<float, 9> basis = spherical_harmonics(towards);
    for (std::size_t k = 0; k < 9; ++k) probe.coefficients[k] += irradiance * (cosine_factors[k] * basis[k]);
}

/// Uniform (Shoemake 1992).
Imath::M33f random_rotation(std::uint64_t seed, std::uint64_t index) {
    const auto words = random_words(seed, index);
    const float a = unit_float(words[0]), b = 2 * pi * unit_float(words[1]), c = 2 * pi * unit_float(words[2]);
    const Imath::Quatf rotation(std::sqrt(1 - a) * std::sin(b), std::sqrt(1 - a) * std::cos(b),
                                std::sqrt(a) * std::sin(c), std::sqrt(a) * std::cos(c));
    return rotation.toMatrix33();
}

class LightAround {
  public:
    LightAround(const Scene& scene, const Solution& solution, const RayCaster& ray_caster, const ProbeOptions& options)
        : scene_(scene),
          forest_(*solution.forest),
          ray_caster_(ray_caster),
          vertices_(scene, forest_),
          irradiance_(forest_, vertices_, solution.irradiance),
          panes_(scene, ray_caster),
          skies_(scene),
          nodes_(sphere_quadrature(static_cast<int>(std::ceil(std::sqrt(options.rays / 2.0))))),
          seed_(options.seed),
          far_(static_cast<float>(bounds_of(scene).size().length())) {}

    std::size_t rays() const { return nodes_.size(); }

    IrradianceProbe probe(const V3f& x, std::uint64_t index) const {
        const Imath::M33f rotation = random_rotation(seed_, index);
        std::vector<Ray> rays(nodes_.size());
        std::vector<Hit> hits(nodes_.size());
        for (std::size_t i = 0; i < rays.size(); ++i) rays[i] = {x, (nodes_[i].direction * rotation).normalized()};
        ray_caster_.trace(rays, hits);
        IrradianceProbe probe;
        gather(rays, hits, probe);
        for (const Luminaire& luminaire : scene_.luminaires) add_luminaire(luminaire, x, probe);
        constexpr float max_backs = 0.25f;
        probe.is_inside = probe.coefficients[0] == Rgb(0) || share_of_backs(rays, hits) > max_backs;
        return probe;
    }

  private:
    void gather(const std::vector<Ray>& rays, const std::vector<Hit>& hits, IrradianceProbe& probe) const {
        for (std::size_t i = 0; i < rays.size(); ++i)
            add(probe, rays[i].direction, nodes_[i].weight * radiance(rays[i], hits[i]));
        if (panes_.empty()) return;
        std::vector<Panes::HitBehind> behind;
        panes_.trace(rays, hits, behind);
        for (const Panes::HitBehind& b : behind)
            add(probe, rays[b.ray].direction, nodes_[b.ray].weight * b.transmittance * radiance(rays[b.ray], b.hit));
    }

    Rgb radiance(const Ray& ray, const Hit& hit) const {
        if (hit.patch == none) return skies_.radiance(ray.direction);
        const Patch& patch = scene_.patches[hit.patch];
        const V3f x = ray.origin + hit.distance * ray.direction;
        const Parameters at = forest_.geometry(hit.patch).parameters_of(x);
        const Rgb reflected = reflectance_at(scene_, patch, at) * irradiance_.at(hit.patch, at);
        return (exitance_at(scene_, patch, at) + reflected) / pi;
    }

    void add_luminaire(const Luminaire& luminaire, const V3f& x, IrradianceProbe& probe) const {
        constexpr int across = 4;  // points per axis
        for (int i = 0; i < across * across; ++i) {
            const int row = i / across, column = i % across;
            const float u = (static_cast<float>(column) + 0.5f) / across, v = (static_cast<float>(row) + 0.5f) / across;
            const Illumination light = illumination(luminaire, x, u, v);
            if (light.irradiance == Rgb(0)) continue;
            const Rgb share = light.irradiance / static_cast<float>(across * across);
            add(probe, light.towards, share * transmittance({x, light.towards}, light.distance));
        }
    }

    Rgb transmittance(Ray ray, float distance) const {
        Rgb through(1);
        for (int panes = 0; panes < Panes::max_consecutive_panes; ++panes) {
            Hit hit;
            ray_caster_.trace({&ray, 1}, {&hit, 1});
            if (hit.patch == none || hit.distance >= distance) return through;
            through *= panes_.transmittance(ray, hit);
            if (!(largest_channel(through) > 0)) break;
            distance -= hit.distance;
            ray = panes_.behind(ray, hit);
        }
        return Rgb(0);
    }

    /// Share of rays that cross a one-sided face from behind.
    float share_of_backs(const std::vector<Ray>& rays, const std::vector<Hit>& hits) const {
        std::vector<Ray> back;
        std::vector<float> lengths;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const bool escapes = hits[i].patch == none;
            const float length = escapes ? far_ : hits[i].distance - 2 * ray_caster_.ray_offset(hits[i].patch);
            back.push_back({rays[i].origin + length * rays[i].direction, -rays[i].direction});
            lengths.push_back(length);
        }
        std::vector<Hit> met(back.size());
        ray_caster_.trace(back, met);
        int backs = 0;
        for (std::size_t i = 0; i < met.size(); ++i) backs += met[i].patch != none && met[i].distance < lengths[i];
        return static_cast<float>(backs) / static_cast<float>(rays.size());
    }

    const Scene& scene_;
    const ElementForest& forest_;
    const RayCaster& ray_caster_;
    const ElementVertices vertices_;
    const SmoothField irradiance_;
    const Panes panes_;
    const Skies skies_;
    const std::vector<SphereNode> nodes_;
    const std::uint64_t seed_;
    const float far_;  // [m]
};

ProbeGrid empty_grid(const Scene& scene, const ProbeOptions& options) {
    if (!(options.spacing > 0 && std::isfinite(options.spacing)))
        throw InputError(fmt::format("probes: spacing is {}, expected a number above 0", options.spacing));
    if (options.rays < 8 || options.rays > 1 << 20)
        throw InputError(fmt::format("probes: rays is {}, expected 8 to 1048576", options.rays));
    const Imath::Box3d bounds = bounds_of(scene);
    ProbeGrid grid;
    double probes = 1;
    std::array<double, 3> count;
    for (int k = 0; k < 3; ++k) {
        const double extent = bounds.size()[k];
        count[k] = std::max(1.0, std::ceil(extent / options.spacing * (1 - 1e-6)));
        probes *= count[k];
        grid.step[k] = extent / count[k];
        grid.first[k] = scene.origin[k] + bounds.min[k] + grid.step[k] / 2;
    }
    if (probes > max_probes)
        throw InputError(fmt::format("probes: a spacing of {} m makes {:.3g} probes, more than {}", options.spacing,
                                     probes, max_probes));
    for (int k = 0; k < 3; ++k) grid.count[k] = static_cast<int>(count[k]);
    grid.probes.resize(static_cast<std::size_t>(probes));
    return grid;
}

}  // namespace

std::array<float, 9> spherical_harmonics(const V3f& direction) {
    const auto [x, y, z] = std::array{direction.x, direction.y, direction.z};
    return {0.2820947918f,
            0.4886025119f * y,
            0.4886025119f * z,
            0.4886025119f * x,
            1.0925484306f * x * y,
            1.0925484306f * y * z,
            0.3153915653f * (3 * z * z - 1),
            1.0925484306f * x * z,
            0.5462742153f * (x * x - y * y)};
}

Rgb IrradianceProbe::irradiance(const V3f& normal) const {
    const std::array<float, 9> basis = spherical_harmonics(normal);
    Rgb sum(0);
    for (std::size_t k = 0; k < 9; ++k) sum += coefficients[k] * basis[k];
    return sum;
}

ProbeGrid irradiance_probes(const Scene& scene, const Solution& solution, const RayCaster& ray_caster,
                            const ProbeOptions& options, const Monitor& monitor) {
    solution.forest->require_made_for(scene);
    ray_caster.require_made_for(scene);
    ProbeGrid grid = empty_grid(scene, options);
    give_order(monitor.ranks, {.kind = LightOrder::Kind::probes, .probes = options});
    const LightAround light(scene, solution, ray_caster, options);
    const auto columns = static_cast<std::size_t>(grid.count[0]), rows = static_cast<std::size_t>(grid.count[1]);
    const CommonStop stop(monitor.stop, monitor.ranks);
    const auto measure = [&](std::size_t i) {
        if (stop.within_process().is_due()) return;
        const std::size_t column = i % columns, row = i / columns % rows, level = i / columns / rows;
        const Imath::V3d number(static_cast<double>(column), static_cast<double>(row), static_cast<double>(level));
        grid.probes[i] = light.probe(V3f(grid.first - scene.origin + number * grid.step), i);
    };
    const std::size_t ranks = monitor.ranks ? static_cast<std::size_t>(monitor.ranks->count()) : 1;
    const std::size_t per_report = std::max<std::size_t>(1, ranks * rays_per_report / light.rays());
    for (std::size_t begin = 0; begin < grid.probes.size(); begin += per_report) {
        const std::size_t end = std::min(grid.probes.size(), begin + per_report);
        parallel_for_own_ranges(monitor.ranks, end - begin, 1, [&](std::size_t i, std::size_t) { measure(begin + i); });
        if (stop.is_due())
            throw Stopped(fmt::format("stopped at {} of {} probes, before all had light", begin, grid.probes.size()));
        collect_ranges(monitor.ranks, std::span(grid.probes).subspan(begin, end - begin), 1, Destination::first_rank);
        if (monitor.on_progress)
            monitor.on_progress({static_cast<std::int64_t>(2 * end * light.rays()),
                                 static_cast<double>(end) / static_cast<double>(grid.probes.size()),
                                 std::numeric_limits<double>::quiet_NaN()});
    }
    return grid;
}

}  // namespace interflect
