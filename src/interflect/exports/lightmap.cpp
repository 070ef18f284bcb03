#include "interflect/exports/lightmap.h"

#include <ImathBoxAlgo.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "interflect/base/monitor_section.h"
#include "interflect/base/parallel.h"
#include "interflect/core.h"
#include "interflect/elements/forest.h"
#include "interflect/exports/lightmap_atlas.h"
#include "interflect/exports/shown_patches.h"
#include "interflect/geometry/box_tree.h"
#include "interflect/geometry/texture_mapping.h"
#include "interflect/measure.h"
#include "interflect/render/element_vertices.h"
#include "interflect/render/gauge.h"
#include "interflect/render/path_picture.h"
#include "interflect/render/smooth_field.h"
#include "interflect/render/traced_scene.h"
#include "interflect/scene.h"

namespace interflect::detail {

namespace {

struct TexelPlace {
    std::uint32_t patch = none;
    Parameters at;
    std::array<Parameters, 2> sides{};  ///< Extent of the texel along columns and rows.
    bool is_inside = false;
    bool is_near = false;  ///< Less than a texel from the patch: bilinear interpolation may use it.
};

std::array<Parameters, 2> texel_sides(const FlatPatch& flat, const Imath::V2d& spacing) {
    const Imath::V2d u = flat.corners[1] - flat.corners[0],
                     v = flat.corners[static_cast<std::size_t>(flat.count) - 1] - flat.corners[0];
    const double area = u.cross(v);
    const auto parameters = [&](const Imath::V2d& side) {
        return Parameters{static_cast<float>(side.cross(v) / area), static_cast<float>(u.cross(side) / area)};
    };
    return {parameters({spacing.x, 0}), parameters({0, spacing.y})};
}

class NearestPatch {
  public:
    explicit NearestPatch(const LightmapChart& chart) : patches_(chart.patches) {
        for (std::uint32_t i = 0; i < patches_.size(); ++i) {
            geometries_.push_back(geometry_of(patches_[i]));
            sides_.push_back(texel_sides(patches_[i], chart.spacing()));
            const PatchGeometry& geometry = geometries_.back();
            Imath::Box3f box;
            for (const Parameters p : {Parameters{0, 0}, {1, 0}, {0, 1}}) box.extendBy(geometry.point(p));
            if (!geometry.is_triangle()) box.extendBy(geometry.point({1, 1}));
            tree_.push_back({box, i});
        }
        arrange_box_tree(tree_);
    }

    TexelPlace find(const Imath::V2d& at, float texel) const {
        const V3f x(static_cast<float>(at.x), static_cast<float>(at.y), 0);
        TexelPlace nearest;
        float least = std::numeric_limits<float>::max();
        const auto is_near = [&](const Imath::Box3f& box) {
            return (Imath::closestPointInBox(x, box) - x).length2() <= least;
        };
        visit_box_tree(std::span<const Boxed>(tree_), is_near, [&](std::uint32_t i) {
            const Parameters p = nearest_parameters(geometries_[i], x);
            const float distance2 = (geometries_[i].point(p) - x).length2();
            const bool precedes = nearest.patch == none || patches_[i].patch < nearest.patch;
            if (distance2 < least || (distance2 == least && precedes)) {
                least = distance2;
                nearest = {patches_[i].patch, p, sides_[i]};
            }
        });
        constexpr float rounding = 1e-3f;  // [texels]
        nearest.is_inside = least <= rounding * rounding * texel * texel;
        nearest.is_near = least < (1 - rounding) * (1 - rounding) * texel * texel;
        return nearest;
    }

  private:
    static PatchGeometry geometry_of(const FlatPatch& flat);
    static Parameters nearest_parameters(const PatchGeometry& geometry, const V3f& x);

