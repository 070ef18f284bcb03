#include "interflect/exports/vertices/vertex_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <queue>
#include <unordered_map>
#include <utility>
#include <vector>

#include "interflect/base/numbers/random.h"
#include "interflect/base/threads/monitor_section.h"
#include "interflect/exports/lightmap/baked_light.h"
#include "interflect/exports/mesh/shown_patches.h"
#include "interflect/geometry/textures/texture_mapping.h"
#include "interflect/render/smooth/vertex_values.h"

namespace interflect::detail {

namespace {

/// Middle of two corners of an element, at which the interpolation between them is tested.
struct Middle {
    std::size_t a, b;
    Parameters at;
};
/// Middles of the edges and of both diagonals, because either diagonal may divide a square.
constexpr std::array<Middle, 6> square_middles{{{0, 1, {0.5f, 0}},
                                                {1, 2, {1, 0.5f}},
                                                {2, 3, {0.5f, 1}},
                                                {3, 0, {0, 0.5f}},
                                                {0, 2, {0.5f, 0.5f}},
                                                {1, 3, {0.5f, 0.5f}}}};
constexpr std::array<Middle, 3> triangle_middles{{{0, 1, {0.5f, 0}}, {1, 2, {0.5f, 0.5f}}, {2, 0, {0, 0.5f}}}};

std::span<const Middle> middles_of(bool is_triangle) {
    return is_triangle ? std::span<const Middle>(triangle_middles) : std::span<const Middle>(square_middles);
}

float longest_edge(const PatchGeometry& patch) {
    const std::span<const Parameters> corners = corners_of(patch.is_triangle());
    float longest = 0;
    for (std::size_t c = 0; c < corners.size(); ++c)
        longest =
            std::max(longest, (patch.point(corners[(c + 1) % corners.size()]) - patch.point(corners[c])).length());
    return longest;
}

/// Returns the mean irradiance of the shown leaves, weighted by area, mean of the channels [unit of H].
double mean_irradiance(const Solution& solution, const std::vector<bool>& shown) {
    const ElementForest& forest = *solution.forest;
    double sum = 0, area = 0;
    for (const ElementIndex leaf : forest.leaves()) {
        if (!shown[forest.patch(leaf)]) continue;
        sum += mean_channel(solution.irradiance[leaf]) * forest.area(leaf);
        area += forest.area(leaf);
    }
    return area > 0 ? sum / area : 0;
}

/// Returns the nominal distance of vertices [m], over which light is averaged. It is at most the default of min_edge.
float spacing_of(const VertexOptions& options) { return std::min(options.min_edge, VertexOptions().min_edge); }

/// Returns the sides of the area over which a vertex averages direct light, in the patch's parameters. They have the
/// size of two of the finest elements, which hides steps along the borders of shadows.
std::array<Parameters, 2> sides_of(const PatchGeometry& patch, float spacing) {
    const auto side = [&](const V3f& edge) { return std::min(1.0f, 2 * spacing / edge.length()); };
    return {{{side(patch.shape().edge_u), 0}, {0, side(patch.shape().edge_v)}}};
}

/// Counts the triangles of shown leaves. Leaves with points on their edges become fans around their centres.
double count_triangles(const Scene& scene, const ElementForest& forest, const std::vector<bool>& shown) {
    const ElementMesh mesh(scene, forest, std::vector<Rgb>(forest.size(), Rgb(0)));
    double triangles = 0;
    for (const ElementIndex leaf : forest.leaves()) {
        if (!shown[forest.patch(leaf)]) continue;
        const std::size_t vertices = mesh.outline(leaf).size();
        const bool is_fan = vertices > (forest.geometry(forest.patch(leaf)).is_triangle() ? 3u : 4u);
        triangles += static_cast<double>(is_fan ? vertices : vertices - std::min<std::size_t>(vertices, 2));
    }
    return triangles;
}

/// Divides elements, from coarse to fine, until the interpolation of direct light is accurate.
class Division {
  public:
    Division(const Scene& scene, const BakedLight& light, const std::vector<bool>& shown, double mean,
             const VertexOptions& options)
        : scene_(scene),
          light_(light),
          shown_(shown),
          mean_(mean),
          options_(options),
          forest_(std::make_shared<ElementForest>(scene, scene.patches.size() + capacity(options))) {
        for (PatchIndex p{0}; p < forest_->patch_count(); ++p) edges_.push_back(longest_edge(forest_->geometry(p)));
        triangles_ = count_triangles(scene, *forest_, shown);
    }

    std::shared_ptr<const ElementForest> run(const Monitor& monitor) {
        std::vector<ElementIndex> leaves = divide_long_edges();
        // Each round reports half of the remaining progress
        for (double fraction = 0; !leaves.empty(); fraction = (1 + fraction) / 2)
            leaves = divide_badly_interpolated(leaves, monitor_section(monitor, fraction, (1 + fraction) / 2));
        forest_->put_in_order(forest_->patch_count());
        return forest_;
    }

