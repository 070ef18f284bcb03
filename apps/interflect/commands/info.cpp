#include <ImathBox.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <memory>
#include <optional>

#include "apps/interflect/commands/commands.h"
#include "apps/interflect/console/messages.h"
#include "apps/interflect/console/print_views.h"
#include "apps/interflect/options/shared_options.h"
#include "apps/interflect/processes/long_work.h"
#include "apps/interflect/solving/run_solve.h"
#include "apps/interflect/solving/solution_info.h"
#include "interflect/denoise.h"
#include "interflect/exports/records/solve_report.h"
#include "interflect/measure.h"
#include "interflect/prepare.h"
#include "interflect/solution.h"
#include "interflect/summary.h"

namespace interflect::command {

using namespace detail;

namespace {

namespace fs = std::filesystem;

/// Returns the number of luminaires of each kind.
std::map<std::string, int> lights_of(const Scene& scene) {
    std::map<std::string, int> lights;
    for (const Luminaire& luminaire : scene.luminaires) ++lights[kind_name(luminaire)];
    return lights;
}

std::vector<std::string> outside_files(const Scene& scene, const fs::path& scene_path) {
    const fs::path folder = fs::weakly_canonical(scene_path).parent_path();
    std::vector<std::string> outside;
    for (const std::string& file : scene.files)
        if (fs::weakly_canonical(file).lexically_relative(folder).string().starts_with("..")) outside.push_back(file);
    return outside;
}

Json to_json(const Scene& scene, const SceneSummary& s, const std::vector<std::string>& outside,
             const MemoryNeed& need) {
    const Json memory{{"scene", need.scene},
                      {"ray_tracer", need.ray_tracer},
                      {"patches", need.patches},
                      {"per_element", need.per_element},
                      {"at_least", need.with(scene.patches.size())}};
    Json views = Json::array(), warnings = Json::array(), emitters = Json::array();
    for (const View& v : scene.views) views.push_back(json_of(v));
    for (const Warnings::Entry& w : scene.warnings.entries())
        warnings.push_back({{"kind", w.kind}, {"message", w.message}, {"where", w.where}, {"count", w.count}});
    for (const MaterialSummary& m : s.materials)
        if (m.emitting_patches > 0)
            emitters.push_back({{"material", scene.materials[m.material].name},
                                {"patches", m.emitting_patches},
                                {"area", m.emitting_area},
                                {"power", json_of(m.power)}});
    const std::optional<UpAxis> up = find_up_axis(scene);
    const std::optional<double> of_sky = exterior_illuminance(scene);
    const Json bounds{{"min", json_of(s.bounds.min)}, {"max", json_of(s.bounds.max)}};
    return {{"scene", scene.name},
            {"patches", scene.patches.size()},
            {"triangles", s.triangles},
            {"two_sided_patches", s.two_sided},
            {"bounds", bounds},
            {"up", up ? Json{{"axis", up->axis}, {"evidence", up->evidence}} : Json(nullptr)},
            {"area", s.area},
            {"emitted_power", json_of(s.emitted_power)},
            {"emitters", emitters},
            {"lights", lights_of(scene)},
            {"sky_illuminance", of_sky ? Json(*of_sky) : Json(nullptr)},
            {"views", views},
            {"memory", memory},
            {"files", scene.files},
            {"files_outside", outside},
            {"warnings", warnings}};
}

/// Returns text such as "-0.15 to 6", without the rounding errors of a scene of this size.
std::string interval(double low, double high, double scene_size) {
    const int decimals = std::clamp(static_cast<int>(std::ceil(4 - std::log10(scene_size))), 0, 30);
    const auto rounded = [&](double x) {
        std::string text = fmt::format("{:.{}f}", x, decimals);
        if (text.find('.') != text.npos) text.erase(text.find_last_not_of('0') + 1);
        if (text.back() == '.') text.pop_back();
        return text == "-0" ? "0" : text;
    };
    return fmt::format("{} to {}", rounded(low), rounded(high));
}

/// Returns the size in MiB, rounded up.
std::size_t mebibytes(std::size_t bytes) { return (bytes + (1 << 20) - 1) >> 20; }

void print_text(const Scene& scene, const SceneSummary& s, const std::vector<std::string>& outside,
                const MemoryNeed& need) {
    print_line("{}", scene.name);
    print_line("  patches   {} ({} triangles; {} on two-sided faces)", scene.patches.size(), s.triangles, s.two_sided);
    const Imath::V3d low = s.bounds.min, high = s.bounds.max;
    const double size = s.bounds.size().length();
    print_line("  bounds    x {}, y {}, z {} m", interval(low.x, high.x, size), interval(low.y, high.y, size),
               interval(low.z, high.z, size));
    const std::optional<UpAxis> up = find_up_axis(scene);
    print_line("  up        {}", up ? fmt::format("{}, from {}", up->axis, up->evidence) : "not known");
    print_line("  area      {:.6g} m2", s.area);
    print_line("  emitted   {:.6g} lm (RGB {})", luminance(s.emitted_power), text_of(s.emitted_power));
    for (const MaterialSummary& m : s.materials)
        if (m.emitting_patches > 0)
            print_line("  emitter   {}: {} patches, {:.4g} m2, {:.6g} lm", scene.materials[m.material].name,
                       m.emitting_patches, m.emitting_area, luminance(m.power));
    for (const auto& [kind, count] : lights_of(scene)) print_line("  lights    {}: {}", kind, count);
    if (const auto of_sky = exterior_illuminance(scene))
        print_line("  sky       {:.6g} lx on an unobstructed horizontal surface", *of_sky);
    print_views(scene.views);
    print_line("  memory    to solve it {} MiB (scene {}, ray tracer {}, patches {}) and {} MiB a million elements",
               mebibytes(need.with(scene.patches.size())), mebibytes(need.scene), mebibytes(need.ray_tracer),
               mebibytes(need.patches), mebibytes(1'000'000 * need.per_element));
    print_line("  files     {}", scene.files.size());
    for (const std::string& file : outside) print_line("  outside   {}: not in the scene's own folder", file);
}

std::string text_of_build() {
    const DenoiserLibrary library = denoiser_library();
    return fmt::format("interflect {}\n  denoiser  {}", INTERFLECT_VERSION,
                       library.fault.empty() ? fmt::format("Open Image Denoise {} ({})", library.version, library.file)
                                             : fmt::format("own filter ({})", library.fault));
}

}  // namespace

void add_info(CLI::App& app) {
    struct Options {
        SceneOptions scene;
        bool json = false;
    };
    const auto options = std::make_shared<Options>();
    CLI::App& command = *app.add_subcommand("info", "List the contents of a scene or a solution");
    options->scene.add_to(command, std::string(scene_formats) + ", or solution file (.h5)");
    command.add_flag("--json", options->json, "As JSON on stdout");
    command.add_flag_callback(
        "--build", [] { throw CLI::CallForVersion(text_of_build(), done); },
        "List the version and the library of --denoise instead, without a scene");
    command.callback([options, &command] {
        options->scene.check(command);
        if (is_solution_file(options->scene.path)) return print_solution_info(options->scene.path, options->json);
        const Scene scene = options->scene.load();
        const RayCaster ray_caster = make_ray_caster(scene);
        warn_of_covered_emission(scene, ray_caster);
        const SceneSummary summary = summarise(scene, ray_caster);
        const std::vector<std::string> outside = outside_files(scene, options->scene.path);
        const MemoryNeed need = memory_need(scene, ray_caster);
        if (options->json)
            std::cout << json_text(to_json(scene, summary, outside, need), 2) << '\n';
        else
            print_text(scene, summary, outside, need);
    });
}

}  // namespace interflect::command
