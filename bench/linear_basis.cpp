// Errors of constant and linear elements that are computed from the same rays (docs/results.md, Linear basis
// functions):
//
//     build/release/bin/linear_basis SOLUTION.h5 EDGE FINER SEEDS REFERENCE_RAYS RAYS... > ROWS.csv
//     build/release/bin/linear_basis SOLUTION.h5 EDGE FINER RAYS LEVEL OUT.h5
//
// The first form reads the scene and the views from the solution file. Each run of ihsrr stores its light on a uniform
// mesh of cells. Their edges have at most EDGE metres on visible patches, and are up to 2^FINER times smaller on
// patches that the program divides further. All bases and meshes of larger elements are computed from these cells. The
// second form writes the light of one run on elements of 2^LEVEL cells and prints its errors, for comparison with
// pictures.

#include <interflect/interflect.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "interflect/base/parallel.h"
#include "interflect/elements/forest.h"
#include "interflect/render/smooth/element_vertices.h"
#include "interflect/render/smooth/vertex_values.h"
#include "interflect/solver/run.h"

namespace {

using namespace interflect;
using namespace interflect::detail;

constexpr std::size_t references = 4;  // two for the choice of a mesh, two for its error
constexpr float edge_ratio_of_invisible = 8;
/// Squared errors over the square of the picture's mean, or of the light at the place.
constexpr std::array measures{"", " relative"};
constexpr std::array methods_of_sources{"isrr", "ihsrr"};  // isrr has no StartPoints

struct Input {
    std::shared_ptr<const Scene> scene;
    std::shared_ptr<const RayCaster> ray_caster;
    std::vector<WeightedView> views;

