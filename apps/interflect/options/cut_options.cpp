#include "apps/interflect/options/cut_options.h"

#include <spdlog/spdlog.h>

#include "interflect/core.h"
#include "interflect/scene.h"

namespace interflect::command {

using namespace detail;

void CutOptions::add_to(CLI::App& app, const std::vector<std::string>& others) {
    const auto group = [](CLI::Option* option) {
        option->group("Plans and sections");
        return option;
    };
    CLI::Option* plan_option =
        group(app.add_option("--plan", plan, "Plan: the scene below this height z [m], from above, to scale")
                  ->type_name("HEIGHT")
                  ->check(number_between(-1e15, 1e15)));
    CLI::Option* section_option = group(
        add_parsed(app, "--section", section, parse_section,
                   "Section: the scene beyond a plane, such as x=3, -y=2.5 (looking towards -y), or a point on it "
                   "and the direction of view")
            ->type_name("[-]x|y|z=VALUE|X,Y,Z,DX,DY,DZ"));
    section_option->excludes(plan_option);
    for (const std::string& other : others) {
        plan_option->excludes(other);
        section_option->excludes(other);
    }
    group(app.add_option("--extent", extent, "Height of a plan or section in the scene [m] (default: all of it)")
              ->type_name("METRES")
              ->check(number_between(1e-6, 1e15)));
    group(add_parsed(app, "--centre", centre, parse_vector, "Middle of a plan or section (default: the scene's) [m]")
              ->type_name("X,Y,Z"));
}

void CutOptions::check() const {
    if (!is_given() && (extent || centre))
        throw UsageError("--extent and --centre have no effect without --plan or --section");
}

View CutOptions::view(const Scene& scene, int columns, int rows) const {
    const Section cut = section ? *section : Section{{0, 0, *plan}, {0, 0, -1}};
    View view = cut_view(scene, cut.point, cut.direction, static_cast<float>(columns) / static_cast<float>(rows));
    view.name = plan ? "plan" : "section";
    if (extent) view.extent = static_cast<float>(*extent);
    if (centre) {
        const Imath::V3d forward = cut.direction.normalized(), across = *centre - view.eye;
        const Imath::V3d step = across - forward * forward.dot(across);
        view.eye += step;
        view.look_at += step;
    }
    const double pixel = static_cast<double>(view.extent) / rows;
    spdlog::info("{}: {:.4g} x {:.4g} m, a pixel is {:.4g} mm", view.name, pixel * columns, view.extent, 1000 * pixel);
    return view;
}

}  // namespace interflect::command