    const FlatPatches& patches_;
    std::vector<PatchGeometry> geometries_;
    std::vector<std::array<Parameters, 2>> sides_;
    std::vector<Boxed> tree_;
};

PatchGeometry NearestPatch::geometry_of(const FlatPatch& flat) {
    Scene plane;
    Patch patch;
    for (std::uint32_t c = 0; c < flat.outline().size(); ++c) {
        plane.vertices.emplace_back(static_cast<float>(flat.corners[c].x), static_cast<float>(flat.corners[c].y), 0.0f);
        patch.vertices[c] = c;
    }
    return {plane, patch};
}

V3f nearest_on_segment(const V3f& a, const V3f& b, const V3f& x) {
    const V3f along = b - a;
    return a + along * std::clamp((x - a).dot(along) / along.length2(), 0.0f, 1.0f);
}

Parameters NearestPatch::nearest_parameters(const PatchGeometry& geometry, const V3f& x) {
    const std::array<Parameters, 4> corners = geometry.is_triangle()
                                                  ? std::array<Parameters, 4>{{{0, 0}, {1, 0}, {0, 1}, {0, 1}}}
                                                  : std::array<Parameters, 4>{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    const std::size_t count = geometry.is_triangle() ? 3 : 4;
    V3f nearest = x;
    float least = std::numeric_limits<float>::max();
    bool is_inside = true;
    for (std::size_t c = 0; c < count; ++c) {
        const V3f a = geometry.point(corners[c]), b = geometry.point(corners[(c + 1) % count]);
        if (geometry.normal().dot((b - a).cross(x - a)) >= 0) continue;
        is_inside = false;
        const V3f candidate = nearest_on_segment(a, b, x);
        if ((candidate - x).length2() >= least) continue;
        least = (candidate - x).length2();
        nearest = candidate;
    }
    return geometry.parameters_of(is_inside ? x : nearest);
}

class IrradianceSource {
  public:
    IrradianceSource(const Scene& scene, const Solution& solution, const ExportOptions& options)
        : scene_(scene),
          solution_(solution),
          options_(options),
          vertices_(scene, *solution.forest),
          smooth_(*solution.forest, vertices_, solution.irradiance) {
        if (options.lightmap->shading != LightmapShading::smooth) ray_caster_.emplace(scene);
    }

    std::vector<Rgb> irradiance(std::span<const TexelPlace> places, float texel) const {
        switch (options_.lightmap->shading) {
            case LightmapShading::hybrid:
                return hybrid(places, texel);
            case LightmapShading::gather:
                return gathered(places, texel);
            default:
                return interpolated(places);
        }
    }

  private:
    std::vector<Rgb> interpolated(std::span<const TexelPlace> places) const {
        std::vector<Rgb> values(places.size());
        constexpr std::size_t texels_per_task = 1 << 12;
        parallel_for_ranges(places.size(), texels_per_task, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) values[i] = smooth_.at(places[i].patch, places[i].at);
        });
        return values;
    }

    /// Least distance of ray starts from the border of a patch [texels]. At the foot of a wall, they would otherwise
    /// start in its plane.
    static constexpr float inset = 0.05f;

    PathOptions path_options() const {
        PathOptions path;
        path.samples = options_.lightmap->samples;
        path.max_samples = std::max(path.max_samples, path.samples);
        path.seed = options_.lightmap->seed;
        path.quantity = PathQuantity::irradiance;
        return path;
    }

    std::vector<Rgb> hybrid(std::span<const TexelPlace> places, float texel) const {
        std::vector<Gauge> gauges;
        gauges.reserve(places.size());
        for (const TexelPlace& place : places) {
            const PatchGeometry& geometry = solution_.forest->geometry(place.patch);
            const auto side = [&](const Parameters& p) {
                return geometry.shape().edge_u * p.u + geometry.shape().edge_v * p.v;
            };
            Gauge gauge;
            gauge.position = geometry.point(geometry.inset(place.at, inset * texel));
            gauge.normal = vertices_.normals().at(geometry, place.patch, place.at);
            gauge.patch = place.patch;
            gauge.side_u = side(place.sides[0]), gauge.side_v = side(place.sides[1]);
            gauge.inset = inset * texel;
            gauges.push_back(gauge);
        }
        const KnownIrradiance known{*solution_.forest, solution_.irradiance, true};
        return hybrid_irradiance(scene_, *ray_caster_, known, gauges, path_options(), options_.monitor);
    }

    std::vector<Rgb> gathered(std::span<const TexelPlace> places, float texel) const {
        std::vector<MeasuringPoint> points;
        points.reserve(places.size());
        for (const TexelPlace& place : places) {
            const PatchGeometry& geometry = solution_.forest->geometry(place.patch);
            const V3f x = geometry.point(geometry.inset(place.at, inset * texel));
            const V3f normal = vertices_.normals().at(geometry, place.patch, place.at);
            points.push_back({scene_.origin + Imath::V3d(x), normal});
        }
        const std::vector<MeasuredIrradiance> measured =
            measure_irradiance(scene_, &solution_, *ray_caster_, points, path_options(), options_.monitor);
        const auto lit = std::count_if(measured.begin(), measured.end(),
                                       [](const MeasuredIrradiance& m) { return m.is_measured(); });
        if (static_cast<std::size_t>(lit) < measured.size())
            throw Stopped(fmt::format("stopped when {} of {} texels of the lightmap had light", lit, measured.size()));
        std::vector<Rgb> values;
        values.reserve(measured.size());
        for (const MeasuredIrradiance& m : measured) values.push_back(m.sum());
        return values;
    }