    std::unique_ptr<Run> run(std::int64_t rays, std::uint64_t seed, std::size_t max_elements) const {
        SolveOptions options{.method = find_method("ihsrr")};
        options.views = views;
        options.seed = seed;
        options.limits.rays = rays;
        options.refinement.max_elements = max_elements;
        return std::make_unique<Run>(scene, ray_caster, options);
    }
};

void trace(Run& run, std::int64_t rays) {
    run.state.solution.options.limits.rays = rays;
    run.state.schedule.set_limits(run.state.options.limits);
    run.state.begin_work({});
    iterate_until(run, {.rays = rays - run.state.schedule.rays()});
    run.state.end_work();
}

/// Divides elements, parents first, and returns the number of elements.
template <class Divides>
std::uint32_t divide(ElementForest& forest, const Divides& divides) {
    for (std::uint32_t e = 0; e < forest.size(); ++e)
        if (divides(e)) forest.subdivide(e);
    forest.put_in_order(forest.patch_count());
    return forest.size();
}

/// Uniform mesh of cells, by patch, with the weights of the errors.
struct Cells {
    std::unique_ptr<ElementForest> forest;
    std::vector<int> depth;                     // by patch: number of divisions
    std::vector<std::uint32_t> leaves;          // elements of the forest
    std::vector<std::array<double, 2>> weight;  // by leaf and measure
    std::vector<Parameters> centre;
};

/// Returns the number of divisions of each patch that make its edges shorter than `edge` [m]; up to three more on
/// visible patches that the program divides further.
std::vector<int> depths(const Input& input, float edge, int finer) {
    constexpr std::int64_t rays = 2'000'000;
    const std::unique_ptr<Run> run = input.run(rays, 1, std::size_t{1} << 22);
    if (finer > 0) trace(*run, rays);
    const ElementForest& forest = *run->state.forest;
    std::vector<int> deepest(forest.patch_count(), 0);
    for (std::uint32_t e = 0; e < forest.size(); ++e)
        deepest[forest.patch(e)] = std::max(deepest[forest.patch(e)], forest.level(e));
    std::vector<int> depths;
    for (std::uint32_t p = 0; p < forest.patch_count(); ++p) {
        const PatchGeometry& geometry = forest.geometry(p);
        const std::span<const Parameters> corners = corners_of(geometry.is_triangle());
        float longest = 0;
        for (std::size_t c = 0; c < corners.size(); ++c)
            longest = std::max(
                longest, (geometry.point(corners[(c + 1) % corners.size()]) - geometry.point(corners[c])).length());
        const auto divisions = [&](float e) {
            return std::max(0, static_cast<int>(std::ceil(std::log2(longest / e))));
        };
        const bool is_visible = run->state.solution.view_importance[p] > 0;
        depths.push_back(is_visible ? std::clamp(deepest[p], divisions(edge), divisions(edge) + finer)
                                    : divisions(edge_ratio_of_invisible * edge));
    }
    return depths;
}

std::size_t element_count(const std::vector<int>& depths) {
    std::size_t count = 0;
    for (const int depth : depths) count += ((std::size_t{4} << (2 * depth)) - 1) / 3;
    return count;
}

/// Starts a run on a mesh that it cannot refine further.
std::unique_ptr<Run> run_on_mesh(const Input& input, std::int64_t rays, std::uint64_t seed,
                                 const std::vector<int>& depths) {
    std::unique_ptr<Run> run = input.run(rays, seed, element_count(depths));
    ElementForest& forest = *run->state.forest;
    divide(forest, [&](std::uint32_t e) { return forest.level(e) < depths[forest.patch(e)]; });
    grow_with_forest(run->state, forest.patch_count());
    return run;
}

/// Luminance of reflected light, by element; inner elements have the mean of their children.
struct Light {
    std::vector<float> mean;      // unbiased
    std::vector<float> reduced;   // with the program's shrinkage
    std::vector<float> variance;  // noise of the difference from the parent
};

float reflected(const SolverState& state, const std::vector<Rgb>& irradiance, std::uint32_t e) {
    return luminance(Rgb(state.materials.reflectance(state.forest->patch(e)) * irradiance[e]));
}

Light light_of(Run& run) {
    const SolverState& state = run.state;
    const std::vector<Rgb>&raw = state.solution.irradiance, reduced = run.snapshot().irradiance;
    Light light;
    for (std::uint32_t e = 0; e < state.forest->size(); ++e) {
        light.mean.push_back(reflected(state, raw, e));
        light.reduced.push_back(reflected(state, reduced, e));
        const float all = luminance(raw[e]), factor = all > 0 ? light.mean[e] / all : 0;
        light.variance.push_back(factor * factor * state.noise.variance(*state.forest, raw, e, state.history[e]));
    }
    return light;
}

/// Orthonormal basis of an element in its local parameters, over their uniform distribution; 1, linear and bilinear on
/// quadrilaterals, 1 and linear on triangles.
std::array<float, 4> basis(bool is_triangle, float s, float t) {
    if (is_triangle) return {1, std::sqrt(18.0f) * (s - 1.0f / 3), std::sqrt(6.0f) * (s + 2 * t - 1), 0};
    const float u = std::sqrt(3.0f) * (2 * s - 1), v = std::sqrt(3.0f) * (2 * t - 1);
    return {1, u, v, u * v};
}

/// Coefficients of `basis`, by element.
using Coefficients = std::vector<std::array<float, 4>>;

Coefficients constants(const std::vector<float>& values) {
    Coefficients c(values.size());
    for (std::size_t e = 0; e < c.size(); ++e) c[e] = {values[e], 0, 0, 0};
    return c;
}

/// Projects the means of cells onto the basis of each element above them.
Coefficients linear(const Cells& cells, const std::vector<float>& mean) {
    const ElementForest& forest = *cells.forest;
    Coefficients c(mean.size(), {0, 0, 0, 0});
    for (std::size_t i = 0; i < cells.leaves.size(); ++i) {
        const std::uint32_t leaf = cells.leaves[i], patch = forest.patch(leaf);
        const bool is_triangle = forest.geometry(patch).is_triangle();
        const Parameters p = cells.centre[i];
        Cell cell;
        for (std::uint32_t e = patch; e != leaf;) {
            const std::array<float, 4> value =
                basis(is_triangle, (p.u - cell.u) / cell.size, (p.v - cell.v) / cell.size);
            for (std::size_t k = 1; k < 4; ++k) c[e][k] += value[k] * mean[leaf];
            const unsigned child = cell.child_at(p, is_triangle);
            cell = cell.child(child, is_triangle);
            e = forest.first_child(e) + child;
        }
    }
    for (std::uint32_t e = 0; e < c.size(); ++e) {
        c[e][0] = mean[e];
        const int levels = cells.depth[forest.patch(e)] - forest.level(e);
        if (levels == 0) continue;
        const float count = std::exp2(2.0f * static_cast<float>(levels)),
                    square = 1 - 1 / count;  // of a linear function at the cells
        for (std::size_t k = 1; k < 4; ++k) c[e][k] /= count * (k == 3 ? square * square : square);
    }
    return c;
}

/// Reduces the slopes of four siblings by the common factor 1 - noise / (their mean square), as the program reduces
/// constants, and replaces constants by the program's reduced ones.
Coefficients reduced(const Cells& cells, const Light& light, Coefficients c) {
    const ElementForest& forest = *cells.forest;
    const auto reduce = [&](std::uint32_t first, std::uint32_t count) {
        double squares = 0, noise = 0;
        for (std::uint32_t e = first; e < first + count; ++e) {
            if (forest.is_leaf(e)) return;
            for (std::size_t k = 1; k < 4; ++k) squares += c[e][k] * c[e][k];
            for (std::uint32_t k = 0; k < 4; ++k) noise += light.variance[forest.first_child(e) + k] / 4;
        }
        const float kept = squares > noise ? static_cast<float>(1 - noise / squares) : 0;
        for (std::uint32_t e = first; e < first + count; ++e)
            for (std::size_t k = 1; k < 4; ++k) c[e][k] *= kept;
    };
    for (std::uint32_t p = 0; p < forest.patch_count(); ++p) reduce(p, 1);
    for (std::uint32_t e = forest.patch_count(); e < forest.size(); e += 4) reduce(e, 4);
    for (std::size_t e = 0; e < c.size(); ++e) c[e][0] = light.reduced[e];
    return c;
}

/// Mesh of elements that consist of cells.
struct Mesh {
    std::unique_ptr<ElementForest> forest;
    std::vector<std::uint32_t> element;  // of the forest of cells, by element of this forest
    std::vector<std::uint32_t> leaf;     // by cell
    std::vector<Cell> cell;              // by element of this forest
    std::vector<std::uint32_t> visible;  // leaves that the pictures show
    std::unique_ptr<ElementVertices> vertices;
};

/// @param divides  Whether an element of the forest of cells is divided.
Mesh make_mesh(const Scene& scene, const Cells& cells, const std::function<bool(std::uint32_t)>& divides) {
    Mesh mesh;
    mesh.forest = std::make_unique<ElementForest>(scene, cells.forest->size());
    for (std::uint32_t p = 0; p < cells.forest->patch_count(); ++p) mesh.element.push_back(p);
    for (std::uint32_t e = 0; e < mesh.forest->size(); ++e) {
        const std::uint32_t of_cells = mesh.element[e], first = cells.forest->first_child(of_cells);
        if (first == none || !divides(of_cells)) continue;
        mesh.forest->subdivide(e);
        for (std::uint32_t k = 0; k < 4; ++k) mesh.element.push_back(first + k);
    }
    std::vector<std::uint32_t> owner(cells.forest->size(), none);
    for (std::uint32_t e = 0; e < mesh.forest->size(); ++e)
        if (mesh.forest->is_leaf(e)) owner[mesh.element[e]] = e;
    for (std::uint32_t e = cells.forest->patch_count(); e < owner.size(); ++e)
        if (const std::uint32_t of_parent = owner[cells.forest->parent(e)]; of_parent != none) owner[e] = of_parent;
    std::vector<bool> is_visible(mesh.forest->size(), false);
    for (std::size_t i = 0; i < cells.leaves.size(); ++i) {
        mesh.leaf.push_back(owner[cells.leaves[i]]);
        if (cells.weight[i][0] > 0) is_visible[mesh.leaf[i]] = true;
    }
    for (std::uint32_t e = 0; e < mesh.forest->size(); ++e) {
        mesh.cell.push_back(mesh.forest->cell(e));
        if (is_visible[e]) mesh.visible.push_back(e);
    }
    mesh.vertices = std::make_unique<ElementVertices>(scene, *mesh.forest);
    return mesh;
}

Mesh uniform_mesh(const Scene& scene, const Cells& cells, int level) {
    const ElementForest& forest = *cells.forest;
    return make_mesh(scene, cells,
                     [&, level](std::uint32_t e) { return forest.level(e) < cells.depth[forest.patch(e)] - level; });
}

float value(const std::array<float, 4>& c, bool is_triangle, float s, float t) {
    const std::array<float, 4> b = basis(is_triangle, s, t);
    return c[0] * b[0] + c[1] * b[1] + c[2] * b[2] + c[3] * b[3];
}

/// Returns the light at the centres of cells.
/// @param joined  Whether the values at a vertex are averaged over its elements and interpolated, as by smooth shading.
std::vector<float> reconstruct(const Cells& cells, const Mesh& mesh, const Coefficients& c, bool joined) {
    const ElementForest& forest = *mesh.forest;
    std::vector<Rgb> at_vertex;
    if (joined) {
        std::vector<float> sum(mesh.vertices->count()), area(mesh.vertices->count());
        for (std::uint32_t e = 0; e < forest.size(); ++e) {
            if (!forest.is_leaf(e)) continue;
            const auto& corners = mesh.vertices->corners(e);
            const std::span<const Parameters> at = corners_of(corners[3] == none);
            for (std::size_t k = 0; k < at.size(); ++k) {
                sum[corners[k]] += forest.area(e) * value(c[mesh.element[e]], corners[3] == none, at[k].u, at[k].v);
                area[corners[k]] += forest.area(e);
            }
        }
        std::vector<std::optional<Rgb>> means(sum.size());
        for (std::size_t v = 0; v < sum.size(); ++v)
            if (area[v] > 0) means[v] = Rgb(sum[v] / area[v]);
        at_vertex = joined_values(*mesh.vertices, means);
    }
    std::vector<float> light(cells.leaves.size());
    for (std::size_t i = 0; i < light.size(); ++i) {
        const std::uint32_t leaf = mesh.leaf[i];
        const Cell& cell = mesh.cell[leaf];
        const float s = (cells.centre[i].u - cell.u) / cell.size, t = (cells.centre[i].v - cell.v) / cell.size;
        const auto& corners = mesh.vertices->corners(leaf);
        const bool is_triangle = corners[3] == none;
        const auto corner = [&](std::size_t k) { return at_vertex[corners[k]].x; };
        if (!joined)
            light[i] = value(c[mesh.element[leaf]], is_triangle, s, t);
        else if (is_triangle)
            light[i] = corner(0) * (1 - s - t) + corner(1) * s + corner(2) * t;
        else
            light[i] = (corner(0) * (1 - s) + corner(1) * s) * (1 - t) + (corner(3) * (1 - s) + corner(2) * s) * t;
    }
    return light;
}

using Reference = std::array<std::vector<float>, references>;  // light by cell

/// Returns the error of a cell; unbiased, because two independent references are subtracted.
double square_error(const Reference& reference, std::size_t pair, std::size_t i, float light) {
    return static_cast<double>(light - reference[2 * pair][i]) * (light - reference[2 * pair + 1][i]);
}

std::array<double, 2> total_error(const Cells& cells, const Reference& reference, const std::vector<std::size_t>& pairs,
                                  const std::vector<float>& light) {
    std::array<double, 2> sum{0, 0};
    for (std::size_t i = 0; i < light.size(); ++i)
        for (const std::size_t pair : pairs)
            for (std::size_t m = 0; m < 2; ++m)
                sum[m] += cells.weight[i][m] * square_error(reference, pair, i, light[i]);
    for (double& s : sum) s /= static_cast<double>(pairs.size());
    return sum;
}

struct Candidate {
    const char* name;
    bool is_linear, is_reduced, is_joined;
};
/// Each constant is followed, four places later, by its linear counterpart.
constexpr std::array<Candidate, 8> candidates{{{"constant flat", false, false, false},
                                               {"constant smooth", false, false, true},
                                               {"constant flat reduced", false, true, false},
                                               {"constant smooth reduced", false, true, true},
                                               {"linear", true, false, false},
                                               {"linear joined", true, false, true},
                                               {"linear reduced", true, true, false},
                                               {"linear joined reduced", true, true, true}}};
/// Costs of a coefficient in the choice of quadtrees, over the error per coefficient of the best uniform mesh.
constexpr std::array costs{1.0 / 64, 1.0 / 16, 1.0 / 4, 1.0, 4.0};

struct Bench {
    Input input;
    Cells cells;
    Reference reference;
    std::vector<Mesh> uniform;  // by level

