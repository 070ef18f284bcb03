#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <memory>

#include "apps/interflect/commands/commands.h"
#include "apps/interflect/console/messages.h"
#include "apps/interflect/options/shared_options.h"
#include "apps/interflect/processes/long_work.h"
#include "apps/interflect/processes/threads.h"
#include "apps/interflect/solving/setup_warnings.h"
#include "interflect/exports/records/json_text.h"
#include "interflect/exports/records/solve_report.h"
#include "interflect/prepare.h"
#include "interflect/solve.h"

namespace interflect::command {

using namespace detail;

namespace {

struct ValidateArguments {
    SceneOptions scene;
    MeshOptions mesh;
    ValidateOptions validate;
    int threads = 0;
    bool json = false, strict = false;
};

/// Cost of solving with default options.
struct Prediction {
    std::size_t memory = 0;      ///< Memory with one element per patch [bytes].
    double rays_per_second = 0;  ///< Speed of solving; 0 for a scene without emitted light.
    double rays = 0, seconds = 0;
};

/// Predicts the cost from a solution of one second.
Prediction predict(const Scene& scene, const RayCaster& ray_caster) {
    Prediction result;
    result.memory = memory_need(scene, ray_caster).with(scene.patches.size());
    result.rays = static_cast<double>(SolveOptions().limits.rays);
    GivenSettings given{.limits = {.time = 1}};
    if (!scene.views.empty()) given.others.views.push_back({scene.views.front()});
    const Solution solution = solve(scene, ray_caster, resolved(given));
    if (!(channel_sum(solution.emitted_power) > 0) || solution.iterations.empty()) return result;
    const auto& last = solution.iterations.back();
    result.rays_per_second = static_cast<double>(last.rays) / std::max(last.seconds, 1e-3);
    result.seconds = result.rays / result.rays_per_second;
    return result;
}

Json json_of(const Finding& finding) {
    Json places = Json::array();
    for (const Finding::Place& place : finding.places)
        places.push_back({{"object", place.object},
                          {"material", place.material},
                          {"where", place.where},
                          {"position", place.has_position ? detail::json_of(place.position) : Json(nullptr)}});
    return {{"kind", finding.kind},     {"problem", finding.is_problem}, {"message", finding.message},
            {"advice", finding.advice}, {"count", finding.count},        {"places", places}};
}

void print_finding(const Finding& finding) {
    print_line("{} {}: {} ({})", finding.is_problem ? "problem" : "note   ", finding.kind, finding.message,
               finding.count);
    for (const Finding::Place& place : finding.places) print_line("          {}", text_of(place));
    print_line("          {}", remedy(finding));
}

void print_prediction(const Prediction& prediction) {
    constexpr double mebibyte = 1 << 20;
    print_line("memory  to solve it {:.0f} MiB", static_cast<double>(prediction.memory) / mebibyte);
    if (prediction.rays_per_second > 0)
        print_line("time    {:.3g} s for {:.3g} million rays, at {:.3g} million a second", prediction.seconds,
                   prediction.rays / 1e6, prediction.rays_per_second / 1e6);
}

void run(const ValidateArguments& arguments, const CLI::App& command, int& exit_code) {
    const ThreadLimit limit(arguments.threads);
    arguments.scene.check(command);
    Scene scene = arguments.scene.load();
    const std::vector<Finding> findings = validate(scene, make_ray_caster(scene), arguments.validate);
    const auto problems =
        std::count_if(findings.begin(), findings.end(), [](const Finding& finding) { return finding.is_problem; });
    const std::string name = scene.name;
    scene = arguments.mesh.divide(std::move(scene), arguments.scene.read, true);
    const Prediction prediction = predict(scene, make_ray_caster(scene));
    if (arguments.json) {
        Json list = Json::array();
        for (const Finding& finding : findings) list.push_back(json_of(finding));
        std::cout << json_text({{"scene", name},
                                {"problems", problems},
                                {"findings", list},
                                {"memory", prediction.memory},
                                {"rays_per_second", prediction.rays_per_second},
                                {"rays", prediction.rays},
                                {"seconds", prediction.seconds}},
                               2)
                  << '\n';
    } else {
        print_line("{}: {} kinds of problems, {} of notes", name, problems,
                   static_cast<std::ptrdiff_t>(findings.size()) - problems);
        for (const Finding& finding : findings) print_finding(finding);
        print_prediction(prediction);
    }
    if (arguments.strict && problems > 0) exit_code = failed;
}

}  // namespace

void add_validate(CLI::App& app, int& exit_code) {
    const auto arguments = std::make_shared<ValidateArguments>();
    CLI::App& command = *app.add_subcommand("validate", "List faults of a scene that would spoil its solution");
    arguments->scene.add_to(command);
    arguments->mesh.add_to(command);
    command.add_option("--places", arguments->validate.places, "Most places of each kind that are listed")
        ->type_name("COUNT")
        ->capture_default_str()
        ->check(CLI::Range(0, 1'000'000));
    command.add_flag("--strict", arguments->strict, "Exit code 1 if the scene has a problem");
    command.add_flag("--json", arguments->json, "As JSON on stdout");
    add_threads(command, arguments->threads);
    command.callback([arguments, &command, &exit_code] { run(*arguments, command, exit_code); });
}

}  // namespace interflect::command
