#include "interflect/exports/lightmap/bake.h"

#include <ImathBoxAlgo.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "interflect/base/threads/monitor_section.h"
#include "interflect/core.h"
#include "interflect/exports/lightmap/baked_light.h"
#include "interflect/exports/lightmap/density.h"
#include "interflect/geometry/search/box_tree.h"
#include "interflect/geometry/textures/texture_mapping.h"
#include "interflect/measure.h"
#include "interflect/render/pictures/path_picture.h"
#include "interflect/render/pictures/pixel_statistics.h"
#include "interflect/render/rays/gauge.h"
#include "interflect/render/shared_light.h"
#include "interflect/render/sharing/light_order.h"

namespace interflect::detail {

namespace {

/// Direct light is sampled until its noise is about 3% per texel. In a furnished room with a window, the denoiser of
/// BakeOptions reduced this noise to 0.5%. A noise of 6% left visible grain on the walls.
constexpr DirectSampling texel_sampling{&DefaultSamples::texel, /*max_noise=*/0.03, /*calls_direct=*/false};

/// Returns the irradiance of a point, or the radiance that leaves it.
Rgb texel_value(LightmapContent content, const Scene& scene, const BakedPoint& point, const Rgb& irradiance) {
    if (content == LightmapContent::irradiance) return irradiance;
    const Patch& patch = scene.patches[point.patch];
    const Rgb radiosity = exitance_at(scene, patch, point.at) + reflectance_at(scene, patch, point.at) * irradiance;
    return radiosity / std::numbers::pi_v<float>;
}

V3f position_of(const Scene& scene, const BakedPoint& point) {
    return PatchGeometry(scene, scene.patches[point.patch]).point(point.at);
}

/// Finds the point that is nearest to a position.
class PointSearch {
  public:
    /// Refers to its arguments.
    PointSearch(const Scene& scene, std::span<const BakedPoint> points) : scene_(scene), points_(points) {
        for (std::uint32_t i = 0; i < points.size(); ++i)
            tree_.push_back({Imath::Box3f(position_of(scene, points[i])), i});
        arrange_box_tree(tree_);
    }
    /// Returns the index of the point that is nearest to x; of equally near points, the lowest index.
    std::uint32_t find_nearest(const V3f& x) const {
        std::uint32_t nearest = none;
        float least_distance2 = std::numeric_limits<float>::max();
        const auto may_be_nearest = [&](const Imath::Box3f& box) {
            return (Imath::closestPointInBox(x, box) - x).length2() <= least_distance2;
        };
        visit_box_tree(std::span<const Boxed>(tree_), may_be_nearest, [&](std::uint32_t i) {
            const float distance2 = (position_of(scene_, points_[i]) - x).length2();
            if (distance2 > least_distance2 || (distance2 == least_distance2 && i > nearest)) return;
            nearest = i;
            least_distance2 = distance2;
        });
        return nearest;
    }

  private:
    const Scene& scene_;
    const std::span<const BakedPoint> points_;
    std::vector<Boxed> tree_;
};

/// Pixel of an image of the lightmap.
struct TexelPosition {
    std::size_t page;  // index of the image
    int column, row;
};

struct LitTexel {
    TexelPosition position;
    std::size_t point;  // index of the evaluated point whose light the texel shows
};

/// Texels of all charts, and the points at which light is evaluated for them.
class LightmapTexels {
  public:
    /// Refers to its argument.
    explicit LightmapTexels(const LightmapOptions& options) : options_(options) {}

    /// @param places  Texels of the chart and its gutter, row by row.
    void add_chart(const LightmapChart& chart, std::span<const TexelPlace> places) {
        const int columns = chart.columns + 2 * options_.gutter;
        const bool is_hidden =
            std::none_of(places.begin(), places.end(), [](const TexelPlace& place) { return place.is_evaluated; });
        if (is_hidden) {
            add_hidden_chart(chart, places, columns);
            return;
        }
        PointGrid grid{columns, std::vector<std::uint32_t>(places.size(), none)};
        for (std::size_t i = 0; i < places.size(); ++i) {
            texels_inside_ += places[i].is_inside;
            if (!places[i].is_evaluated) continue;
            grid.points[i] = static_cast<std::uint32_t>(points_.size());
            points_.push_back(static_cast<const BakedPoint&>(places[i]));  // without the flags of TexelPlace
        }
        const std::vector<std::size_t> source_texels = copied_texels(places, static_cast<std::size_t>(columns));
        for (std::size_t i = 0; i < places.size(); ++i)
            texels_.push_back({position_in_image(chart, i, columns), grid.points[source_texels[i]]});
        grids_.push_back(std::move(grid));
    }
    /// Assigns the nearest evaluated point in space to each texel of hidden charts. Requires that all charts are added.
    void assign_hidden_texels(const Scene& scene) {
        if (hidden_texels_.empty() || points_.empty()) return;
        const PointSearch search(scene, points_);
        for (const auto& [position, place] : hidden_texels_)
            texels_.push_back({position, search.find_nearest(position_of(scene, place))});
    }
    /// Writes the light of all texels to images.
    void evaluate(const Scene& scene, const BakedLight& light, const Monitor& monitor,
                  std::vector<Image>& images) const {
        const std::vector<Rgb> irradiance = light.irradiance(points_, grids_, monitor);
        for (const auto& [position, point] : texels_)
            images[position.page].at(position.column, position.row) =
                texel_value(options_.content, scene, points_[point], irradiance[point]);
    }
    std::int64_t count_inside() const { return texels_inside_; }

