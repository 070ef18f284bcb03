#include "interflect/formats/build/scene_faces.h"

#include <ImathBox.h>

#include "interflect/formats/reading/read_fault.h"
#include "interflect/geometry/polygons/polygon.h"
#include "interflect/scene/core/limits.h"

namespace interflect::detail {

namespace {

/// Faces affect the origin if their doubled area / size^2 is at least this number.
constexpr double min_shape = 1e-6;

/// Largest width of a face that rounding may remove, relative to the scene's reach. Narrower slivers are common.
constexpr double largest_lost_width = 0x1p-16;

}  // namespace

void SceneFaces::require_room(double patches) const {
    if (static_cast<double>(scene_.patches.size() + left_out_) + patches > static_cast<double>(max_patches_))
        throw ReadFault(fmt::format("this would give more than {} patches (max_patches)", max_patches_), "max_patches");
}

V3f SceneFaces::position(const Imath::V3d& world) const {
    if (!is_within_reach(world) || !is_within_reach(world - scene_.origin))
        throw std::invalid_argument(
            fmt::format("the transformed point ({}, {}, {}) is farther than {:g} m from the origin, which is too far",
                        world.x, world.y, world.z, farthest_coordinate));
    return V3f(world - scene_.origin) + V3f(0);  // turns -0 into 0
}

void SceneFaces::place(std::span<const Imath::V3d> outline) {
    Imath::Box3d box;
    Imath::V3d doubled_area(0);
    for (std::size_t i = 0; i < outline.size(); ++i) {
        box.extendBy(outline[i]);
        if (i > 1) doubled_area += (outline[i - 1] - outline[0]).cross(outline[i] - outline[0]);
    }
    const double size = box.size().length();
    const double width = size > 0 ? doubled_area.length() / size : 0;
    placed_ = {width, box.center(), {}};
    if (width > min_shape * size && sample_.wants_next()) sample_.add({box.center(), size});
}

void SceneFaces::add(std::span<const std::vector<std::uint32_t>> loops, std::uint32_t material, std::uint32_t object,
                     bool two_sided, const Location& where) {
    require_room(two_sided ? 2 : 1);
    const std::size_t before = scene_.patches.size();
    const PolygonResult result = add_polygon(scene_, loops, material, object, two_sided);
    require_room(0);  // counts again, because a face may become several patches
    if (result == PolygonResult::self_crossing)
        leave_out(
            fmt::format("face whose outline crosses itself or runs back along itself, so that its areas cancel, or "
                        "crosses itself more than {} times per corner, is left out; split it",
                        max_crossings_per_corner),
            where);
    if (result == PolygonResult::degenerate) {
        leave_out("face without area is left out", where);
        if (placed_.width > lost_.width) lost_ = {placed_.width, placed_.centre, where};
    }
    for (std::size_t i = before; i < scene_.patches.size(); ++i)
        if (const std::string fault = patch_fault(scene_, scene_.patches[i]); !fault.empty())
            throw std::invalid_argument("this face " + fault);
}

void SceneFaces::leave_out(const std::string& message, const Location& where) {
    scene_.warnings.add("degenerate-face", message, where.text());
    if (left_out_++ == 0) first_left_out_ = {message, where};
}

void SceneFaces::require_precision() const {
    const Core core = core_of(sample_.faces());
    if (lost_.width <= largest_lost_width * core.reach) return;
    const Imath::V3d &x = lost_.centre, &middle = core.middle;
    throw lost_.where.error(
        fmt::format("this face, {:.3g} m wide at ({:.10g}, {:.10g}, {:.10g}), is lost to rounding: it is {:.3g} m from "
                    "the middle of the scene, ({:.10g}, {:.10g}, {:.10g}), and coordinates have seven digits",
                    lost_.width, x.x, x.y, x.z, (x - middle).length(), middle.x, middle.y, middle.z));
}

/// Uses the size of the unrounded faces if rounding removed all faces.
void SceneFaces::require_width() const {
    double width = scene_width(scene_);
    if (scene_.patches.empty()) {
        if (sample_.faces().empty()) return;
        const Core core = core_of(sample_.faces());
        width = 2 * core.reach;
    }
    if (const std::string fault = scene_width_fault(width); !fault.empty())
        throw InputError(scene_.name, 0, "the scene " + fault);
}

void SceneFaces::require_patches() const {
    if (!scene_.patches.empty()) return;
    if (left_out_ > 0)
        throw first_left_out_.where.error(
            fmt::format("no usable face is left: {} are left out, and this is the first of them: {}", left_out_,
                        first_left_out_.message));
    throw InputError(scene_.name, 0, "no usable face is left: the scene is empty");
}

void SceneFaces::require_usable() const {
    require_width();
    if (const std::string fault = brightness_fault(brightest_source(scene_)); !fault.empty())
        throw InputError(scene_.name, 0, "the scene " + fault);
    require_precision();
    require_patches();
}

}  // namespace interflect::detail
