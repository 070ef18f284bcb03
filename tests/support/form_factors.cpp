#include "tests/support/form_factors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

namespace interflect::testing_support {

namespace {

struct Interval {
    double low, high;
    double operator[](int i) const { return i == 0 ? low : high; }
};

Interval extent(const Rectangle& r, int axis) {
    const double a = r.corner[axis], b = a + r.u[axis] + r.v[axis];
    return {std::min(a, b), std::max(a, b)};
}

int normal_axis(const Rectangle& r) {
    const V3d n = r.normal();
    for (int axis = 0; axis < 3; ++axis)
        if (std::abs(n[axis]) == 1) return axis;
    throw std::logic_error("the rectangle is not perpendicular to an axis");
}

/// Returns the distance range of `interval` in front of the plane coordinate = `plane` that faces towards `sign`.
Interval in_front(const Interval& interval, double plane, double sign) {
    const double a = sign * (interval.low - plane), b = sign * (interval.high - plane);
    const Interval distance{std::min(a, b), std::max(a, b)};
    if (distance.low < 0 && distance.high > 0) throw std::logic_error("a rectangle crosses the plane of another");
    return distance;
}

/// Computes the sum over all choices of an end of each interval, with alternating signs.
template <class Function>
double corner_sum(const Interval& x, const Interval& y, const Interval& eta, const Interval& xi, const Function& g) {
    double sum = 0;
    for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j)
            for (int k = 0; k < 2; ++k)
                for (int l = 0; l < 2; ++l) sum += ((i + j + k + l) % 2 ? -1 : 1) * g(x[i], y[j], eta[k], xi[l]);
    return sum / (2 * std::numbers::pi);
}

double log_or_zero(double x) { return x > 0 ? std::log(x) : 0; }  // its factor is 0 if x is 0

/// Howell C-13: planes at distance z.
double parallel_corner(double x, double y, double eta, double xi, double z) {
    const double dx = x - xi, dy = y - eta, rx = std::hypot(dx, z), ry = std::hypot(dy, z);
    return dy * rx * std::atan2(dy, rx) + dx * ry * std::atan2(dx, ry) -
           0.5 * z * z * std::log(dx * dx + dy * dy + z * z);
}

/// Howell C-15: x and xi are distances from the intersection line of the planes.
double perpendicular_corner(double x, double y, double eta, double xi) {
    const double dy = y - eta, r2 = x * x + xi * xi, r = std::sqrt(r2);
    return dy * r * std::atan2(dy, r) - 0.25 * (r2 - dy * dy) * log_or_zero(r2 + dy * dy);
}

using Matrix = std::vector<std::vector<double>>;

/// Solves matrix X = right by Gaussian elimination with partial pivoting.
Matrix solve_linear(Matrix matrix, Matrix right) {
    const std::size_t n = matrix.size(), columns = right[0].size();
    for (std::size_t k = 0; k < n; ++k) {
        std::size_t pivot = k;
        for (std::size_t i = k + 1; i < n; ++i)
            if (std::abs(matrix[i][k]) > std::abs(matrix[pivot][k])) pivot = i;
        std::swap(matrix[k], matrix[pivot]);
        std::swap(right[k], right[pivot]);
        for (std::size_t i = k + 1; i < n; ++i) {
            const double factor = matrix[i][k] / matrix[k][k];
            for (std::size_t j = k; j < n; ++j) matrix[i][j] -= factor * matrix[k][j];
            for (std::size_t j = 0; j < columns; ++j) right[i][j] -= factor * right[k][j];
        }
    }
    for (std::size_t k = n; k-- > 0;)
        for (std::size_t j = 0; j < columns; ++j) {
            for (std::size_t i = k + 1; i < n; ++i) right[k][j] -= matrix[k][i] * right[i][j];
            right[k][j] /= matrix[k][k];
        }
    return right;
}

const Material& material_of(const Scene& scene, std::size_t patch) {
    return scene.materials[scene.patches[patch].material];
}

/// I - F rho for one channel.
Matrix transport_matrix(const Scene& scene, const FormFactors& f, int channel) {
    Matrix matrix(f.patches(), std::vector<double>(f.patches()));
    for (std::size_t i = 0; i < f.patches(); ++i)
        for (std::size_t j = 0; j < f.patches(); ++j)
            matrix[i][j] = (i == j ? 1.0 : 0.0) - f(i, j) * material_of(scene, j).reflectance[channel];
    return matrix;
}

}  // namespace