    const Scene& scene_;
    const Solution& solution_;
    const ExportOptions& options_;
    ElementVertices vertices_;
    SmoothField smooth_;
    std::optional<RayCaster> ray_caster_;
};

Rgb content_of(const Scene& scene, const TexelPlace& place, const Rgb& irradiance, LightmapContent content) {
    if (content == LightmapContent::irradiance) return irradiance;
    const Patch& patch = scene.patches[place.patch];
    const Rgb radiosity = exitance_at(scene, patch, place.at) + reflectance_at(scene, patch, place.at) * irradiance;
    return radiosity / std::numbers::pi_v<float>;
}

std::vector<TexelPlace> places_of(const LightmapChart& chart, int gutter) {
    const NearestPatch nearest(chart);
    const int columns = chart.columns + 2 * gutter, rows = chart.rows + 2 * gutter;
    const auto texel = static_cast<float>(std::max(chart.spacing().x, chart.spacing().y));
    std::vector<TexelPlace> places(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    constexpr std::size_t texels_per_task = 1 << 10;
    parallel_for_ranges(places.size(), texels_per_task, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const auto column = static_cast<int>(i % static_cast<std::size_t>(columns)) - gutter;
            const auto row = static_cast<int>(i / static_cast<std::size_t>(columns)) - gutter;
            places[i] = nearest.find(Imath::V2d(column, row) * chart.spacing(), texel);
        }
    });
    return places;
}

/// Returns the texel whose light each texel of a chart takes: the nearest that bilinear interpolation may use.
std::vector<std::size_t> lit_texels(std::span<const TexelPlace> places, std::size_t columns) {
    constexpr auto unknown = static_cast<std::size_t>(-1);
    std::vector<std::size_t> lit(places.size(), unknown), reached;
    for (std::size_t i = 0; i < places.size(); ++i)
        if (places[i].is_near) lit[i] = i, reached.push_back(i);
    for (std::size_t next = 0; next < reached.size(); ++next) {
        const std::size_t i = reached[next], column = i % columns;
        const auto reach = [&](std::size_t neighbour) {
            if (lit[neighbour] != unknown) return;
            lit[neighbour] = lit[i];
            reached.push_back(neighbour);
        };
        if (column > 0) reach(i - 1);
        if (column + 1 < columns) reach(i + 1);
        if (i >= columns) reach(i - columns);
        if (i + columns < places.size()) reach(i + columns);
    }
    return lit;
}

/// Texels of all charts.
class LightmapTexels {
  public:
    explicit LightmapTexels(const LightmapOptions& options) : options_(options) {}

    void add(const LightmapChart& chart) {
        const std::vector<TexelPlace> places = places_of(chart, options_.gutter);
        const int columns = chart.columns + 2 * options_.gutter;
        const std::vector<std::size_t> lit = lit_texels(places, static_cast<std::size_t>(columns));
        std::vector<std::size_t> numbers(places.size());
        for (std::size_t i = 0; i < places.size(); ++i) {
            numbers[i] = places_.size();
            if (lit[i] == i) places_.push_back(places[i]);
            texels_inside_ += places[i].is_inside;
        }
        for (std::size_t i = 0; i < places.size(); ++i) {
            const int column = chart.left - options_.gutter + static_cast<int>(i) % columns;
            const int row = chart.top - options_.gutter + static_cast<int>(i) / columns;
            targets_.push_back({static_cast<std::size_t>(chart.page), numbers[lit[i]], column, row});
        }
    }
    void evaluate(const Scene& scene, const IrradianceSource& source, std::vector<Image>& images) const {
        const std::vector<Rgb> irradiance = source.irradiance(places_, 1 / options_.texels_per_metre);
        for (const Target& target : targets_)
            images[target.page].at(target.column, target.row) =
                content_of(scene, places_[target.place], irradiance[target.place], options_.content);
    }
    std::size_t texels() const { return targets_.size(); }
    std::int64_t texels_inside() const { return texels_inside_; }

  private:
    struct Target {
        std::size_t page, place;
        int column, row;
    };

    const LightmapOptions& options_;
    std::vector<TexelPlace> places_;
    std::vector<Target> targets_;
    std::int64_t texels_inside_ = 0;
};

void add(const std::vector<Image>& images, std::vector<Image>& sum) {
    for (std::size_t page = 0; page < sum.size(); ++page)
        for (std::size_t i = 0; i < sum[page].pixels.size(); ++i) sum[page].pixels[i] += images[page].pixels[i];
}

