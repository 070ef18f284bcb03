#include "interflect/render/smooth/vertex_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace interflect::detail {

namespace {

/// Returns the mean of each of the four basis functions over an element.
std::array<double, 4> basis_means(const PatchGeometry& patch, const Cell& cell) {
    if (patch.is_triangle()) return {1.0 / 3, 1.0 / 3, 1.0 / 3, 0};
    std::array<double, 4> jacobian{}, means{};
    double sum = 0;
    for (std::size_t c = 0; c < 4; ++c) {
        const auto [s, t] = square_corners[c];
        sum += jacobian[c] = std::max(0.0f, patch.jacobian(cell.at(s, t)));
    }
    // The Jacobian is bilinear. The integral of the product of the bilinear basis functions of two corners is 1/9 for
    // the same corner, 1/18 for neighbours and 1/36 for opposite corners; the area is the mean of the Jacobian, sum
    // / 4.
    for (std::size_t c = 0; c < 4; ++c) {
        const double beside = jacobian[(c + 1) % 4] + jacobian[(c + 3) % 4];
        means[c] = (4 * jacobian[c] + 2 * beside + jacobian[(c + 2) % 4]) / (9 * sum);
    }
    return means;
}

/// The linear map of joined_values(). Each of its results is a weighted mean of values.
class Joins {
  public:
    Joins(const ElementVertices& vertices, std::vector<bool> is_known)
        : vertices_(vertices), is_known_(std::move(is_known)) {}

    template <class Value>
    void apply(std::vector<Value>& values) const {
        const std::vector<Value> before = values;
        for (const ElementVertices::Coupling& c : vertices_.couplings())
            if (connects(c)) values[c.vertex] += (interpolated(before, c) - before[c.vertex]) * c.share;
        for (const ElementVertices::Hanging& h : vertices_.hanging())
            if (has_known_ends(h)) values[h.vertex] = interpolated(values, h);
    }

    template <class Value>
    void apply_transposed(std::vector<Value>& values) const {
        for (auto h = vertices_.hanging().rbegin(); h != vertices_.hanging().rend(); ++h)
            if (has_known_ends(*h)) distribute(std::exchange(values[h->vertex], Value(0)), *h, values);
        const std::vector<Value> before = values;
        for (const ElementVertices::Coupling& c : vertices_.couplings()) {
            if (!connects(c)) continue;
            const Value share = before[c.vertex] * c.share;
            values[c.vertex] -= share;
            distribute(share, c, values);
        }
    }

  private:
    bool has_known_ends(const auto& edge) const { return is_known_[edge.ends[0]] && is_known_[edge.ends[1]]; }
    bool connects(const ElementVertices::Coupling& c) const { return is_known_[c.vertex] && has_known_ends(c); }

    template <class Value>
    static Value interpolated(const std::vector<Value>& values, const auto& edge) {
        return values[edge.ends[0]] * (1 - edge.fraction) + values[edge.ends[1]] * edge.fraction;
    }
    template <class Value>
    static void distribute(const Value& value, const auto& edge, std::vector<Value>& values) {
        values[edge.ends[0]] += value * (1 - edge.fraction);
        values[edge.ends[1]] += value * edge.fraction;
    }

    const ElementVertices& vertices_;
    const std::vector<bool> is_known_;
};

}  // namespace

std::vector<Rgb> vertex_values(const ElementForest& forest, const ElementVertices& vertices,
                               std::span<const Rgb> irradiance) {
    if (irradiance.size() != forest.size())
        throw InputError(fmt::format("{} values, expected one for each of the forest's {} elements", irradiance.size(),
                                     forest.size()));
    std::vector<Rgb> values(irradiance.begin(), irradiance.end());
    vertices.normals().apply(forest, values);
    // Integrate the basis functions over each leaf, without and with its irradiance as factor
    std::vector<RgbD> power(vertices.count(), RgbD(0));
    std::vector<double> area(vertices.count(), 0.0);
    for (ElementIndex e{0}; e < forest.size(); ++e) {
        if (!forest.is_leaf(e)) continue;
        const PatchGeometry& patch = forest.geometry(forest.patch(e));
        const std::array<double, 4> means = basis_means(patch, forest.cell(e));
        for (std::size_t c = 0; c < corners_of(patch.is_triangle()).size(); ++c) {
            const double integral = means[c] * static_cast<double>(forest.area(e));
            power[vertices.corners(e)[c]] += RgbD(values[e]) * integral;
            area[vertices.corners(e)[c]] += integral;
        }
    }
    // Hanging vertices and seams extend the basis functions of other vertices, which receive their integrals
    const Joins joins(vertices, std::vector<bool>(vertices.count(), true));
    joins.apply_transposed(power);
    joins.apply_transposed(area);
    std::vector<Rgb> result(vertices.count(), Rgb(0));
    for (std::size_t v = 0; v < result.size(); ++v)
        if (area[v] > 0) result[v] = Rgb(power[v] / area[v]);
    joins.apply(result);
    return result;
}

std::vector<Rgb> joined_values(const ElementVertices& vertices, std::span<const std::optional<Rgb>> values) {
    std::vector<Rgb> result;
    std::vector<bool> is_known;
    for (const std::optional<Rgb>& value : values) {
        result.push_back(value.value_or(Rgb(0)));
        is_known.push_back(value.has_value());
    }
    Joins(vertices, std::move(is_known)).apply(result);
    return result;
}

}  // namespace interflect::detail