    void print(std::int64_t rays, std::size_t seed, const char* basis, const char* mesh, double parameter, int elements,
               int coefficients, const std::array<double, 2>& error) const {
        std::printf("%lld,%zu,%s,%s,%.4g,%d,%d,%.6g,%.6g\n", static_cast<long long>(rays), seed, basis, mesh, parameter,
                    elements, coefficients, error[0], error[1]);
    }
};

Cells make_cells(const Input& input, const std::vector<int>& depths) {
    Cells cells;
    cells.depth = depths;
    cells.forest = std::make_unique<ElementForest>(*input.scene, element_count(depths));
    ElementForest& forest = *cells.forest;
    divide(forest, [&](std::uint32_t e) { return forest.level(e) < depths[forest.patch(e)]; });
    cells.leaves = forest.leaves();
    for (const std::uint32_t leaf : cells.leaves)
        cells.centre.push_back(forest.cell(leaf).centre(forest.geometry(forest.patch(leaf)).is_triangle()));
    return cells;
}

/// Computes the references and the weights of the errors.
void trace_references(Bench& bench, std::int64_t rays) {
    constexpr std::uint64_t first_seed = 1001;
    Cells& cells = bench.cells;
    std::vector<float> around(cells.forest->size(), 0);
    std::vector<double> shown(cells.leaves.size(), 0);
    for (std::size_t r = 0; r < references; ++r) {
        const std::unique_ptr<Run> run = run_on_mesh(bench.input, rays, first_seed + r, cells.depth);
        trace(*run, rays);
        const std::vector<Rgb>& irradiance = run->state.solution.irradiance;
        for (std::uint32_t e = 0; e < around.size(); ++e)
            around[e] += reflected(run->state, irradiance, e) / references;
        for (std::size_t i = 0; i < shown.size(); ++i) {
            const std::uint32_t e = cells.leaves[i];
            bench.reference[r].push_back(reflected(run->state, irradiance, e));
            shown[i] +=
                static_cast<double>(run->state.solution.view_importance[e]) * cells.forest->area(e) / references;
        }
        std::fprintf(stderr, "reference %zu: %.0f s\n", r + 1, run->state.earlier_seconds);
    }
    double mean = 0, all = 0;
    for (std::size_t i = 0; i < shown.size(); ++i) mean += shown[i] * around[cells.leaves[i]], all += shown[i];
    mean /= all;
    for (std::size_t i = 0; i < shown.size(); ++i) {
        std::uint32_t e = cells.leaves[i];  // the light of 16 cells has little noise
        for (int up = 0; up < 2 && e >= cells.forest->patch_count(); ++up) e = cells.forest->parent(e);
        const double local = around[e];
        cells.weight.push_back({shown[i] / all / (mean * mean), shown[i] / all / (local * local + 1e-4 * mean * mean)});
    }
}

/// Sums the mean error of seeds by element of a mesh, for the choice of meshes.
void add_element_errors(const Bench& bench, const Mesh& mesh, std::size_t pair, const std::vector<float>& light,
                        double share, std::array<std::vector<double>, measures.size()>& error) {
    for (std::size_t i = 0; i < light.size(); ++i)
        for (std::size_t m = 0; m < measures.size(); ++m)
            error[m][mesh.element[mesh.leaf[i]]] +=
                share * bench.cells.weight[i][m] * square_error(bench.reference, pair, i, light[i]);
}

/// Number of coefficients of an element of the forest of cells.
int coefficient_count(const Cells& cells, bool is_linear, std::uint32_t e) {
    if (!is_linear || cells.forest->is_leaf(e)) return 1;
    return cells.forest->geometry(cells.forest->patch(e)).is_triangle() ? 3 : 4;
}

/// Errors of one basis by half of the seeds and of the references, by measure and element, each in its uniform mesh.
struct ElementErrors {
    std::array<std::array<std::vector<double>, measures.size()>, 2> of_half;
    std::array<double, measures.size()> cost;  // error per coefficient of the best uniform mesh
};
/// Measure and half that choose a mesh.
struct Selection {
    std::size_t measure, half;

