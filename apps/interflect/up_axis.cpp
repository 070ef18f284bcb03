#include "apps/interflect/up_axis.h"

#include <cmath>

#include "interflect/geometry/patch_geometry.h"

namespace interflect::command {

namespace {

/// Least cosine between a direction and the axis that it stands for, and least share of what tells of one.
constexpr double least_cosine = 0.9, least_agreement = 0.5;

/// @param total  What the length of `sum` would be if all that it is the sum of had one direction.
const char* axis_of(const Imath::V3d& sum, double total) {
    constexpr const char* names[3][2] = {{"x", "-x"}, {"y", "-y"}, {"z", "-z"}};
    const double length = sum.length();
    if (!(length > least_agreement * total)) return nullptr;
    for (int i = 0; i < 3; ++i)
        if (std::abs(sum[i]) > least_cosine * length) return names[i][sum[i] < 0];
    return nullptr;
}

const char* axis_of_views(const Scene& scene) {
    Imath::V3d sum(0);
    for (const View& v : scene.views) sum += Imath::V3d(v.up).normalized();
    return axis_of(sum, static_cast<double>(scene.views.size()));
}

const char* axis_of_light(const Scene& scene) {
    Imath::V3d sum(0);
    double total = 0;
    for (const Patch& patch : scene.patches) {
        const double power = channel_sum(scene.materials[patch.material].exitance) * patch_area(scene, patch);
        sum -= power * Imath::V3d(PatchGeometry(scene, patch).normal());
        total += power;
    }
    return axis_of(sum, total);
}

}  // namespace

std::optional<UpAxis> find_up_axis(const Scene& scene) {
    if (const char* axis = axis_of_views(scene)) return UpAxis{axis, "views"};
    if (const char* axis = axis_of_light(scene)) return UpAxis{axis, "light"};
    return std::nullopt;
}

}  // namespace interflect::command
