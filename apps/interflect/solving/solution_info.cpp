#include "apps/interflect/solving/solution_info.h"
#include "apps/interflect/values/percent.h"

#include <fmt/format.h>

#include <cmath>
#include <iostream>

#include "apps/interflect/console/messages.h"
#include "apps/interflect/console/print_views.h"
#include "interflect/exports/records/solve_report.h"
#include "interflect/solution.h"

namespace interflect::command {

using namespace detail;

namespace {

const IterationReport& result_of(const SolvedScene& solved) { return solved.solution.iterations.back(); }

/// Files before version 4 lack options, files and the version of Interflect.
bool has_provenance(const SolvedScene& solved) { return !solved.interflect_version.empty(); }

Json to_json(const SolvedScene& solved) {
    const Scene& scene = solved.scene;
    const Solution& solution = solved.solution;
    Json views = Json::array(), history = Json::array();
    for (const View& v : scene.views) views.push_back(json_of(v));
    for (const IterationReport& report : solution.iterations) history.push_back(json_of(report));
    Json json{{"scene", scene.name},
              {"format_version", solved.format_version},
              {"method", solution.options.method.name},
              {"seed", solution.options.seed}};
    if (has_provenance(solved)) {
        json["version"] = solved.interflect_version;
        json["options"] = json_of(solution.options);
        json["files"] = scene.files;
        json["file_checksums"] = Json::array();
        for (const std::uint32_t checksum : scene.file_checksums)
            json["file_checksums"].push_back(fmt::format("{:08x}", checksum));
    }
    json.update({{"patches", scene.patches.size()},
                 {"result", json_of(result_of(solved))},
                 {"history", history},
                 {"emitted_power", json_of(solution.emitted_power)},
                 {"has_importance", !solution.view_importance.empty()},
                 {"interrupted", solution.interrupted},
                 {"light_groups", solution.group_names},
                 {"views", views}});
    return json;
}

/// Lists the options that differ from the method's defaults.
std::string text_of_options(const SolveOptions& options) {
    const Json json = json_of(options);
    SolveOptions defaults;
    defaults.method = find_method(options.method.name);
    const Json usual = json_of(defaults);
    std::string text;
    for (const auto& [name, value] : json.items())
        if (name != "views" && value != usual.at(name)) text += fmt::format(", {} {}", name, json_text(value));
    return text;
}

void print_text(const SolvedScene& solved) {
    const Scene& scene = solved.scene;
    const Solution& solution = solved.solution;
    const IterationReport& result = result_of(solved);
    print_line("{}", scene.name);
    print_line("  format    version {}{}", solved.format_version,
               has_provenance(solved) ? ", written by Interflect " + solved.interflect_version : "");
    print_line("  method    {}, seed {}{}", solution.options.method.name, solution.options.seed,
               has_provenance(solved) ? text_of_options(solution.options) : "");
    print_line("  rays      {}{}", result.rays, solution.interrupted ? " (interrupted)" : "");
    print_line("  elements  {} ({} leaves) of {} patches", result.elements, result.leaves, scene.patches.size());
    if (std::isfinite(result.error_estimate)) print_line("  error     {}", text_of_error(result));
    print_line("  emitted   {:.6g} lm (RGB {})", luminance(solution.emitted_power), text_of(solution.emitted_power));
    if (!solution.group_names.empty()) print_line("  groups    {}", fmt::join(solution.group_names, ", "));
    print_views(scene.views);
    for (const std::string& file : scene.files) print_line("  file      {}", file);
}

}  // namespace

void print_solution_info(const std::filesystem::path& path, bool json) {
    const SolvedScene solved = read_solution(path);
    if (json)
        std::cout << json_text(to_json(solved), 2) << '\n';
    else
        print_text(solved);
}

}  // namespace interflect::command
