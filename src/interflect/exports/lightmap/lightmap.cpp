#include "interflect/exports/lightmap/lightmap.h"

#include <ImathBoxAlgo.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "interflect/base/threads/monitor_section.h"
#include "interflect/base/threads/parallel.h"
#include "interflect/core.h"
#include "interflect/exports/lightmap/baked_light.h"
#include "interflect/exports/lightmap/lightmap_atlas.h"
#include "interflect/exports/mesh/shown_patches.h"
#include "interflect/geometry/search/box_tree.h"
#include "interflect/geometry/textures/texture_mapping.h"
#include "interflect/measure.h"
#include "interflect/render/pictures/path_picture.h"
#include "interflect/render/pictures/pixel_statistics.h"
#include "interflect/render/rays/gauge.h"
#include "interflect/render/shared_light.h"
#include "interflect/render/sharing/light_order.h"
#include "interflect/scene.h"

namespace interflect::detail {

namespace {

constexpr DirectSampling texel_sampling{&DefaultSamples::texel, hybrid_target, /*is_tested=*/false};

struct TexelPlace : BakedPoint {
    bool is_inside = false;
    bool is_near =
        false;  ///< Whether it is less than a texel from the patch, so that bilinear interpolation may use it.
};

/// Returns the two sides of a texel in the parameters of the patch, by Cramer's rule. The patch is treated as the
/// parallelogram of its edges at corner 0.
/// @param spacing  Width and height of a texel [m].
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

    /// Returns the place on the patches that is nearest to a point of the chart.
    /// @param at          Position in the chart [m].
    /// @param texel_size  Larger side of a texel [m].
    TexelPlace find(const Imath::V2d& at, float texel_size) const {
        const V3f x(static_cast<float>(at.x), static_cast<float>(at.y), 0);
        TexelPlace nearest;
        float least2 = std::numeric_limits<float>::max();
        const auto is_near = [&](const Imath::Box3f& box) {
            return (Imath::closestPointInBox(x, box) - x).length2() <= least2;
        };
        visit_box_tree(std::span<const Boxed>(tree_), is_near, [&](std::uint32_t i) {
            const Parameters p = nearest_parameters(geometries_[i], x);
            const float distance2 = (geometries_[i].point(p) - x).length2();
            const bool precedes = nearest.patch == none || patches_[i].patch < nearest.patch;
            if (distance2 < least2 || (distance2 == least2 && precedes)) {
                least2 = distance2;
                nearest = {{patches_[i].patch, p, sides_[i]}};
            }
        });
        constexpr float rounding = 1e-3f;  // [texels]
        nearest.is_inside = least2 <= rounding * rounding * texel_size * texel_size;
        nearest.is_near = least2 < (1 - rounding) * (1 - rounding) * texel_size * texel_size;
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
    const std::span<const Parameters> corners = corners_of(geometry.is_triangle());
    const std::size_t count = corners.size();
    V3f nearest = x;
    float least2 = std::numeric_limits<float>::max();
    bool is_inside = true;
    for (std::size_t c = 0; c < count; ++c) {
        const V3f a = geometry.point(corners[c]), b = geometry.point(corners[(c + 1) % count]);
        if (geometry.normal().dot((b - a).cross(x - a)) >= 0) continue;
        is_inside = false;
        const V3f candidate = nearest_on_segment(a, b, x);
        if ((candidate - x).length2() >= least2) continue;
        least2 = (candidate - x).length2();
        nearest = candidate;
    }
    return geometry.parameters_of(is_inside ? x : nearest);
}

Rgb content_of(const Scene& scene, const BakedPoint& place, const Rgb& irradiance, LightmapContent content) {
    if (content == LightmapContent::irradiance) return irradiance;
    const Patch& patch = scene.patches[place.patch];
    const Rgb radiosity = exitance_at(scene, patch, place.at) + reflectance_at(scene, patch, place.at) * irradiance;
    return radiosity / std::numbers::pi_v<float>;
}

std::vector<TexelPlace> places_of(const LightmapChart& chart, int gutter) {
    const NearestPatch nearest(chart);
    const int columns = chart.columns + 2 * gutter, rows = chart.rows + 2 * gutter;
    const auto texel_size = static_cast<float>(std::max(chart.spacing().x, chart.spacing().y));
    std::vector<TexelPlace> places(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    constexpr std::size_t texels_per_task = 1 << 10;
    parallel_for_ranges(places.size(), texels_per_task, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const auto column = static_cast<int>(i % static_cast<std::size_t>(columns)) - gutter;
            const auto row = static_cast<int>(i / static_cast<std::size_t>(columns)) - gutter;
            places[i] = nearest.find(Imath::V2d(column, row) * chart.spacing(), texel_size);
        }
    });
    return places;
}

/// Returns, for each texel, the texel near a patch whose light it copies, found by flood fill. Texels near a patch copy
/// themselves.
std::vector<std::size_t> copied_texels(std::span<const TexelPlace> places, std::size_t columns) {
    constexpr auto unknown = static_cast<std::size_t>(-1);
    std::vector<std::size_t> copied(places.size(), unknown), reached;
    for (std::size_t i = 0; i < places.size(); ++i)
        if (places[i].is_near) {
            copied[i] = i;
            reached.push_back(i);
        }
    for (std::size_t next = 0; next < reached.size(); ++next) {
        const std::size_t i = reached[next], column = i % columns;
        const auto fill = [&](std::size_t neighbour) {
            if (copied[neighbour] != unknown) return;
            copied[neighbour] = copied[i];
            reached.push_back(neighbour);
        };
        if (column > 0) fill(i - 1);
        if (column + 1 < columns) fill(i + 1);
        if (i >= columns) fill(i - columns);
        if (i + columns < places.size()) fill(i + columns);
    }
    return copied;
}

/// Texels of all charts. Texels that are far from patches copy the light of an evaluated texel.
class LightmapTexels {
  public:
    explicit LightmapTexels(const LightmapOptions& options) : options_(options) {}