  private:
    struct HiddenTexel {
        TexelPosition position;
        BakedPoint place;
    };

    /// @param i        Index of a texel of a chart and its gutter.
    /// @param columns  Width of the chart and its gutter [texels].
    TexelPosition position_in_image(const LightmapChart& chart, std::size_t i, int columns) const {
        const int column = chart.left - options_.gutter + static_cast<int>(i) % columns;
        const int row = chart.top - options_.gutter + static_cast<int>(i) / columns;
        return {static_cast<std::size_t>(chart.page), column, row};
    }
    /// Skips texels whose patch MoveTexels has cleared.
    void add_hidden_chart(const LightmapChart& chart, std::span<const TexelPlace> places, int columns) {
        for (std::size_t i = 0; i < places.size(); ++i)
            if (places[i].patch != none) hidden_texels_.push_back({position_in_image(chart, i, columns), places[i]});
    }

    const LightmapOptions& options_;
    std::vector<BakedPoint> points_;          // points at which light is evaluated
    std::vector<PointGrid> grids_;            // one for each visible chart, with indices of points_
    std::vector<LitTexel> texels_;            // texels that get light
    std::vector<HiddenTexel> hidden_texels_;  // texels of charts in which no texel is evaluated
    std::int64_t texels_inside_ = 0;          // number of texels whose centres are on patches of visible charts
};

void add_images(const std::vector<Image>& images, std::vector<Image>& sum) {
    for (std::size_t page = 0; page < sum.size(); ++page)
        for (std::size_t i = 0; i < sum[page].pixels.size(); ++i) sum[page].pixels[i] += images[page].pixels[i];
}

/// Evaluates each light group alone. The lightmap is the exact sum of the images of all groups.
/// @param baked  Its total images must be black.
void evaluate_groups(const LightmapTexels& texels, const Scene& scene, const Solution& solution,
                     const ExportOptions& options, BakedImages& baked) {
    Ranks* const ranks = options.monitor.ranks;
    const std::size_t count = solution.group_names.size();
    for (std::size_t g = 0; g < count; ++g) {
        const LightOfGroup group = light_of_group(scene, solution, g);
        const auto fraction = [&](std::size_t i) { return static_cast<double>(i) / static_cast<double>(count); };
        const Monitor monitor = monitor_section(options.monitor, fraction(g), fraction(g + 1));
        // The other ranks make the same scene and solution, and trace a share of the rays until end_shared_light()
        give_order(ranks, {.kind = LightOrder::Kind::group, .group = g});
        try {
            texels.evaluate(group.scene, BakedLight(group.scene, group.solution, options.bake, texel_sampling), monitor,
                            baked.groups[g]);
        } catch (const Stopped&) {
            // All ranks have stopped. After another error, the caller must end the other ranks (Ranks::abort())
            end_shared_light(ranks);
            throw;
        }
        end_shared_light(ranks);
    }
    for (const std::vector<Image>& images : baked.groups) add_images(images, baked.images);
}

/// Numbers of texels, which determine the memory.
struct TexelCounts {
    double charts = 0;  // texels of charts with gutters
    double images = 0;  // texels of images, which include those between charts
};

double texels_of_charts(std::span<const LightmapChart> charts, int gutter) {
    double texels = 0;
    for (const LightmapChart& chart : charts)
        texels += static_cast<double>(chart.columns + 2 * gutter) * (chart.rows + 2 * gutter);
    return texels;
}

double texels_of_images(std::span<const Imath::V2i> sizes) {
    double texels = 0;
    for (const Imath::V2i& size : sizes) texels += static_cast<double>(size.x) * size.y;
    return texels;
}

/// Returns the memory for the light of one texel of a chart [bytes].
double light_bytes(Shading shading) {
    // Hybrid shading needs no path_bytes_per_pixel: it traces tiles of gauges and keeps only their light
    if (shading == Shading::hybrid) return sizeof(SurfacePoint) + sizeof(Gauge) + sizeof(GaugeLight) + sizeof(Rgb);
    if (shading == Shading::gather)
        return path_bytes_per_pixel + sizeof(MeasuringPoint) + sizeof(Gauge) + sizeof(MeasuredIrradiance);
    return 0;
}

/// Returns the memory that a lightmap needs [bytes].
double lightmap_bytes(const TexelCounts& texels, const ExportOptions& options, std::size_t group_count) {
    constexpr double encoded_bytes = 16;  // four channels in single precision, the largest encoding of a texel
    constexpr double copied_bytes = 2 * sizeof(Rgb);  // a texel of an image, and its copy for the encoder
    double image_bytes = copied_bytes + encoded_bytes;
    if (options.lightmap->groups) image_bytes += static_cast<double>(group_count) * copied_bytes;
    if (options.lightmap->content == LightmapContent::density) return texels.images * image_bytes;
    // Two copies of a texel's place, its entries in LightmapTexels and PointSearch, and its irradiance
    constexpr double place_bytes = 2 * sizeof(TexelPlace) + sizeof(LitTexel) + sizeof(Boxed) + sizeof(Rgb);
    return texels.images * image_bytes + texels.charts * (place_bytes + light_bytes(options.bake.shading));
}

void require_lightmap_memory(const TexelCounts& texels, const ExportOptions& options, std::size_t group_count) {
    const LightmapOptions& lightmap = *options.lightmap;
    const double bytes = lightmap_bytes(texels, options, group_count);
    if (bytes <= static_cast<double>(lightmap.max_bytes)) return;
    constexpr std::uint64_t mebibyte = 1 << 20;
    throw InputError(Fault{
        .text = fmt::format(
            "lightmap: {:.3g} million texels need {:.0f} MiB of memory, more than the limit of {} MiB (max_bytes): "
            "expected fewer than {:g} texels_per_metre{}",
            texels.images / 1e6, bytes / mebibyte, lightmap.max_bytes / mebibyte, lightmap.texels_per_metre,
            options.bake.shading == Shading::gather ? ", or a shading other than gather" : ""),
        .setting = "texels_per_metre"});
}

/// Requires that each pattern matches an object or a material.
void require_names(std::span<const std::string> patterns, const Scene& scene) {
    for (const std::string& pattern : patterns) {
        const auto is_object = [&](const std::string& object) { return matches_object(pattern, object); };
        const auto is_material = [&](const Material& material) { return matches(pattern, material.name); };
        if (std::none_of(scene.objects.begin(), scene.objects.end(), is_object) &&
            std::none_of(scene.materials.begin(), scene.materials.end(), is_material))
            throw InputError(Fault{.text = fmt::format("lightmap: no object or material is named '{}'", pattern),
                                   .setting = "update"});
    }
}

}  // namespace

BakedImages bake_charts(std::vector<LightmapChart>& charts, const PackCharts& pack, const MoveTexels& move_texels,
                        const Scene& scene, const Solution& solution, const ExportOptions& options,
                        const EarlierLightmap* earlier) {
    const LightmapOptions& lightmap = *options.lightmap;

    require_names(lightmap.update, scene);

    // Check a lower bound of the memory first, because packing many charts takes minutes
    TexelCounts texel_counts;
    texel_counts.charts = texels_of_charts(charts, lightmap.gutter);
    texel_counts.images = texel_counts.charts;
    require_lightmap_memory(texel_counts, options, solution.group_names.size());

    const std::vector<Imath::V2i> sizes = pack(charts);
    texel_counts.images = texels_of_images(sizes);
    require_lightmap_memory(texel_counts, options, solution.group_names.size());
    BakedImages baked;
    const Json layout = layout_of(charts, scene, lightmap);
    baked.layout = layout.dump();
    baked.densities = densities_of(charts, scene);
    if (options.warnings) warn_of_reduced_density(baked.densities, *options.warnings);
    const double all_texels = std::max(1.0, texel_counts.images);  // no division by 0 without charts
    baked.used = texel_counts.charts / all_texels;
    for (const Imath::V2i& size : sizes) baked.images.emplace_back(size.x, size.y);
    if (lightmap.content == LightmapContent::density) {
        draw_density(charts, lightmap, baked.images);
        return baked;
    }
    if (lightmap.groups) baked.groups.assign(solution.group_names.size(), baked.images);
    if (earlier) {
        require_same_layout(*earlier, layout);
        read_images(*earlier, baked.images, baked.groups);
    }

    LightmapTexels texels(lightmap);
    for (std::size_t i = 0; i < charts.size(); ++i) {
        if (!charts[i].is_updated) continue;
        std::vector<TexelPlace> places = places_of(charts[i], lightmap.gutter);
        move_texels(i, places);
        texels.add_chart(charts[i], places);
    }
    texels.assign_hidden_texels(scene);

    if (lightmap.groups)
        evaluate_groups(texels, scene, solution, options, baked);
    else  // the other ranks already have this scene and solution
        texels.evaluate(scene, BakedLight(scene, solution, options.bake, texel_sampling), options.monitor,
                        baked.images);
    baked.covered = earlier ? earlier->covered : static_cast<double>(texels.count_inside()) / all_texels;
    return baked;
}

}  // namespace interflect::detail
