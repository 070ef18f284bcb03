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

/// Noise of 3% a texel is 0.5% after the filter, in a furnished room with a window; 6% left visible grain on its walls.
constexpr DirectSampling texel_sampling{&DefaultSamples::texel, 0.03, /*needs_direct=*/false};

Rgb content_of(const Scene& scene, const BakedPoint& place, const Rgb& irradiance, LightmapContent content) {
    if (content == LightmapContent::irradiance) return irradiance;
    const Patch& patch = scene.patches[place.patch];
    const Rgb radiosity = exitance_at(scene, patch, place.at) + reflectance_at(scene, patch, place.at) * irradiance;
    return radiosity / std::numbers::pi_v<float>;
}

/// Texels of all charts. Texels that are far from patches copy the light of an evaluated texel.
class LightmapTexels {
  public:
    explicit LightmapTexels(const LightmapOptions& options) : options_(options) {}

    void add(const LightmapChart& chart, std::span<const TexelPlace> places) {
        const int columns = chart.columns + 2 * options_.gutter;
        const std::vector<std::size_t> copied = copied_texels(places, static_cast<std::size_t>(columns));
        if (std::find_if(copied.begin(), copied.end(), [](std::size_t i) { return i != no_texel; }) == copied.end())
            return add_hidden(chart, places, columns);
        std::vector<std::size_t> place_index(places.size());  // index in places_ of each evaluated texel
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
            targets_.push_back(target_of(chart, i, columns));
            targets_.back().place = place_index[copied[i]];
        }
    }
    /// Makes hidden texels copy the nearest visible ones. Call it after all charts have been added.
    void fill_hidden(const Scene& scene) {
        if (hidden_.empty() || places_.empty()) return;
        std::vector<Boxed> tree;
        for (std::uint32_t i = 0; i < places_.size(); ++i)
            tree.push_back({Imath::Box3f(position_of(scene, places_[i])), i});
        arrange_box_tree(tree);
        for (auto& [target, point] : hidden_) {
            const V3f x = position_of(scene, point);
            std::pair nearest(std::numeric_limits<float>::max(), none);  // squared distance [m^2], and place
            const auto is_near = [&](const Imath::Box3f& box) {
                return (Imath::closestPointInBox(x, box) - x).length2() <= nearest.first;
            };
            visit_box_tree(std::span<const Boxed>(tree), is_near, [&](std::uint32_t i) {
                nearest = std::min(nearest, std::pair((position_of(scene, places_[i]) - x).length2(), i));
            });
            target.place = nearest.second;
            targets_.push_back(target);
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
    /// Texel of an image, and the index in places_ of the point whose light it shows.
    struct Target {
        std::size_t page, place;
        int column, row;
    };

    Target target_of(const LightmapChart& chart, std::size_t i, int columns) const {
        const int column = chart.left - options_.gutter + static_cast<int>(i) % columns;
        const int row = chart.top - options_.gutter + static_cast<int>(i) / columns;
        return {static_cast<std::size_t>(chart.page), 0, column, row};
    }
    void add_hidden(const LightmapChart& chart, std::span<const TexelPlace> places, int columns) {
        for (std::size_t i = 0; i < places.size(); ++i)
            if (places[i].patch != none) hidden_.push_back({target_of(chart, i, columns), places[i]});
    }
    static V3f position_of(const Scene& scene, const BakedPoint& point) {
        return PatchGeometry(scene, scene.patches[point.patch]).point(point.at);
    }

    const LightmapOptions& options_;
    std::vector<BakedPoint> places_;
    std::vector<PointGrid> grids_;  // one for each chart
    std::vector<Target> targets_;
    std::vector<std::pair<Target, BakedPoint>> hidden_;  // texels of charts whose texels are all hidden
    std::int64_t texels_inside_ = 0;
};

void add(const std::vector<Image>& images, std::vector<Image>& sum) {
    for (std::size_t page = 0; page < sum.size(); ++page)
        for (std::size_t i = 0; i < sum[page].pixels.size(); ++i) sum[page].pixels[i] += images[page].pixels[i];
}

/// Evaluates each light group alone. The lightmap is their sum, including the noise.
void evaluate_groups(const LightmapTexels& texels, const Scene& scene, const Solution& solution,
                     const ExportOptions& options, BakedImages& baked) {
    Ranks* const ranks = options.monitor.ranks;
    const std::size_t count = solution.group_names.size();
    for (std::size_t g = 0; g < count; ++g) {
        const LightOfGroup group = light_of_group(scene, solution, g);
        const auto fraction = [&](std::size_t i) { return static_cast<double>(i) / static_cast<double>(count); };
        baked.groups.push_back(baked.images);  // these images are still black
        give_order(ranks, {.kind = LightOrder::Kind::group, .group = g});
        try {
            texels.evaluate(group.scene, BakedLight(group.scene, group.solution, options.bake, texel_sampling),
                            monitor_section(options.monitor, fraction(g), fraction(g + 1)), baked.groups.back());
        } catch (const Stopped&) {
            end_shared_light(ranks);
            throw;
        }
        end_shared_light(ranks);
    }
    for (const std::vector<Image>& images : baked.groups) add(images, baked.images);
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
    // Memory per texel of an image: the texel, its copy for the encoder, and its encoded bytes.
    constexpr double image_bytes = 2 * sizeof(Rgb) + encoded_bytes, group_bytes = 2 * sizeof(Rgb);
    // A texel of a chart needs two copies of its place, its target, its light, and an entry in a tree (fill_hidden()).
    constexpr double texel_bytes = 2 * sizeof(TexelPlace) + target_bytes + sizeof(Rgb) + sizeof(Boxed),
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

BakedImages bake_charts(std::vector<LightmapChart>& charts, const PackCharts& pack, const MoveTexels& move,
                        const Scene& scene, const Solution& solution, const ExportOptions& options) {
    const LightmapOptions& lightmap = *options.lightmap;
    double image_texels = 0, chart_texels = 0;
    for (const LightmapChart& chart : charts) chart_texels += texel_count(chart, lightmap.gutter);
    const auto require_memory_of_images = [&](double texels) {
        require_memory(texels, chart_texels, lightmap, options.bake.shading, solution.groups.size());
    };
    require_memory_of_images(chart_texels);  // check a lower bound first, because packing many charts takes minutes
    const std::vector<Imath::V2i> sizes = pack(charts);
    for (const Imath::V2i& size : sizes) image_texels += static_cast<double>(size.x) * size.y;
    require_memory_of_images(image_texels);
    BakedImages baked;
    for (const Imath::V2i& size : sizes) baked.images.emplace_back(size.x, size.y);
    LightmapTexels texels(lightmap);
    for (std::size_t i = 0; i < charts.size(); ++i) {
        std::vector<TexelPlace> places = places_of(charts[i], lightmap.gutter);
        move(i, places);
        texels.add(charts[i], places);
    }
    texels.fill_hidden(scene);
    if (lightmap.groups)
        evaluate_groups(texels, scene, solution, options, baked);
    else
        texels.evaluate(scene, BakedLight(scene, solution, options.bake, texel_sampling), options.monitor,
                        baked.images);
    baked.used = static_cast<double>(texels.count()) / image_texels;
    baked.covered = static_cast<double>(texels.count_inside()) / image_texels;
    return baked;
}

}  // namespace interflect::detail