    void add(const LightmapChart& chart) {
        const std::vector<TexelPlace> places = places_of(chart, options_.gutter);
        const int columns = chart.columns + 2 * options_.gutter;
        const std::vector<std::size_t> copied = copied_texels(places, static_cast<std::size_t>(columns));
        std::vector<std::size_t> place_index(places.size());
        PointGrid grid{columns, std::vector<std::uint32_t>(places.size(), none)};
        for (std::size_t i = 0; i < places.size(); ++i) {
            place_index[i] = places_.size();
            texels_inside_ += places[i].is_inside;
            if (copied[i] != i) continue;
            grid.points[i] = static_cast<std::uint32_t>(places_.size());
            places_.push_back(places[i]);
        }
        grids_.push_back(std::move(grid));
        for (std::size_t i = 0; i < places.size(); ++i) {
            const int column = chart.left - options_.gutter + static_cast<int>(i) % columns;
            const int row = chart.top - options_.gutter + static_cast<int>(i) / columns;
            targets_.push_back({static_cast<std::size_t>(chart.page), place_index[copied[i]], column, row});
        }
    }
    void evaluate(const Scene& scene, const BakedLight& light, const Monitor& monitor,
                  std::vector<Image>& images) const {
        const std::vector<Rgb> irradiance = light.irradiance(places_, grids_, 1 / options_.texels_per_metre, monitor);
        for (const Target& target : targets_)
            images[target.page].at(target.column, target.row) =
                content_of(scene, places_[target.place], irradiance[target.place], options_.content);
    }
    std::size_t count() const { return targets_.size(); }
    std::int64_t count_inside() const { return texels_inside_; }

  private:
    struct Target {
        std::size_t page, place;
        int column, row;
    };

