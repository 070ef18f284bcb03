#include "apps/interflect/solving/stats_file.h"

#include <fmt/format.h>
#include <tbb/info.h>

#include <algorithm>

#include "interflect/exports/records/solve_report.h"

namespace interflect::command {

using namespace detail;

namespace {

Json header_of(const Scene& scene, int threads, const SolveOptions& o, const RgbD& emitted_power) {
    double area = 0;
    for (const Patch& patch : scene.patches) area += patch_area(scene, patch);
    return {{"scene", scene.name},
            {"method", o.method.name},
            {"options", json_of(o)},
            {"seed", o.seed},
            {"threads", threads > 0 ? threads : tbb::info::default_concurrency()},
            {"version", INTERFLECT_VERSION},
            {"patches", scene.patches.size()},
            {"area", area},
            {"emitted_power", json_of(emitted_power)}};
}

Json line_of(const IterationReport& report, const std::vector<IterationTraffic>& traffic) {
    Json line{{"iteration", report.iteration}, {"seconds", report.seconds}};
    line.update(json_of(report));
    const auto found = std::ranges::find(traffic, report.iteration, &IterationTraffic::iteration);
    if (found == traffic.end()) return line;
    line["ranks"] = found->of_ranks.size();
    for (const Ranks::Traffic& of_rank : found->of_ranks) {
        line["sent_bytes"].push_back(of_rank.bytes);
        line["exchange_seconds"].push_back(of_rank.seconds);
    }
    return line;
}

}  // namespace

StatsFile::StatsFile(int threads, const std::filesystem::path& stats) : threads_(threads) {
    if (!stats.empty()) file_.emplace(stats);
}

void StatsFile::write(const Scene& scene, const Solution& solution) {
    if (!file_) return;
    std::string text = json_text(header_of(scene, threads_, solution.options, solution.emitted_power)) + '\n';
    for (const IterationReport& r : solution.iterations) text += json_text(line_of(r, solution.traffic)) + '\n';
    file_->write(text);
    file_->commit();
}

}  // namespace interflect::command