    const std::vector<double>& of(const ElementErrors& errors) const { return errors.of_half[half][measure]; }
};

/// Quadtree whose leaves choose among bases.
struct Quadtree {
    std::vector<std::uint8_t> divides, choice;  // by element of the forest of cells
};

/// Finds the quadtree of least error + cost times coefficients (dynamic programming from the cells up).
Quadtree best_quadtree(const Cells& cells, std::span<const Candidate> bases, std::span<const ElementErrors> errors,
                       const Selection& selection, double cost) {
    const ElementForest& forest = *cells.forest;
    std::vector<double> best(forest.size(), std::numeric_limits<double>::infinity());
    Quadtree tree{std::vector<std::uint8_t>(forest.size(), 0), std::vector<std::uint8_t>(forest.size(), 0)};
    for (std::uint32_t e = forest.size(); e-- > 0;) {
        for (std::size_t k = 0; k < bases.size(); ++k) {
            const double with = selection.of(errors[k])[e] + cost * coefficient_count(cells, bases[k].is_linear, e);
            if (with < best[e]) best[e] = with, tree.choice[e] = static_cast<std::uint8_t>(k);
        }
        const std::uint32_t first = forest.first_child(e);
        if (first == none) continue;
        const double children = best[first] + best[first + 1] + best[first + 2] + best[first + 3];
        if (children < best[e]) best[e] = children, tree.divides[e] = 1;
    }
    return tree;
}

/// Finds the uniform level and the basis of least error for each patch.
Quadtree best_patches(const Cells& cells, std::span<const ElementErrors> errors, const Selection& selection) {
    const ElementForest& forest = *cells.forest;
    struct Choice {
        int depth = 0;
        std::size_t basis = 0;
        double error = std::numeric_limits<double>::infinity();
    };
    std::vector<Choice> best(forest.patch_count());
    for (std::size_t k = 0; k < errors.size(); ++k) {
        std::vector<std::vector<double>> by_depth(forest.patch_count());
        for (std::uint32_t p = 0; p < by_depth.size(); ++p)
            by_depth[p].assign(static_cast<std::size_t>(cells.depth[p]) + 1, 0);
        for (std::uint32_t e = 0; e < forest.size(); ++e)
            by_depth[forest.patch(e)][static_cast<std::size_t>(forest.level(e))] += selection.of(errors[k])[e];
        for (std::uint32_t p = 0; p < by_depth.size(); ++p)
            for (std::size_t depth = 0; depth < by_depth[p].size(); ++depth)
                if (by_depth[p][depth] < best[p].error) best[p] = {static_cast<int>(depth), k, by_depth[p][depth]};
    }
    Quadtree tree{std::vector<std::uint8_t>(forest.size()), std::vector<std::uint8_t>(forest.size())};
    for (std::uint32_t e = 0; e < forest.size(); ++e) {
        tree.divides[e] = forest.level(e) < best[forest.patch(e)].depth;
        tree.choice[e] = static_cast<std::uint8_t>(best[forest.patch(e)].basis);
    }
    return tree;
}

/// Number of generations below each element of `forest`, and 0 for elements that it lacks.
std::vector<int> heights(const Cells& cells, const ElementForest& forest) {
    std::vector<int> below(forest.size(), 0), height(cells.forest->size(), 0);
    for (std::uint32_t e = forest.size(); e-- > forest.patch_count();)
        below[forest.parent(e)] = std::max(below[forest.parent(e)], below[e] + 1);
    std::vector<std::uint32_t> same(cells.forest->size(), none);
    for (std::uint32_t e = 0; e < same.size(); ++e) {
        if (e < forest.patch_count())
            same[e] = e;
        else if (const std::uint32_t parent = same[cells.forest->parent(e)]; parent != none && !forest.is_leaf(parent))
            same[e] = forest.first_child(parent) + (e - forest.patch_count()) % 4;
        height[e] = same[e] == none ? 0 : below[same[e]];
    }
    return height;
}

/// Coefficients of all candidates from one run.
std::array<Coefficients, 4> coefficients_of(const Cells& cells, const Light& light) {
    Coefficients fitted = linear(cells, light.mean);
    Coefficients reduced_fit = reduced(cells, light, fitted);
    return {constants(light.mean), constants(light.reduced), std::move(fitted), std::move(reduced_fit)};
}
/// Runs with the same number of rays.
struct Comparison {
    const Bench& bench;
    std::int64_t rays;
    std::vector<std::array<Coefficients, 4>> coefficients;  // by seed