/// The lightmap is the sum of its groups, including noise.
void evaluate_groups(const LightmapTexels& texels, const Scene& scene, const Solution& solution,
                     const ExportOptions& options, Lightmap& lightmap) {
    SourceGroups groups = source_groups(scene);
    groups.names = solution.group_names;
    for (std::size_t g = 0; g < groups.size(); ++g) {
        std::vector<float> factors(groups.size(), 0);
        factors[g] = 1;
        const Scene alone = dimmed(scene, groups, factors);
        Solution share = solution;
        share.irradiance = std::move(share.groups[g]);
        share.groups.clear();
        ExportOptions of_group = options;
        const auto count = static_cast<double>(groups.size()), before = static_cast<double>(g);
        of_group.monitor = monitor_section(options.monitor, before / count, (before + 1) / count);
        lightmap.groups.push_back(lightmap.images);
        texels.evaluate(alone, IrradianceSource(alone, share, of_group), lightmap.groups.back());
    }
    for (const std::vector<Image>& images : lightmap.groups) add(images, lightmap.images);
}

double texels_of(const LightmapChart& chart, int gutter) {
    return static_cast<double>(chart.columns + 2 * gutter) * (chart.rows + 2 * gutter);
}

/// @param texels  Of all images. @param texels_of_charts  With gutters.
void require_memory(double texels, double texels_of_charts, const LightmapOptions& options, std::size_t groups) {
    // Per image texel: image, copy to encode, encoded bytes.
    constexpr double image_bytes = sizeof(Rgb) + sizeof(Rgb) + 16, group_bytes = sizeof(Rgb) + sizeof(Rgb);
    // Per chart texel: place, target, light.
    constexpr double texel_bytes = 2 * sizeof(TexelPlace) + 16 + sizeof(Rgb),
                     gathered_bytes =
                         path_bytes_per_pixel + sizeof(MeasuringPoint) + sizeof(Gauge) + sizeof(MeasuredIrradiance);
    const bool gathers = options.shading == LightmapShading::gather;
    const double bytes = texels * (image_bytes + (options.groups ? static_cast<double>(groups) * group_bytes : 0)) +
                         texels_of_charts * (texel_bytes + (gathers ? gathered_bytes : 0));
    if (bytes > static_cast<double>(options.max_bytes))
        throw InputError(
            fmt::format("lightmap: {:.3g} million texels need {:.0f} MiB of memory, the limit (max_bytes) is {} MiB: "
                        "expected fewer "
                        "than {:g} texels_per_metre{}",
                        texels / 1e6, bytes / (1 << 20), options.max_bytes >> 20, options.texels_per_metre,
                        gathers ? ", or light that is not gathered" : ""));
}

}  // namespace

V2f Lightmap::coordinate(std::uint32_t patch, Parameters at) const {
    const LightmapChart& chart = charts[chart_of_patch[patch]];
    const Image& image = images[static_cast<std::size_t>(chart.page)];
    const Imath::V2d texel = chart.patches[index_in_chart[patch]].point(at) / chart.spacing();
    return {static_cast<float>((chart.left + texel.x + 0.5) / image.width),
            static_cast<float>((chart.top + texel.y + 0.5) / image.height)};
}

Lightmap make_lightmap(const Scene& scene, const Solution& solution, const ExportOptions& options) {
    const LightmapOptions& chosen = *options.lightmap;
    Lightmap lightmap;
    lightmap.charts = make_charts(scene, shown_patches(scene, solution), chosen, options.warnings);
    lightmap.chart_of_patch.assign(scene.patches.size(), none);
    lightmap.index_in_chart.assign(scene.patches.size(), none);
    const std::vector<Imath::V2i> sizes = pack_charts(lightmap.charts, chosen.gutter, chosen.max_size);
    double texels = 0, texels_of_charts = 0;
    for (const Imath::V2i& size : sizes) texels += static_cast<double>(size.x) * size.y;
    for (const LightmapChart& chart : lightmap.charts) texels_of_charts += texels_of(chart, chosen.gutter);
    require_memory(texels, texels_of_charts, chosen, solution.groups.size());
    for (const Imath::V2i& size : sizes) lightmap.images.emplace_back(size.x, size.y);
    LightmapTexels evaluated(chosen);
    for (std::uint32_t i = 0; i < lightmap.charts.size(); ++i) {
        const FlatPatches& patches = lightmap.charts[i].patches;
        for (std::uint32_t k = 0; k < patches.size(); ++k) {
            lightmap.chart_of_patch[patches[k].patch] = i;
            lightmap.index_in_chart[patches[k].patch] = k;
        }
        evaluated.add(lightmap.charts[i]);
    }
    if (chosen.groups)
        evaluate_groups(evaluated, scene, solution, options, lightmap);
    else
        evaluated.evaluate(scene, IrradianceSource(scene, solution, options), lightmap.images);
    lightmap.used = static_cast<double>(evaluated.texels()) / texels;
    lightmap.covered = static_cast<double>(evaluated.texels_inside()) / texels;
    return lightmap;
}

}  // namespace interflect::detail