std::vector<Rectangle> rectangles_of(const Scene& scene) {
    std::vector<Rectangle> rectangles;
    for (const Patch& patch : scene.patches) {
        const auto vertex = [&](std::size_t k) { return V3d(scene.vertices[patch.vertices[k]]); };
        rectangles.push_back({vertex(0), vertex(1) - vertex(0), vertex(3) - vertex(0)});
    }
    return rectangles;
}

double FormFactors::row_sum(std::size_t from) const {
    double sum = 0;
    for (std::size_t to = 0; to < patches_; ++to) sum += (*this)(from, to);
    return sum;
}

double form_factor(const Rectangle& from, const Rectangle& to) {
    const int a = normal_axis(from), b = normal_axis(to);
    const Interval to_height = in_front(extent(to, a), from.corner[a], from.normal()[a]);
    const Interval from_height = in_front(extent(from, b), to.corner[b], to.normal()[b]);
    if (to_height.high <= 0 || from_height.high <= 0) return 0;
    if (a == b) {
        const int s = (a + 1) % 3, t = (a + 2) % 3;
        const double distance = to_height.low;
        return corner_sum(extent(from, s), extent(from, t), extent(to, t), extent(to, s),
                          [&](double x, double y, double eta, double xi) {
                              return parallel_corner(x, y, eta, xi, distance);
                          }) /
               from.area();
    }
    const int along = 3 - a - b;
    return corner_sum(from_height, extent(from, along), extent(to, along), to_height, perpendicular_corner) /
           from.area();
}

FormFactors exact_form_factors(const Scene& scene) {
    const std::vector<Rectangle> rectangles = rectangles_of(scene);
    FormFactors f(rectangles.size());
    for (std::size_t i = 0; i < rectangles.size(); ++i)
        for (std::size_t j = 0; j < rectangles.size(); ++j) f(i, j) = form_factor(rectangles[i], rectangles[j]);
    return f;
}

std::vector<RgbD> dense_irradiance(const Scene& scene, const FormFactors& f) {
    std::vector<RgbD> irradiance(f.patches());
    for (int channel = 0; channel < 3; ++channel) {
        Matrix right(f.patches(), std::vector<double>(1, 0.0));  // F M
        for (std::size_t i = 0; i < f.patches(); ++i)
            for (std::size_t j = 0; j < f.patches(); ++j)
                right[i][0] += f(i, j) * material_of(scene, j).exitance[channel];
        const Matrix solution = solve_linear(transport_matrix(scene, f, channel), right);
        for (std::size_t i = 0; i < f.patches(); ++i) irradiance[i][channel] = solution[i][0];
    }
    return irradiance;
}

std::vector<RgbD> dense_irradiance_error(const Scene& scene, const FormFactors& f, double rays_per_row) {
    const std::size_t n = f.patches();
    const std::vector<RgbD> irradiance = dense_irradiance(scene, f);
    std::vector<RgbD> error(n);
    for (int channel = 0; channel < 3; ++channel) {
        // Variance of row k of dF times B: B at the hits of `rays_per_row` rays that leave patch k.
        std::vector<double> row_variance(n);
        for (std::size_t k = 0; k < n; ++k) {
            double mean = 0, square = 0;
            for (std::size_t j = 0; j < n; ++j) {
                const Material& m = material_of(scene, j);
                const double radiosity = m.exitance[channel] + m.reflectance[channel] * irradiance[j][channel];
                mean += f(k, j) * radiosity;
                square += f(k, j) * radiosity * radiosity;
            }
            row_variance[k] = (square - mean * mean) / rays_per_row;
        }
        Matrix identity(n, std::vector<double>(n, 0.0));
        for (std::size_t i = 0; i < n; ++i) identity[i][i] = 1;
        const Matrix inverse = solve_linear(transport_matrix(scene, f, channel), identity);
        for (std::size_t i = 0; i < n; ++i) {
            double variance = 0;
            for (std::size_t k = 0; k < n; ++k) variance += inverse[i][k] * inverse[i][k] * row_variance[k];
            error[i][channel] = std::sqrt(variance);
        }
    }
    return error;
}

}  // namespace interflect::testing_support