    std::size_t seeds() const { return coefficients.size(); }
    const Coefficients& of(const Candidate& candidate, std::size_t seed) const {
        return coefficients[seed][(candidate.is_linear ? 2 : 0) + (candidate.is_reduced ? 1 : 0)];
    }
    void print(const Candidate& candidate, const Mesh& mesh, const char* name, double parameter, std::size_t seed,
               const std::array<double, 2>& error) const {
        bench.print(rays, seed + 1, candidate.name, name, parameter, static_cast<int>(mesh.visible.size()),
                    count(candidate, mesh), error);
    }
    int count(const Candidate& candidate, const Mesh& mesh) const {
        int sum = 0;
        for (const std::uint32_t e : mesh.visible)
            sum += coefficient_count(bench.cells, candidate.is_linear, mesh.element[e]);
        return sum;
    }
};

/// Prints the errors on all uniform meshes. Returns the errors by element.
ElementErrors compare_uniform(const Comparison& of, const Candidate& candidate) {
    const Cells& cells = of.bench.cells;
    ElementErrors errors;
    for (auto& of_half : errors.of_half) of_half.fill(std::vector<double>(cells.forest->size(), 0));
    std::array<double, measures.size()> least;
    least.fill(std::numeric_limits<double>::infinity());
    for (std::size_t level = 0; level < of.bench.uniform.size(); ++level) {
        const Mesh& mesh = of.bench.uniform[level];
        std::vector<std::vector<float>> light(of.seeds());
        std::vector<std::array<double, 2>> error(of.seeds());
        parallel_for_ranges(of.seeds(), 1, [&](std::size_t s, std::size_t) {
            light[s] = reconstruct(cells, mesh, of.of(candidate, s), candidate.is_joined);
            error[s] = total_error(cells, of.bench.reference, {0, 1}, light[s]);
        });
        std::array<double, measures.size()> mean{};
        for (std::size_t s = 0; s < of.seeds(); ++s) {
            add_element_errors(of.bench, mesh, s % 2, light[s], 2.0 / static_cast<double>(of.seeds()),
                               errors.of_half[s % 2]);
            of.print(candidate, mesh, "uniform", static_cast<double>(level), s, error[s]);
            for (std::size_t m = 0; m < mean.size(); ++m) mean[m] += error[s][m] / static_cast<double>(of.seeds());
        }
        for (std::size_t m = 0; m < mean.size(); ++m)
            if (mean[m] < least[m]) least[m] = mean[m], errors.cost[m] = mean[m] / of.count(candidate, mesh);
    }
    return errors;
}

/// Prints the errors on a mesh that was chosen with the seeds and the references of `half`, by the others.
void print_chosen(const Comparison& of, const char* name, std::span<const Candidate> bases, const Quadtree& tree,
                  const std::string& kind, double cost, std::size_t half) {
    const Cells& cells = of.bench.cells;
    const Mesh mesh = make_mesh(*of.bench.input.scene, cells, [&](std::uint32_t e) { return tree.divides[e] != 0; });
    int count = 0;
    for (const std::uint32_t e : mesh.visible)
        count += coefficient_count(cells, bases[tree.choice[mesh.element[e]]].is_linear, mesh.element[e]);
    std::vector<std::array<double, 2>> error(of.seeds());
    parallel_for_ranges(of.seeds(), 1, [&](std::size_t s, std::size_t) {
        if (s % 2 == half) return;
        Coefficients chosen(cells.forest->size());
        for (std::size_t e = 0; e < chosen.size(); ++e) chosen[e] = of.of(bases[tree.choice[e]], s)[e];
        error[s] =
            total_error(cells, of.bench.reference, {1 - half}, reconstruct(cells, mesh, chosen, bases[0].is_joined));
    });
    for (std::size_t s = 1 - half; s < of.seeds(); s += 2)
        of.bench.print(of.rays, s + 1, name, kind.c_str(), cost, static_cast<int>(mesh.visible.size()), count,
                       error[s]);
}

/// Prints the errors on meshes that are chosen for the basis, or for the better of two in each element.
void compare_chosen(const Comparison& of, const char* name, std::span<const Candidate> bases,
                    std::span<const ElementErrors> errors) {
    const Cells& cells = of.bench.cells;
    for (std::size_t measure = 0; measure < measures.size(); ++measure)
        for (std::size_t half = 0; half < 2; ++half) {
            const Selection selection{measure, half};
            const auto print = [&](const Quadtree& tree, const char* kind, double cost) {
                print_chosen(of, name, bases, tree, std::string(kind) + measures[measure], cost, half);
            };
            print(best_patches(cells, errors, selection), "patches", 0);
            for (const double cost : costs)
                print(best_quadtree(cells, bases, errors, selection, cost * errors[0].cost[measure]), "quadtree", cost);
        }
}

/// Prints the errors on the program's meshes and on coarser ones.
/// @param forests  Of runs that refine, by seed.
void compare_on_program_meshes(const Comparison& of, const std::vector<std::shared_ptr<const ElementForest>>& forests) {
    const Cells& cells = of.bench.cells;
    for (std::size_t s = 0; s < of.seeds(); ++s) {
        const std::vector<int> height = heights(cells, *forests[s]);
        for (int coarser = 0; coarser < 4; ++coarser) {
            const Mesh mesh =
                make_mesh(*of.bench.input.scene, cells, [&](std::uint32_t e) { return height[e] > coarser; });
            for (const Candidate& candidate : candidates)
                of.print(candidate, mesh, "program", coarser, s,
                         total_error(cells, of.bench.reference, {0, 1},
                                     reconstruct(cells, mesh, of.of(candidate, s), candidate.is_joined)));
        }
    }
}

void compare(const Bench& bench, std::int64_t rays, const std::vector<Light>& lights,
             const std::vector<std::shared_ptr<const ElementForest>>& program_forests) {
    Comparison comparison{bench, rays, std::vector<std::array<Coefficients, 4>>(lights.size())};
    parallel_for_ranges(lights.size(), 1, [&](std::size_t s, std::size_t) {
        comparison.coefficients[s] = coefficients_of(bench.cells, lights[s]);
    });
    compare_on_program_meshes(comparison, program_forests);
    for (std::size_t k = 0; k < candidates.size() / 2; ++k) {
        const std::array<Candidate, 2> bases{candidates[k], candidates[k + candidates.size() / 2]};
        const std::array<ElementErrors, 2> errors{compare_uniform(comparison, bases[0]),
                                                  compare_uniform(comparison, bases[1])};
        for (std::size_t b = 0; b < 2; ++b)
            compare_chosen(comparison, bases[b].name, std::span(&bases[b], 1), std::span(&errors[b], 1));
        const std::string either =
            std::string("either") + (bases[0].is_joined ? " joined" : "") + (bases[0].is_reduced ? " reduced" : "");
        compare_chosen(comparison, either.c_str(), bases, errors);
        std::fflush(stdout);
    }
}

/// Prints the errors of the program's own solutions.
void print_program(const Bench& bench, std::int64_t rays, std::size_t seed, Run& run) {
    const Cells& cells = bench.cells;
    const Solution solution = run.snapshot();
    const ElementForest& forest = *solution.forest;
    const ElementVertices vertices(*bench.input.scene, forest);
    std::vector<Rgb> values;
    for (std::uint32_t e = 0; e < forest.size(); ++e)
        values.push_back(Rgb(reflected(run.state, solution.irradiance, e)));
    const std::vector<Rgb> at_vertex = vertex_values(forest, vertices, values);
    std::vector<float> flat, smooth;
    std::vector<bool> is_visible(forest.size(), false);
    for (std::size_t i = 0; i < cells.leaves.size(); ++i) {
        const Parameters p = cells.centre[i];
        const std::uint32_t leaf = forest.leaf_at(cells.forest->patch(cells.leaves[i]), p);
        const Cell cell = forest.cell(leaf);
        const float s = (p.u - cell.u) / cell.size, t = (p.v - cell.v) / cell.size;
        const auto& corners = vertices.corners(leaf);
        const auto corner = [&](std::size_t k) { return at_vertex[corners[k]].x; };
        flat.push_back(values[leaf].x);
        smooth.push_back(corners[3] == none ? corner(0) * (1 - s - t) + corner(1) * s + corner(2) * t
                                            : (corner(0) * (1 - s) + corner(1) * s) * (1 - t) +
                                                  (corner(3) * (1 - s) + corner(2) * s) * t);
        if (cells.weight[i][0] > 0) is_visible[leaf] = true;
    }
    const int elements = static_cast<int>(std::count(is_visible.begin(), is_visible.end(), true));
    bench.print(rays, seed, "constant flat reduced", "refined", 0, elements, elements,
                total_error(cells, bench.reference, {0, 1}, flat));
    bench.print(rays, seed, "constant smooth reduced", "refined", 0, elements, elements,
                total_error(cells, bench.reference, {0, 1}, smooth));
}

/// Prints the errors of element means on coarse meshes whose noise is negligible: of constant sources alone. Rays
/// start uniformly on the leaves (isrr) or, on leaves that would misplace light, where it was received (ihsrr).
/// @param forest  A mesh of the program; null: uniform.
void print_sources(const Bench& bench, std::int64_t rays, int level, const ElementForest* forest) {
    const Cells& cells = bench.cells;
    const std::vector<int> height = forest ? heights(cells, *forest) : std::vector<int>();
    const Mesh mesh = forest ? make_mesh(*bench.input.scene, cells, [&](std::uint32_t e) { return height[e] > 0; })
                             : uniform_mesh(*bench.input.scene, cells, level);
    for (const char* method : methods_of_sources) {
        std::array<std::vector<float>, 4> light;
        for (std::size_t r = 0; r < light.size(); ++r) {
            const std::unique_ptr<Run> run = bench.input.run(rays, 2001 + r, mesh.forest->size());
            ElementForest& own = *run->state.forest;
            divide(own, [&](std::uint32_t e) { return e < mesh.forest->size() && !mesh.forest->is_leaf(e); });
            grow_with_forest(run->state, own.patch_count());
            run->state.solution.options.method = find_method(method);
            trace(*run, rays);
            for (std::uint32_t e = 0; e < own.size(); ++e)
                light[r].push_back(reflected(run->state, run->state.solution.irradiance, e));
        }
        // Mean of each reference over the cells of an element.
        std::array<std::vector<double>, references> exact;
        std::vector<double> weight(mesh.forest->size(), 0);
        for (std::size_t r = 0; r < references; ++r) {
            exact[r].assign(mesh.forest->size(), 0);
            std::vector<double> area(mesh.forest->size(), 0);
            for (std::size_t i = 0; i < cells.leaves.size(); ++i) {
                const double a = cells.forest->area(cells.leaves[i]);
                exact[r][mesh.leaf[i]] += a * bench.reference[r][i], area[mesh.leaf[i]] += a;
                if (r == 0) weight[mesh.leaf[i]] += cells.weight[i][0];
            }
            for (std::size_t e = 0; e < area.size(); ++e)
                if (area[e] > 0) exact[r][e] /= area[e];
        }
        for (std::size_t pair = 0; pair < 2; ++pair) {
            double error = 0;
            for (std::uint32_t e = 0; e < mesh.forest->size(); ++e)
                error += weight[e] * (light[2 * pair][e] - exact[2 * pair][e]) *
                         (light[2 * pair + 1][e] - exact[2 * pair + 1][e]);
            const auto elements = static_cast<int>(mesh.visible.size());
            bench.print(rays, pair + 1, method, forest ? "sources refined" : "sources uniform", level, elements,
                        elements, {error, 0});
        }
    }
    std::fflush(stdout);
}

int write_level(const Input& input, float edge, int finer, std::int64_t rays, int level, const char* path) {
    Bench bench{input, make_cells(input, depths(input, edge, finer)), {}, {}};
    trace_references(bench, 32 * rays);
    const Cells& cells = bench.cells;
    const std::unique_ptr<Run> run = run_on_mesh(input, rays, 1, cells.depth);
    trace(*run, rays);
    const Light light = light_of(*run);
    Mesh mesh = uniform_mesh(*input.scene, cells, level);
    for (const Candidate& candidate : {candidates[0], candidates[1]})
        bench.print(rays, 1, candidate.name, "uniform", level, static_cast<int>(mesh.visible.size()),
                    static_cast<int>(mesh.visible.size()),
                    total_error(cells, bench.reference, {0, 1},
                                reconstruct(cells, mesh, constants(light.mean), candidate.is_joined)));
    Solution solution;
    solution.options = run->state.options;
    solution.emitted_power = run->state.solution.emitted_power;
    for (const std::uint32_t e : mesh.element) {
        const Rgb& h = run->state.solution.irradiance[e];  // noise may make it negative
        solution.irradiance.push_back({std::max(h.x, 0.0f), std::max(h.y, 0.0f), std::max(h.z, 0.0f)});
    }
    const std::vector<float> zeros(mesh.element.size(), 0);
    solution.view_importance = solution.indirect_importance = solution.standard_error = solution.discretisation_error =
        solution.rays = zeros;
    solution.iterations = run->state.solution.iterations;
    solution.forest = std::move(mesh.forest);
    write_solution(path, *input.scene, solution);
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 7)
        return std::fputs("usage: linear_basis SOLUTION.h5 EDGE FINER SEEDS REFERENCE_RAYS RAYS...\n", stderr), 64;
    SolvedScene solved = read_solution(argv[1]);
    Input input;
    input.scene = std::make_shared<const Scene>(std::move(solved.scene));
    input.ray_caster = std::make_shared<const RayCaster>(*input.scene);
    input.views = solved.solution.options.views;
    if (input.views.empty())
        for (const View& view : input.scene->views) input.views.push_back({view});
    const auto edge = static_cast<float>(std::atof(argv[2]));
    const int finer = std::atoi(argv[3]);
    if (argc == 7 && std::string(argv[6]).ends_with(".h5"))
        return write_level(input, edge, finer, std::atoll(argv[4]), std::atoi(argv[5]), argv[6]);