  private:
    struct Key {
        PatchIndex patch;
        Parameters at;
        bool operator==(const Key& o) const { return patch == o.patch && at.u == o.at.u && at.v == o.at.v; }
    };
    struct KeyHash {
        std::size_t operator()(const Key& key) const {
            return mix(mix(key.patch ^ std::hash<float>()(key.at.u), 0) ^ std::hash<float>()(key.at.v), 0);
        }
    };

    /// Returns a bound of the number of added elements: four per division, which adds at least six triangles.
    static std::size_t capacity(const VertexOptions& options) {
        return 2 * static_cast<std::size_t>(options.max_triangles) + 4;
    }

    bool is_triangle(ElementIndex e) const { return forest_->geometry(forest_->patch(e)).is_triangle(); }
    float edge(ElementIndex e) const { return edges_[forest_->patch(e)] * std::abs(forest_->cell(e).size); }

    /// Returns the first child, or `none` at the limit of triangles or elements.
    ElementIndex divide(ElementIndex e, double max_triangles) {
        // Mean number of added triangles, including fans in neighbours, measured in furnished rooms
        const double added = is_triangle(e) ? 6 : 9.5;
        if (triangles_ + added > max_triangles) return no_element;
        const ElementIndex child = forest_->subdivide(e);
        if (child != none) triangles_ += added;
        return child;
    }

    /// Divides elements with long edges, the longest first. Returns the leaves of shown patches.
    std::vector<ElementIndex> divide_long_edges() {
        // The other half is for badly interpolated elements
        const double half_of_triangles = options_.max_triangles / 2.0;
        std::priority_queue<std::pair<float, ElementIndex>> longest;
        const auto add = [&](ElementIndex e) {
            if (edge(e) > options_.max_edge) longest.emplace(edge(e), e);
        };
        for (PatchIndex p{0}; p < forest_->patch_count(); ++p)
            if (shown_[p]) add(p);
        while (!longest.empty()) {
            const ElementIndex child = divide(longest.top().second, half_of_triangles);
            if (child == none) break;
            longest.pop();
            for (std::uint32_t k = 0; k < 4; ++k) add(child + k);
        }
        std::vector<ElementIndex> leaves = forest_->leaves();
        std::erase_if(leaves, [&](ElementIndex e) { return !shown_[forest_->patch(e)]; });
        return leaves;
    }

    /// Divides the leaves that are interpolated badly. Returns their children.
    std::vector<ElementIndex> divide_badly_interpolated(const std::vector<ElementIndex>& leaves,
                                                        const Monitor& monitor) {
        std::vector<ElementIndex> tested;
        for (const ElementIndex e : leaves)
            if (edge(e) > options_.min_edge) tested.push_back(e);
        // Few samples preselect leaves that may be interpolated badly. Many samples separate errors from noise.
        constexpr int few = 16, many = 64;
        constexpr double deviations = 2;
        find_direct_light(tested, few, monitor_section(monitor, 0, 0.5));
        std::erase_if(tested, [&](ElementIndex e) { return !(error_of(e, deviations) > options_.max_error); });
        find_direct_light(tested, many, monitor_section(monitor, 0.5, 1));
        std::vector<std::pair<double, ElementIndex>> worst;  // error times area
        for (const ElementIndex e : tested)
            if (const double error = error_of(e, deviations); error > options_.max_error)
                worst.emplace_back(error * forest_->area(e), e);
        std::sort(worst.begin(), worst.end(), [](const auto& a, const auto& b) {
            return a.first > b.first || (a.first == b.first && a.second < b.second);
        });
        std::vector<ElementIndex> children;
        for (const auto& [error, e] : worst) {
            const ElementIndex child = divide(e, options_.max_triangles);
            if (child == none) continue;
            for (std::uint32_t k = 0; k < 4; ++k) children.push_back(child + k);
        }
        return children;
    }

    void find_direct_light(const std::vector<ElementIndex>& leaves, int max_samples, const Monitor& monitor) {
        std::vector<BakedPoint> points;
        known_.clear();
        for (const ElementIndex e : leaves) {
            const Cell cell = forest_->cell(e);
            const PatchIndex patch = forest_->patch(e);
            const auto add = [&](const Parameters& local) {
                const Parameters at = cell.at(local.u, local.v);
                if (known_.try_emplace({patch, at}, points.size()).second)
                    points.push_back({patch, at, sides_of(forest_->geometry(patch), spacing_of(options_))});
            };
            for (const Parameters& corner : corners_of(is_triangle(e))) add(corner);
            for (const Middle& middle : middles_of(is_triangle(e))) add(middle.at);
        }
        direct_ = light_.direct(points, max_samples, monitor);
    }

