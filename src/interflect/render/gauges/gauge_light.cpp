#include "interflect/render/gauges/gauge_light.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "interflect/base/numbers/points.h"
#include "interflect/base/sums/common_stop.h"
#include "interflect/base/threads/monitor_section.h"
#include "interflect/base/threads/shared_ranges.h"
#include "interflect/render/paths/indirect_field.h"
#include "interflect/render/paths/path_integrator.h"
#include "interflect/render/pictures/pixel_statistics.h"

namespace interflect::detail {

namespace {

constexpr std::size_t gauges_per_tile = 256;
constexpr std::size_t tiles_per_report = 256;  // tiles that each rank traces between two reports
/// Each gauge first receives its samples divided by this. Its neighbours then determine the number of further samples.
constexpr std::uint32_t first_divisor = 8;
/// Minimum initial samples of each half. One sample has no usable estimate of its error.
constexpr std::uint32_t least_initial = 2;

/// Gauges of one tile.
class GaugeTile {
  public:
    GaugeTile(const PathPlan& plan, std::size_t first, std::size_t count, PathIntegrator& integrator)
        : plan_(plan), first_(first), pixels_(count), integrator_(integrator) {}

    /// Returns the number of rays.
    std::int64_t trace() {
        const auto samples = static_cast<std::uint32_t>(plan_.options.samples);
        const std::uint32_t all = std::max(1u, samples / 2),
                            initial = std::min(all, std::max(least_initial, all / first_divisor));
        trace_more(std::vector<std::uint32_t>(pixels_.size(), initial));
        std::vector<std::uint32_t> wanted;
        wanted.reserve(pixels_.size());
        for (std::size_t i = 0; i < pixels_.size(); ++i) wanted.push_back(std::min(all, initial * needed_factor(i)));
        trace_more(wanted);
        return rays_;
    }
    GaugeLight light(std::size_t i) const {
        const PixelStatistics& p = pixels_[i];
        const auto error = static_cast<float>(mean_channel(p.direct_squared_error()));
        GaugeLight light{{Rgb(p.light().direct), error}, {}, Rgb(p.light().indirect)};
        for (std::size_t h = 0; h < 2; ++h) light.halves[h] = {Rgb(p.half_mean(h).direct), 2 * error};
        return light;
    }

  private:
    /// Traces until each half of gauge i has wanted[i] samples.
    void trace_more(const std::vector<std::uint32_t>& wanted) {
        std::vector<SampleBatch> batches;
        constexpr std::uint32_t largest = PointBlock::capacity;  // samples of each half in a batch
        for (std::uint32_t i = 0; i < pixels_.size(); ++i)
            for (std::uint32_t done = pixels_[i].samples_of_half(); done < wanted[i]; done += largest)
                batches.push_back({.pixel = static_cast<std::uint32_t>(first_) + i,
                                   .first_index = done,
                                   .half_size = std::min(largest, wanted[i] - done)});
        integrator_.trace(batches);
        rays_ += integrator_.counts().rays;
        for (const SampleBatch& b : batches) pixels_[b.pixel - first_].add(b, ErrorSource::halves);
    }

    /// Returns the factor, a power of two, by which more samples would reduce the error to the target. Estimates it
    /// from the gauges next to gauge i in the list, which are usually near it in space. Excludes gauge i itself: a
    /// number of samples that depends on its own would bias its mean. They still depend on it weakly, by the
    /// coefficients of DirectLight that near gauges share.
    std::uint32_t needed_factor(std::size_t i) const {
        constexpr std::size_t reach = 4;
        const double target = plan_.options.until > 0 ? plan_.options.until : hybrid_target;
        double error = 0, light = 0, count = 0;
        for (std::size_t k = i - std::min(i, reach); k < std::min(pixels_.size(), i + reach + 1); ++k) {
            if (k == i) continue;
            error += mean_channel(pixels_[k].direct_squared_error());
            light += pixels_[k].reflected();
            ++count;
        }
        std::uint32_t factor = 1;
        while (factor < first_divisor && (count == 0 || error * count > factor * target * target * light * light))
            factor *= 2;
        return factor;
    }