    Bench bench{input, make_cells(input, depths(input, edge, finer)), {}, {}};
    std::fprintf(stderr, "%zu cells\n", bench.cells.leaves.size());
    trace_references(bench, std::atoll(argv[5]));
    const int deepest = *std::max_element(bench.cells.depth.begin(), bench.cells.depth.end());
    for (int level = 0; level <= deepest; ++level)
        bench.uniform.push_back(uniform_mesh(*input.scene, bench.cells, level));
    std::puts("rays,seed,basis,mesh,parameter,elements,coefficients,error,relative_error");
    const std::span<char*> budgets(argv + 6, argv + argc);
    const std::int64_t most = std::atoll(budgets.back());
    std::vector<std::unique_ptr<Run>> runs, refining;
    const auto seeds = static_cast<std::size_t>(std::atoi(argv[4]));
    for (std::size_t s = 1; s <= seeds; ++s) {
        runs.push_back(run_on_mesh(input, std::atoll(budgets.front()), s, bench.cells.depth));
        refining.push_back(input.run(std::atoll(budgets.front()), s, std::size_t{1} << 22));
    }
    for (char* budget : budgets) {
        const std::int64_t rays = std::atoll(budget);
        std::vector<Light> lights;
        std::vector<std::shared_ptr<const ElementForest>> forests;
        for (std::size_t s = 0; s < seeds; ++s) {
            trace(*runs[s], rays), trace(*refining[s], rays);
            lights.push_back(light_of(*runs[s]));
            forests.push_back(refining[s]->state.forest);
            print_program(bench, rays, s + 1, *refining[s]);
        }
        std::fprintf(stderr, "%lld rays: traced %lld, refining %lld\n", static_cast<long long>(rays),
                     static_cast<long long>(runs[0]->state.schedule.rays()),
                     static_cast<long long>(refining[0]->state.schedule.rays()));
        compare(bench, rays, lights, forests);
    }
    for (int level = 4; level <= deepest; level += 2) print_sources(bench, most / 4, level, nullptr);
    print_sources(bench, most / 4, 0, refining[0]->state.forest.get());
}