    const LightmapOptions& options_;
    std::vector<BakedPoint> places_;
    std::vector<PointGrid> grids_;  // one for each chart
    std::vector<Target> targets_;
    std::int64_t texels_inside_ = 0;
};

void add(const std::vector<Image>& images, std::vector<Image>& sum) {
    for (std::size_t page = 0; page < sum.size(); ++page)
        for (std::size_t i = 0; i < sum[page].pixels.size(); ++i) sum[page].pixels[i] += images[page].pixels[i];
}

/// Evaluates each light group alone. The lightmap is their sum, including the noise.
void evaluate_groups(const LightmapTexels& texels, const Scene& scene, const Solution& solution,
                     const ExportOptions& options, Lightmap& lightmap) {
    Ranks* const ranks = options.monitor.ranks;
    const std::size_t count = solution.group_names.size();
    for (std::size_t g = 0; g < count; ++g) {
        const LightOfGroup group = light_of_group(scene, solution, g);
        const auto fraction = [&](std::size_t i) { return static_cast<double>(i) / static_cast<double>(count); };
        lightmap.groups.push_back(lightmap.images);  // these images are still black
        give_order(ranks, {.kind = LightOrder::Kind::group, .group = g});
        try {
            texels.evaluate(group.scene, BakedLight(group.scene, group.solution, options.bake, texel_sampling),
                            monitor_section(options.monitor, fraction(g), fraction(g + 1)), lightmap.groups.back());
        } catch (const Stopped&) {
            end_shared_light(ranks);
            throw;
        }
        end_shared_light(ranks);
    }
    for (const std::vector<Image>& images : lightmap.groups) add(images, lightmap.images);
}

double texel_count(const LightmapChart& chart, int gutter) {
    return static_cast<double>(chart.columns + 2 * gutter) * (chart.rows + 2 * gutter);
}

/// Requires that the lightmap fits into the limit of memory.
/// @param image_texels  Number of texels of all images.
/// @param chart_texels  Number of texels of all charts with gutters.
void require_memory(double image_texels, double chart_texels, const LightmapOptions& options, Shading shading,
                    std::size_t groups) {
    constexpr double encoded_bytes = 16;  // a texel has at most four channels in single precision
    constexpr double target_bytes = 24;   // size of two indices, a column and a row
    // Each texel of an image is stored twice, the second time to be encoded, and once encoded.
    constexpr double image_bytes = 2 * sizeof(Rgb) + encoded_bytes, group_bytes = 2 * sizeof(Rgb);
    // A texel of a chart needs two copies of its place, its target and its light.
    constexpr double texel_bytes = 2 * sizeof(TexelPlace) + target_bytes + sizeof(Rgb),
                     hybrid_bytes = sizeof(SurfacePoint) + sizeof(Gauge) + sizeof(GaugeLight) + sizeof(Rgb),
                     gathered_bytes =
                         path_bytes_per_pixel + sizeof(MeasuringPoint) + sizeof(Gauge) + sizeof(MeasuredIrradiance);
    const bool gathers = shading == Shading::gather;
    const double shading_bytes = gathers ? gathered_bytes : shading == Shading::hybrid ? hybrid_bytes : 0;
    const double bytes =
        image_texels * (image_bytes + (options.groups ? static_cast<double>(groups) * group_bytes : 0)) +
        chart_texels * (texel_bytes + shading_bytes);
    if (bytes > static_cast<double>(options.max_bytes))
        throw InputError(Fault{
            .text = fmt::format(
                "lightmap: {:.3g} million texels need {:.0f} MiB of memory, more than the limit of {} MiB (max_bytes): "
                "expected fewer than {:g} texels_per_metre{}",
                image_texels / 1e6, bytes / (1 << 20), options.max_bytes >> 20, options.texels_per_metre,
                gathers ? ", or a shading other than gather" : ""),
            .setting = "texels_per_metre"});
}

}  // namespace

V2f Lightmap::coordinate(PatchIndex patch, Parameters at) const {
    const LightmapChart& chart = charts[chart_of_patch[patch]];
    const Image& image = images[static_cast<std::size_t>(chart.page)];
    const Imath::V2d texel = chart.patches[index_in_chart[patch]].point(at) / chart.spacing();
    return {static_cast<float>((chart.left + texel.x + 0.5) / image.width),
            static_cast<float>((chart.top + texel.y + 0.5) / image.height)};
}

Lightmap make_lightmap(const Scene& scene, const Solution& solution, const ExportOptions& options) {
    const LightmapOptions& lightmap_options = *options.lightmap;
    Lightmap lightmap;
    lightmap.charts = make_charts(scene, shown_patches(scene, solution), lightmap_options, options.warnings);
    lightmap.chart_of_patch.assign(scene.patches.size(), none);
    lightmap.index_in_chart.assign(scene.patches.size(), none);
    double image_texels = 0, chart_texels = 0;
    for (const LightmapChart& chart : lightmap.charts) chart_texels += texel_count(chart, lightmap_options.gutter);
    const auto require_memory_of_images = [&](double texels) {
        require_memory(texels, chart_texels, lightmap_options, options.bake.shading, solution.groups.size());
    };
    require_memory_of_images(chart_texels);  // check a lower bound first, because packing many charts takes minutes
    const std::vector<Imath::V2i> sizes =
        pack_charts(lightmap.charts, lightmap_options.gutter, lightmap_options.max_size);
    for (const Imath::V2i& size : sizes) image_texels += static_cast<double>(size.x) * size.y;
    require_memory_of_images(image_texels);
    for (const Imath::V2i& size : sizes) lightmap.images.emplace_back(size.x, size.y);
    LightmapTexels texels(lightmap_options);
    for (std::uint32_t i = 0; i < lightmap.charts.size(); ++i) {
        const FlatPatches& patches = lightmap.charts[i].patches;
        for (PatchIndex k{0}; k < patches.size(); ++k) {
            lightmap.chart_of_patch[patches[k].patch] = i;
            lightmap.index_in_chart[patches[k].patch] = k;
        }
        texels.add(lightmap.charts[i]);
    }
    if (lightmap_options.groups)
        evaluate_groups(texels, scene, solution, options, lightmap);
    else
        texels.evaluate(scene, BakedLight(scene, solution, options.bake, texel_sampling), options.monitor,
                        lightmap.images);
    lightmap.used = static_cast<double>(texels.count()) / image_texels;
    lightmap.covered = static_cast<double>(texels.count_inside()) / image_texels;
    return lightmap;
}

}  // namespace interflect::detail