    /// Returns direct light at a point of an element; the emission of textures counts as direct light.
    SampledIrradiance direct_at(ElementIndex e, Parameters local) const {
        const PatchIndex patch = forest_->patch(e);
        const Parameters at = forest_->cell(e).at(local.u, local.v);
        SampledIrradiance light = direct_[known_.at({patch, at})];
        light.irradiance += exitance_at(scene_, scene_.patches[patch], at);
        return light;
    }

    /// Returns the largest error of interpolation, reduced by the given number of standard deviations, relative to the
    /// irradiance there or, if it is larger, the mean irradiance.
    double error_of(ElementIndex e, double deviations) const {
        double largest = 0;
        const std::span<const Parameters> corners = corners_of(is_triangle(e));
        for (const auto& [first, second, at] : middles_of(is_triangle(e))) {
            const SampledIrradiance a = direct_at(e, corners[first]), b = direct_at(e, corners[second]),
                                    middle = direct_at(e, at);
            const Rgb error = middle.irradiance - 0.5f * (a.irradiance + b.irradiance);
            const double size = (std::abs(error.x) + std::abs(error.y) + std::abs(error.z)) / 3.0;
            const double noise = std::sqrt(middle.squared_error + 0.25 * (a.squared_error + b.squared_error));
            const double total =
                mean_channel(light_.interpolated({forest_->patch(e), forest_->cell(e).at(at.u, at.v), {}}));
            const double scale = std::max({total, mean_channel(middle.irradiance), mean_});
            if (scale > 0) largest = std::max(largest, (size - deviations * noise) / scale);
        }
        return largest;
    }

    const Scene& scene_;
    const BakedLight& light_;
    const std::vector<bool>& shown_;
    const double mean_;
    const VertexOptions& options_;
    std::shared_ptr<ElementForest> forest_;
    std::vector<float> edges_;                             // longest edge of each patch [m]
    double triangles_ = 0;                                 // approximate number of triangles
    std::unordered_map<Key, std::size_t, KeyHash> known_;  // index of each point in direct_
    std::vector<SampledIrradiance> direct_;
};

/// Points for which light is computed: one per vertex, on its first shown patch.
class VertexPoints {
  public:
    VertexPoints(const ElementForest& forest, const ElementVertices& vertices, const std::vector<bool>& shown,
                 const VertexOptions& options)
        : numbers_(vertices.count(), none) {
        for (const ElementIndex e : forest.leaves()) {
            const PatchIndex patch = forest.patch(e);
            if (!shown[patch]) continue;
            const PatchGeometry& geometry = forest.geometry(patch);
            for (std::size_t c = 0; c < (geometry.is_triangle() ? 3u : 4u); ++c) {
                std::uint32_t& number = numbers_[vertices.corners(e)[c]];
                if (number != none) continue;
                number = static_cast<std::uint32_t>(points_.size());
                const Parameters local = corners_of(geometry.is_triangle())[c];
                points_.push_back(
                    {patch, forest.cell(e).at(local.u, local.v), sides_of(geometry, spacing_of(options))});
            }
        }
    }

    const std::vector<BakedPoint>& points() const { return points_; }
    /// Returns the index of a vertex's point; `none` if all its patches are hidden.
    std::uint32_t number(std::uint32_t vertex) const { return numbers_[vertex]; }

  private:
    std::vector<BakedPoint> points_;
    std::vector<std::uint32_t> numbers_;
};

}  // namespace

VertexLight make_vertex_light(const Scene& scene, const Solution& solution, const ExportOptions& options) {
    std::vector<bool> shown = shown_patches(scene, solution);
    if (options.bake.shading == Shading::smooth)
        return {solution.forest, ElementMesh(scene, *solution.forest, solution.irradiance), std::move(shown)};
    constexpr DirectSampling vertex_sampling{&DefaultSamples::vertex, 1e-3, /*calls_direct=*/true};
    const BakedLight light(scene, solution, options.bake, vertex_sampling);
    constexpr double share_of_division = 0.4;  // rough share of the time, for progress reports
    Division division(scene, light, shown, mean_irradiance(solution, shown), options.vertices);
    const auto forest = division.run(monitor_section(options.monitor, 0, share_of_division));
    ElementVertices vertices(scene, *forest);
    const VertexPoints points(*forest, vertices, shown, options.vertices);
    const std::vector<Rgb> irradiance =
        light.irradiance(points.points(), {}, monitor_section(options.monitor, share_of_division, 1));
    std::vector<std::optional<Rgb>> at_points(vertices.count());
    for (std::uint32_t v = 0; v < vertices.count(); ++v)
        if (const std::uint32_t i = points.number(v); i != none) at_points[v] = irradiance[i];
    std::vector<Rgb> values = joined_values(vertices, at_points);
    return {forest, ElementMesh(scene, *forest, std::move(vertices), std::move(values)), std::move(shown)};
}

}  // namespace interflect::detail
