#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <memory>
#include <optional>

#include "apps/interflect/commands/commands.h"
#include "apps/interflect/console/messages.h"
#include "apps/interflect/console/path_progress.h"
#include "apps/interflect/options/refused_options.h"
#include "apps/interflect/options/shared_options.h"
#include "apps/interflect/processes/long_work.h"
#include "apps/interflect/processes/signals.h"
#include "apps/interflect/processes/threads.h"
#include "apps/interflect/values/csv_file.h"
#include "interflect/base/files/pending_file.h"
#include "interflect/view_factors.h"
#include "interflect/view_factors/write_npz.h"

namespace interflect::command {

using namespace detail;

namespace {

/// Maximum number of groups whose factors are printed, with one line per pair.
constexpr std::size_t most_printed_groups = 12;

enum class Grouping { objects, materials, facets };

struct ViewFactorArguments {
    SceneOptions scene;
    std::filesystem::path output;
    std::optional<Grouping> grouping;
    std::vector<LightGroup> patterns;  // groups of the form NAME=PATTERN
    FaceSides sides = FaceSides::both;
    ViewFactorOptions estimate;
    std::optional<ReconcileOptions> enforced;
    int threads = 0;
};

bool is_npz(const std::filesystem::path& path) { return path.extension() == ".npz"; }

std::optional<ReconcileOptions> parse_enforced(const std::string& text) {
    if (text == "closure") return ReconcileOptions{.reciprocity = false};
    if (text == "reciprocity") return ReconcileOptions{.closure = false};
    if (text == "closure,reciprocity" || text == "reciprocity,closure") return ReconcileOptions{};
    throw std::invalid_argument(fmt::format("expected closure, reciprocity or closure,reciprocity, found '{}'", text));
}

void check(const ViewFactorArguments& arguments) {
    if (!is_npz(arguments.output) && arguments.output.extension() != ".csv")
        throw UsageError("--output", fmt::format("expected a name that ends in .csv or .npz, found '{}'",
                                                 arguments.output.string()));
    if (arguments.grouping && !arguments.patterns.empty())
        throw UsageError("--group and --groups exclude each other: give patterns or a kind of groups");
    for (std::size_t i = 0; i < arguments.patterns.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (arguments.patterns[i].name == arguments.patterns[j].name)
                throw UsageError("--group", fmt::format("two groups are called '{}'", arguments.patterns[i].name));
}

std::vector<FaceGroup> groups_of(const Scene& scene, const ViewFactorArguments& arguments) {
    if (!arguments.patterns.empty()) {
        std::vector<FacePattern> patterns;
        for (const LightGroup& p : arguments.patterns) patterns.push_back({p.name, p.pattern});
        return pattern_groups(scene, patterns, arguments.sides);
    }
    if (arguments.grouping == Grouping::facets) return facet_groups(scene, arguments.sides);
    const auto group = !arguments.grouping                          ? named_groups
                       : *arguments.grouping == Grouping::materials ? material_groups
                                                                    : object_groups;
    std::vector<FaceGroup> groups = group(scene, arguments.sides);
    if (groups.empty())
        throw InputError(scene.name, 0, "its faces have no names to group them by; --groups facets needs none");
    return groups;
}

/// Calls use(from, to, factor) for each row's non-zero factors, then for its sky, ground and blocked part if non-zero.
template <class Use>
void for_each_factor(const ViewFactors& f, const Use& use) {
    for (std::size_t i = 0; i < f.size(); ++i) {
        for (auto e = static_cast<std::size_t>(f.row_offsets[i]); e < static_cast<std::size_t>(f.row_offsets[i + 1]);
             ++e)
            use(i, f.names[static_cast<std::size_t>(f.columns[e])], ViewFactors::Factor{f.values[e], f.errors[e]});
        if (f.sky[i] > 0) use(i, "(sky)", ViewFactors::Factor{f.sky[i], f.sky_errors[i]});
        if (f.ground[i] > 0) use(i, "(ground)", ViewFactors::Factor{f.ground[i], f.ground_errors[i]});
        if (f.blocked[i] > 0) use(i, "(blocked)", ViewFactors::Factor{f.blocked[i], f.blocked_errors[i]});
    }
}

void write_csv(PendingFile& output, const ViewFactors& f) {
    CsvFile file(output, "from,area [m2],to,factor,standard error");
    for_each_factor(f, [&](std::size_t i, const std::string& to, ViewFactors::Factor factor) {
        file.add_line(fmt::format("{},{:.8g},{},{:.7g},{:.3g}", csv_field(f.names[i]), f.areas[i], csv_field(to),
                                  factor.value, factor.error));
    });
    file.commit();
}

void print_row(const ViewFactors& f, std::size_t i) {
    print_line("{}: {:.6g} m2", f.names[i], f.areas[i]);
    const auto print = [](const std::string& to, double value, double error) {
        if (value > 0) print_line("  {:<28} {:.6f} +- {:.6f}", to, value, error);
    };
    for (auto e = static_cast<std::size_t>(f.row_offsets[i]); e < static_cast<std::size_t>(f.row_offsets[i + 1]); ++e)
        print(f.names[static_cast<std::size_t>(f.columns[e])], f.values[e], f.errors[e]);
    print("(sky)", f.sky[i], f.sky_errors[i]);
    print("(ground)", f.ground[i], f.ground_errors[i]);
    print("(blocked)", f.blocked[i], f.blocked_errors[i]);
}

void print_deviation(const char* law, const char* when, const Deviation& d) {
    print_line("{:<12} {} the fit: largest {:.2g}, r.m.s. {:.2g}; in standard errors {:.2g} and {:.2g}", law, when,
               d.largest, d.rms, d.largest_in_errors, d.rms_in_errors);
}

void print_summary(const ViewFactors& f, const std::optional<Reconciliation>& fit) {
    if (f.size() <= most_printed_groups)
        for (std::size_t i = 0; i < f.size(); ++i) print_row(f, i);
    print_line("{} groups, {} non-zero factors, {} rays a group", f.size(), f.values.size(), f.rays_per_group);
    const Consistency now = fit ? fit->before : consistency(f);
    const char* when = fit ? "before" : "without";
    print_deviation("closure", when, now.closure);
    print_deviation("reciprocity", when, now.reciprocity);
    if (!fit) return;
    print_line("fit          {} linear systems, {} conjugate gradient steps", fit->solves, fit->iterations);
    print_deviation("closure", "after", fit->after.closure);
    print_deviation("reciprocity", "after", fit->after.reciprocity);
}

void run(ViewFactorArguments& arguments, const CLI::App& command, int& exit_code) {
    const ThreadLimit limit(arguments.threads);
    constexpr std::array<std::string_view, 2> light = {"--luminaire", daylight_group};
    refuse_options(command, light, "view factors do not depend on light");
    arguments.scene.check(command);
    check(arguments);
    const std::array<NamedFile, 1> outputs{{{"--output", arguments.output}}};
    require_distinct_files(input_files(arguments.scene, {}), outputs);
    PendingFile output(arguments.output);

    const Scene scene = with_opaque_backs(arguments.scene.load(false));
    refuse_overwriting(scene, outputs);
    const std::vector<FaceGroup> groups = groups_of(scene, arguments);
    const RayCaster ray_caster = make_ray_caster(scene);
    stop_on_signal();
    try {
        ViewFactors factors;
        with_path_progress([&](const Monitor& monitor) {
            factors = view_factors(scene, ray_caster, groups, arguments.estimate, monitor);
        });
        std::optional<Reconciliation> fit;
        if (arguments.enforced) {
            const LongWork work("fitting the view factors");
            Monitor monitor;
            monitor.stop = &stop_flag();
            fit = reconcile(factors, *arguments.enforced, monitor);
        }
        if (is_npz(arguments.output))
            write_npz(output, factors);
        else
            write_csv(output, factors);
        print_summary(factors, fit);
    } catch (const Stopped& e) {
        spdlog::warn("{}: nothing is written", e.what());
    }
    if (is_stop_requested()) exit_code = interrupted;
}

void add_grouping(CLI::App& command, ViewFactorArguments& arguments) {
    add_choice<Grouping>(
        command, "--groups", arguments.grouping,
        {{"objects", Grouping::objects}, {"materials", Grouping::materials}, {"facets", Grouping::facets}},
        "A group for each named object, for each named material or for each face as read (default: objects, or "
        "materials if no object has a name). Faces without a name only block");
    add_each(command, "--group", arguments.patterns, parse_light_group,
             "A group of the faces whose object or material matches the pattern (* and ?); the first match counts, and "
             "other faces only block (may be repeated)")
        ->type_name("NAME=PATTERN");
    add_choice<FaceSides>(command, "--sides", arguments.sides,
                          {{"both", FaceSides::both}, {"front", FaceSides::front}, {"back", FaceSides::back}},
                          "Sides of two-sided faces that belong to the groups; the others only block")
        ->default_str("both");
}

}  // namespace

void add_viewfactors(CLI::App& app, int& exit_code) {
    const auto arguments = std::make_shared<ViewFactorArguments>();
    CLI::App& command = *app.add_subcommand("viewfactors", "Compute view factors between groups of faces");
    arguments->scene.add_to(command);
    command.add_option("-o,--output", arguments->output, "Table (.csv) or arrays for NumPy and SciPy (.npz) to write")
        ->required()
        ->type_name("FILE");
    add_grouping(command, *arguments);
    add_parsed(command, "--rays", arguments->estimate.rays, parse_count,
               "Rays in total; each group has the same power of two of them, at least 1024")
        ->type_name("COUNT")
        ->default_str("20M");
    add_parsed(command, "--enforce", arguments->enforced, parse_enforced,
               "Laws that the factors are fitted to, by least squares: rows with a sum of 1, A_i F_ij = A_j F_ji")
        ->type_name("closure,reciprocity");
    add_parsed(command, "--seed", arguments->estimate.seed, parse_seed, "Same seed, same bits")
        ->type_name("SEED")
        ->default_str("1");
    add_threads(command, arguments->threads);
    command.callback([arguments, &command, &exit_code] { run(*arguments, command, exit_code); });
}

}  // namespace interflect::command
