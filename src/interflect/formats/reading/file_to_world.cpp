#include "interflect/formats/reading/file_to_world.h"

namespace interflect::detail {

namespace {

using Imath::V3d;

/// The rotated directions of the axes.
struct Turn {
    V3d x, y, z;
};

/// Returns the rotation that turns `up` to z.
Turn turn(Axis up) {
    const V3d x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
    switch (up) {
        case Axis::x:
            return {z, y, -x};
        case Axis::minus_x:
            return {-z, y, x};
        case Axis::y:
            return {x, z, -y};
        case Axis::minus_y:
            return {x, -z, y};
        case Axis::minus_z:
            return {x, -y, -z};
        default:
            return {x, y, z};
    }
}

}  // namespace

Imath::M44d file_to_world(const ReadOptions& options) {
    const auto [x, y, z] = turn(options.up_axis);
    const double s = options.unit;
    return {s * x.x, s * x.y, s * x.z, 0, s * y.x, s * y.y, s * y.z, 0, s * z.x, s * z.y, s * z.z, 0, 0, 0, 0, 1};
}

}  // namespace interflect::detail
