#include "tests/validation/cases/closed_forms.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace interflect::testing_support {

namespace {

using std::numbers::pi;

SkyLuminance over_ground(const SkyLuminance& sky, double ground) {
    return [=](const V3d& d) { return d.z > 0 ? sky(d) : ground; };
}

}  // namespace

double configuration_factor(const V3d& point, const V3d& normal, const std::vector<V3d>& polygon) {
    double sum = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const V3d a = polygon[i] - point, b = polygon[(i + 1) % polygon.size()] - point, across = a.cross(b);
        const double sine = across.length();
        if (sine > 0) sum += std::atan2(sine, a.dot(b)) / sine * across.dot(normal);
    }
    return sum / (2 * pi);
}

double disc_configuration_factor(double r, double h, double a) {
    const double z = h * h + a * a + r * r;
    return 0.5 * (1 - (h * h + a * a - r * r) / std::sqrt(z * z - 4 * a * a * r * r));
}

double corner_solid_angle(double a, double b, double h) {
    return std::atan2(a * b, h * std::sqrt(a * a + b * b + h * h));
}

std::vector<V3d> corners(const Rectangle& r) {
    return {r.corner, r.corner + r.u, r.corner + r.u + r.v, r.corner + r.v};
}

SkyLuminance uniform_sky(double illuminance, double ground) {
    return over_ground([=](const V3d&) { return illuminance / pi; }, ground);
}

SkyLuminance overcast_sky(double illuminance, double ground) {
    const double zenith = 9 * illuminance / (7 * pi);
    return over_ground([=](const V3d& d) { return zenith * (1 + 2 * d.z) / 3; }, ground);
}

SkyLuminance clear_sky(double illuminance, const V3d& sun, double ground) {
    const V3d towards_sun = sun.normalized();
    const SkyLuminance relative = [=](const V3d& d) {
        const double cosine = std::clamp(d.dot(towards_sun), -1.0, 1.0), chi = std::acos(cosine);
        return (1 - std::exp(-0.32 / d.z)) *
               (1 + 10 * (std::exp(-3 * chi) - std::exp(-3 * pi / 2)) + 0.45 * cosine * cosine);
    };
    constexpr int rows = 1000, columns = 1000;
    double sum = 0;
    for (int i = 0; i < rows; ++i)
        for (int k = 0; k < columns; ++k) {
            const double square = (i + 0.5) / rows, sine = std::sqrt(1 - square), turn = 2 * pi * (k + 0.5) / columns;
            sum += pi / (rows * columns) * relative({sine * std::cos(turn), sine * std::sin(turn), std::sqrt(square)});
        }
    return over_ground([=](const V3d& d) { return illuminance / sum * relative(d); }, ground);
}

double through_opening(const V3d& point, const V3d& normal, const Rectangle& opening, const SkyLuminance& luminance,
                       const std::function<bool(const V3d& place)>& is_visible) {
    constexpr int n = 600;
    double sum = 0;
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < n; ++k) {
            const V3d place = opening.corner + opening.u * ((i + 0.5) / n) + opening.v * ((k + 0.5) / n);
            if (is_visible && !is_visible(place)) continue;
            const V3d d = place - point;
            const double r2 = d.length2(), cosine = d.dot(normal), through = std::abs(d.dot(opening.normal()));
            if (cosine > 0) sum += luminance(d / std::sqrt(r2)) * cosine * through / (r2 * r2);
        }
    return sum * opening.area() / (n * n);
}

}  // namespace interflect::testing_support
