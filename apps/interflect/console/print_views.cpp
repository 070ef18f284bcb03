#include "apps/interflect/console/print_views.h"

#include "apps/interflect/console/messages.h"

namespace interflect::command {

namespace {

/// Uses the fewest digits that identify a float, or ten digits for other numbers.
std::string text_of_coordinate(double x) {
    const auto single = static_cast<float>(x);
    return static_cast<double>(single) == x ? fmt::format("{}", single) : fmt::format("{:.10g}", x);
}

std::string text_of_point(const Imath::V3d& p) {
    return text_of_coordinate(p.x) + " " + text_of_coordinate(p.y) + " " + text_of_coordinate(p.z);
}

}  // namespace

void print_views(const std::vector<View>& views) {
    for (const View& v : views)
        print_line("  view      {}: eye {}, look at {}, up {}, fov {}", v.name, text_of_point(v.eye),
                   text_of_point(v.look_at), text_of_point(Imath::V3d(v.up)), v.fov);
}

}  // namespace interflect::command