    const PathPlan& plan_;
    std::size_t first_;
    std::vector<PixelStatistics> pixels_;
    PathIntegrator& integrator_;
    std::int64_t rays_ = 0;
};

std::vector<GaugeLight> trace_all_gauges(const PathPlan& plan, const Monitor& monitor) {
    const std::size_t gauges = plan.start.gauges.size();
    std::vector<GaugeLight> irradiance;
    const CommonStop stop(monitor.stop, monitor.ranks);
    PerThread<PathIntegrator> integrators([&] { return PathIntegrator(plan); });
    const std::size_t at_once =
        gauges_per_tile * tiles_per_report * (monitor.ranks ? static_cast<std::size_t>(monitor.ranks->count()) : 1);
    std::int64_t rays = 0;
    for (std::size_t first = 0; first < gauges; first += at_once) {
        const std::size_t count = std::min(at_once, gauges - first);
        std::vector<GaugeLight> light(count);
        std::vector<std::int64_t> rays_of_tile((count + gauges_per_tile - 1) / gauges_per_tile);
        parallel_for_own_ranges(monitor.ranks, count, gauges_per_tile, [&](std::size_t begin, std::size_t end) {
            if (stop.within_process().is_due()) return;
            GaugeTile tile(plan, first + begin, end - begin, integrators.local());
            rays_of_tile[begin / gauges_per_tile] = tile.trace();
            for (std::size_t i = begin; i < end; ++i) light[i] = tile.light(i - begin);
        });
        if (stop.is_due())
            throw Stopped(fmt::format("stopped when {} of {} texels or vertices had light", first, gauges));
        collect_ranges(monitor.ranks, std::span(light), gauges_per_tile, Destination::first_rank);
        collect_ranges(monitor.ranks, std::span(rays_of_tile), 1, Destination::first_rank);
        if (monitor.ranks && monitor.ranks->rank() != 0) continue;
        irradiance.insert(irradiance.end(), light.begin(), light.end());
        for (const std::int64_t of_tile : rays_of_tile) rays += of_tile;
        if (monitor.on_progress)
            monitor.on_progress({rays, static_cast<double>(first + count) / static_cast<double>(gauges)});
    }
    return irradiance;
}

/// Moves the indirect light that a gauge has gathered to its sampled light, whose noise is filtered.
void move_to_sampled(const IndirectField::OwnLight& own, GaugeLight& light) {
    light.direct.irradiance += own.irradiance;
    light.direct.squared_error += own.squared_error;
    for (std::size_t h = 0; h < 2; ++h) {
        light.halves[h].irradiance += own.halves[h];
        light.halves[h].squared_error += 2 * own.squared_error;
    }
    light.indirect = Rgb(0);
}

PathStart start_at(std::span<const Gauge> gauges) {
    PathStart start;
    start.gauges = gauges;
    return start;
}

}  // namespace

std::vector<GaugeLight> hybrid_irradiance(const TracedScene& scene, const KnownIrradiance& known,
                                          std::span<const Gauge> gauges, const PictureOptions& options,
                                          const Monitor& monitor) {
    const PathStart start = start_at(gauges);
    const PathPlan plan{.scene = scene, .start = start, .options = options};
    constexpr double share_of_records = 0.6;  // rough share of the time, for progress reports
    const PreparedLight prepared(plan, &known, monitor_section(monitor, 0, share_of_records));
    const PathPlan hybrid = prepared.plan();
    std::vector<GaugeLight> light =
        trace_all_gauges(hybrid, monitor_section(monitor, share_of_records, 1, prepared.rays()));
    for (std::uint32_t i = 0; i < light.size(); ++i)
        if (const std::uint32_t own = hybrid.hybrid->field->own_record(i); own != none)
            move_to_sampled(hybrid.hybrid->field->own_light(own), light[i]);
    return light;
}

std::vector<SampledIrradiance> direct_irradiance(const TracedScene& scene, std::span<const Gauge> gauges,
                                                 const PictureOptions& options, const Monitor& monitor) {
    const PathStart start = start_at(gauges);
    const HybridLight direct_only;
    const PathPlan plan{.scene = scene,
                        .start = start,
                        .options = options,
                        .first_shadow_rays = first_shadow_rays,
                        .hybrid = &direct_only};
    std::vector<SampledIrradiance> direct;
    const PreparedLight prepared(plan, nullptr, monitor);
    for (const GaugeLight& light : trace_all_gauges(prepared.plan(), monitor)) direct.push_back(light.direct);
    return direct;
}

}  // namespace interflect::detail
