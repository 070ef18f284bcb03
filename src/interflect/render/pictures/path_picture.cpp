#include "interflect/render/pictures/path_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>
#include <vector>

#include "interflect/base/sums/common_stop.h"
#include "interflect/base/threads/monitor_section.h"
#include "interflect/base/threads/parallel.h"
#include "interflect/base/threads/stop_request.h"
#include "interflect/core.h"
#include "interflect/render/pictures/camera_samples.h"
#include "interflect/render/pictures/pixel_statistics.h"
#include "interflect/render/rays/nearby_light.h"
#include "interflect/render/reflections/virtual_lights.h"
#include "interflect/render/sharing/light_order.h"
#include "interflect/render/sharing/shared_batches.h"

namespace interflect::detail {

namespace {

/// Minimum number of independent parts of a pixel's samples. Eight give its standard error 7 degrees of freedom.
constexpr int min_parts = 8;
/// Larger batches hardly improve the stratification, and fewer batches make the error estimate worse.
constexpr int largest_half_batch = 64;
bool has_time_limit(const PictureOptions& options) { return std::isfinite(options.time); }

/// Returns the pixels of a picture in nested blocks of 2 x 2 to 32 x 32: consecutive pixels, which share coefficients
/// of DirectLight, are neighbours. With two paths a pixel, a block is a tile of SharedBatches. Returns gauges in their
/// order.
std::vector<std::uint32_t> order_of_pixels(const PathPlan& plan) {
    const auto width = static_cast<std::uint32_t>(plan.options.width),
               height = static_cast<std::uint32_t>(plan.options.height);
    std::vector<std::uint32_t> order(std::size_t{width} * height);
    std::iota(order.begin(), order.end(), 0u);
    if (!plan.start.camera) return order;
    constexpr std::uint32_t levels = 5, block = 1 << levels;
    const auto even_bits = [](std::uint32_t word) {
        std::uint32_t bits = 0;
        for (std::uint32_t i = 0; i < levels; ++i) bits |= (word >> (2 * i) & 1) << i;
        return bits;
    };
    auto next = order.begin();
    for (std::uint32_t top = 0; top < height; top += block)
        for (std::uint32_t left = 0; left < width; left += block)
            for (std::uint32_t i = 0; i < block * block; ++i) {
                const std::uint32_t column = left + even_bits(i), row = top + even_bits(i >> 1);
                if (column < width && row < height) *next++ = row * width + column;
            }
    return order;
}

/// Draws a picture in rounds. The first round gives every pixel a few samples. The number of samples that a pixel needs
/// is estimated from those of its neighbours. Later rounds multiply these numbers by a factor that is common to the
/// picture. So the number of samples of a pixel does not depend on their values, and its mean is unbiased (up to the
/// influence of a pixel on the error of the picture).
class PathPicture {
  public:
    /// @param time_left  Limit given by PictureOptions::time.
    PathPicture(const PathPlan& plan, SharedBatches& batches, const Monitor& monitor, const StopRequest& time_left)
        : plan_(plan),
          options_(plan.options),
          monitor_(monitor),
          time_left_(time_left),
          shared_(batches),
          pixels_(static_cast<std::size_t>(options_.width) * static_cast<std::size_t>(options_.height)),
          order_(order_of_pixels(plan)) {}

    void trace() {
        // Choose the number of samples of each half in the first round, and its limit in later rounds
        const bool is_adaptive = plan_.hybrid || options_.until > 0 || has_time_limit(options_);
        const std::uint32_t least_parts = error_source() == ErrorSource::batches ? 2 : 1;
        const std::uint32_t requested = std::max(samples_of_half(options_.samples), least_parts * batch_size());
        const std::uint32_t allowed = samples_of_half(std::max(options_.max_samples, options_.samples));
        const bool is_open_ended = options_.until > 0 || has_time_limit(options_);
        const std::uint32_t most = is_open_ended ? allowed / batch_size() * batch_size() : requested;
        const std::uint32_t least =
            plan_.hybrid || has_time_limit(options_) ? std::min(requested, least_parts * first_samples()) : requested;
        expected_samples_ = static_cast<double>(least) * static_cast<double>(pixels_.size());
        if (predicts_light()) {
            nearby_.resize(2 * pixels_.size());
            trace_round(std::vector<std::uint32_t>(pixels_.size(), 1));
            predict_by_nearby_light();
        }
        trace_round(std::vector<std::uint32_t>(pixels_.size(), least));
        has_all_pixels_ = true;
        if (predicts_light() && !stopped()) add_first_hits();
        if (!is_adaptive || most <= least) return;
        if (plan_.hybrid && monitor_.on_picture && !is_over()) monitor_.on_picture(result());
        const std::vector<double> needed = needed_by_pixels();
        // Within a time limit, small steps spread the samples evenly over the picture.
        constexpr double first_step = 1.0 / 8;
        for (double factor = has_time_limit(options_) ? first_step : 1; !is_over(); factor *= 2) {
            const bool more = trace_round(wanted(needed, factor, most));
            const bool has_target = options_.until > 0;
            if (has_target && error_of_picture() <= options_.until) break;
            if (!has_target && !has_time_limit(options_)) break;
            if (!more && factor >= most) break;  // each pixel has the maximum number of samples, or no noise
        }
        if (!stopped()) report(1);
    }

    Rendering result() const {
        Rendering result;
        result.image = Image(options_.width, options_.height);
        result.standard_error = Image(options_.width, options_.height);
        result.batches.resize(pixels_.size());
        parallel_for_indices(pixels_.size(), [&](std::size_t i) {
            result.batches[i] = pixels_[i].samples_of_half() / batch_size() * 2;
            const RgbD e = pixels_[i].squared_error();
            result.image.pixels[i] = Rgb(pixels_[i].mean());
            result.standard_error.pixels[i] = Rgb(RgbD(std::sqrt(e.x), std::sqrt(e.y), std::sqrt(e.z)));
        });
        result.layers = layers();
        result.relative_error = error_of_picture();
        result.rays = counts_.rays;
        result.shadow_rays = counts_.shadow_rays;
        result.escaped_rays = counts_.escaped_rays;
        result.paths = 2 * samples_done_;
        result.non_finite_pixels = count_non_finite(result.image);
        result.interrupted = stopped();
        return result;
    }

  private:
    ErrorSource error_source() const {
        return plan_.hybrid           ? ErrorSource::halves
               : plan_.virtual_lights ? ErrorSource::batches
                                      : ErrorSource::half_batches;
    }
    double error_of_picture() const { return relative_error(pixels_, options_); }
    static std::uint32_t samples_of_half(int samples) { return static_cast<std::uint32_t>((samples + 1) / 2); }

    /// Returns the number of samples of each half in the first round.
    std::uint32_t first_samples() const { return has_time_limit(options_) && !plan_.hybrid ? 2 : 4; }

    /// Returns the number of samples of each half in a batch. It is a power of two, except in hybrid shading, where all
    /// batches of a pixel continue the same two sequences.
    std::uint32_t batch_size() const {
        if (plan_.hybrid) return std::min(samples_of_half(options_.samples), first_samples());
        const int parts = error_source() == ErrorSource::batches ? 2 * min_parts : min_parts;
        const auto size =
            std::bit_floor(static_cast<unsigned>(std::clamp(options_.samples / parts, 1, largest_half_batch)));
        return has_time_limit(options_) ? std::min(size, first_samples()) : size;
    }

    /// @param part       Returns the light of a pixel: its mean, or the mean of one half.
    /// @param variances  Variance of this light, relative to the variance of the mean.
    SampledLight light_of(const auto& part, double variances) const {
        SampledLight light{Image(options_.width, options_.height), Image(options_.width, options_.height),
                           std::vector<float>(pixels_.size()), std::vector<float>(pixels_.size())};
        parallel_for_indices(pixels_.size(), [&](std::size_t i) {
            const PathLight mean = part(pixels_[i]);
            light.direct.pixels[i] = Rgb(mean.direct);
            light.indirect.pixels[i] = Rgb(mean.indirect);
            const auto variance = [&](const RgbD& squared_error) {
                return static_cast<float>(variances * mean_channel(squared_error));
            };
            light.direct_variance[i] = variance(pixels_[i].direct_squared_error());
            light.indirect_variance[i] = variance(pixels_[i].indirect_squared_error());
        });
        return light;
    }

    PictureLayers layers() const {
        PictureLayers layers;
        layers.pixel_angle = plan_.start.pixel_angle;
        layers.pixel_size = plan_.start.pixel_size;
        layers.is_indirect_interpolated = plan_.hybrid != nullptr;
        layers.reflected = light_of([](const PixelStatistics& p) { return p.light(); }, 1);
        for (std::size_t h = 0; h < layers.halves.size(); ++h)
            layers.halves[h] = light_of([h](const PixelStatistics& p) { return p.half_mean(h); }, 2);
        for (Image* image : {&layers.emitted, &layers.albedo, &layers.normal, &layers.position})
            *image = Image(options_.width, options_.height);
        layers.depth.resize(pixels_.size());
        layers.level.resize(pixels_.size());
        parallel_for_indices(pixels_.size(), [&](std::size_t i) {
            const FirstHit first = pixels_[i].first();
            layers.emitted.pixels[i] = Rgb(pixels_[i].light().emitted);
            layers.albedo.pixels[i] = Rgb(first.albedo);
            layers.normal.pixels[i] = Rgb(V3f(first.normal));
            layers.position.pixels[i] = Rgb(V3f(first.position));
            layers.depth[i] = static_cast<float>(first.distance);
            layers.level[i] = static_cast<float>(first.level);
        });
        return layers;
    }

    bool stopped() const { return monitor_.stop && *monitor_.stop; }
    bool is_over() const { return stopped() || (has_all_pixels_ && time_left_.is_out_of_time()); }

    /// Returns the samples of each half that pixels need to reach the target. All measuring points get equal numbers,
    /// because points that are neighbours in the list may be far apart.
    std::vector<double> needed_by_pixels() const {
        const bool is_uniform = !plan_.hybrid && !(options_.until > 0);
        if (is_uniform)
            return std::vector<double>(pixels_.size(),
                                       has_time_limit(options_) ? 2.0 * pixels_[0].samples_of_half() : 0);
        const double target = options_.until > 0 ? options_.until : hybrid_target;
        if (!plan_.start.camera) {
            const double excess = error_of_picture() / target;
            return std::vector<double>(pixels_.size(), excess * excess * pixels_[0].samples_of_half());
        }
        return needed_samples(pixels_, options_, target);
    }

    /// Returns the number of samples of each half that every pixel should have. Rounds up to powers of two, which
    /// stratify best, and limits it to `most`.
    std::vector<std::uint32_t> wanted(const std::vector<double>& needed, double factor, std::uint32_t most) {
        std::vector<std::uint32_t> wanted(pixels_.size());
        expected_samples_ = 0;
        for (std::size_t i = 0; i < pixels_.size(); ++i) {
            const double samples = std::clamp<double>(factor * needed[i], pixels_[i].samples_of_half(), most);
            wanted[i] = std::min(most, std::bit_ceil(static_cast<std::uint32_t>(std::ceil(samples))));
            expected_samples_ += wanted[i];
        }
        return wanted;
    }

    /// Traces until each half of every pixel has the wanted number of samples. Returns whether any samples were
    /// missing.
    bool trace_round(const std::vector<std::uint32_t>& wanted) {
        std::vector<std::uint32_t> present(pixels_.size());
        for (std::size_t i = 0; i < pixels_.size(); ++i) present[i] = pixels_[i].samples_of_half();
        std::vector<SampleBatch> chunk;
        std::size_t paths = 0;
        bool has_traced = false;
        for (bool more = true; more;) {
            more = false;
            for (const std::uint32_t i : order_) {
                if (is_over()) break;
                if (present[i] >= wanted[i]) continue;
                if (!more) renew_virtual_lights(chunk);
                chunk.push_back(next_batch(i, present[i], wanted[i]));
                present[i] += chunk.back().half_size;
                paths += 2 * std::size_t{chunk.back().half_size};
                more = has_traced = true;
                if (paths >= SharedBatches::paths_at_once(plan_, monitor_.ranks)) {
                    trace_chunk(chunk);
                    paths = 0;
                }
            }
        }
        trace_chunk(chunk);
        return has_traced;
    }

    /// Whether the light of first hits is predicted. A solution includes the light of suns. In a picture without it,
    /// the edges of their shadows would add noise.
    bool predicts_light() const {
        const bool has_same_suns = plan_.has_direct_sunlight || plan_.sources().useful_rays(SourceKind::suns, 1) == 0;
        return plan_.hybrid && plan_.start.camera && has_same_suns;
    }

    /// Keeps the first sample of each half of a pixel.
    void keep_nearby(const SampleBatch& batch) {
        for (std::size_t h = 0; h < 2; ++h) {
            const FirstHit& first = batch.first[h];
            const double per_radiance = plan_.shows_irradiance() ? std::numbers::pi : 1;
            const RgbD reflected = (batch.halves[h].direct + batch.halves[h].indirect) / per_radiance;
            const bool shows_surface = first.distance > 0 && mean_channel(first.albedo) > 0;
            if (!shows_surface || !is_finite(Rgb(reflected))) continue;
            NearbyLight::Sample& sample = nearby_[2 * std::size_t{batch.pixel} + h];
            sample.position = V3f(first.position);
            sample.normal = V3f(first.normal);
            sample.spacing = static_cast<float>(first.distance) * plan_.start.pixel_angle + plan_.start.pixel_size;
            sample.reflectance = Rgb(first.albedo);
            sample.reflected = Rgb(reflected);
        }
    }

    /// Predicts the light of first hits by NearbyLight, and replaces the predictions of the first samples.
    void predict_by_nearby_light() {
        if (stopped()) return;
        shared_.predict_by(options_.width, options_.height, std::move(nearby_));
        nearby_ = {};
        trace_first_hits([](std::uint32_t i) { return SampleBatch{.pixel = i, .tracing = Tracing::first_hits}; },
                         [this](const SampleBatch& batch) { pixels_[batch.pixel].replace_prediction(batch); });
    }

    /// Traces camera rays alone at edges and textures, even if the time is over: they are cheap.
    void add_first_hits() {
        constexpr std::uint32_t number = 1;  // all samples are in batches of number 0
        const std::vector<std::uint32_t> needed = needed_first_hits(pixels_, light_at_places(), options_);
        trace_first_hits(
            [&](std::uint32_t i) {
                return SampleBatch{
                    .pixel = i, .number = number, .half_size = needed[i], .tracing = Tracing::first_hits};
            },
            [this](const SampleBatch& batch) { pixels_[batch.pixel].add_first_hits(batch); });
    }

    std::vector<LightAtPlaces> light_at_places() {
        std::vector<LightAtPlaces> places(pixels_.size());
        const auto light = [](const PathLight& half) { return mean_channel(half.emitted + half.predicted); };
        trace_first_hits([](std::uint32_t i) { return SampleBatch{.pixel = i, .tracing = Tracing::fixed_places}; },
                         [&](const SampleBatch& batch) {
                             places[batch.pixel] = {light(batch.halves[0]), light(batch.halves[1])};
                         });
        return places;
    }

    /// Traces camera rays to their first hits. @param batch_of  Returns the batch of a pixel, or one without samples.
    /// @param use  Receives each traced batch.
    void trace_first_hits(const auto& batch_of, const auto& use) {
        std::vector<SampleBatch> chunk;
        std::size_t rays = 0;
        const auto trace_and_use = [&] {
            counts_ += shared_.trace(
                chunk, [this] { return stopped(); }, false);
            for (const SampleBatch& batch : chunk)
                if (batch.done) use(batch);
            chunk.clear();
            rays = 0;
        };
        for (std::uint32_t i = 0; i < pixels_.size(); ++i) {
            const SampleBatch batch = batch_of(i);
            if (batch.half_size == 0) continue;
            chunk.push_back(batch);
            rays += 2 * std::size_t{batch.half_size};
            if (rays >= SharedBatches::paths_at_once(plan_, monitor_.ranks)) trace_and_use();
        }
        if (!chunk.empty()) trace_and_use();
    }

    /// Each batch of a pixel uses another set of virtual lights, so the variance of the batches includes the error of
    /// the sets.
    void renew_virtual_lights(std::vector<SampleBatch>& chunk) {
        if (!plan_.virtual_lights) return;
        trace_chunk(chunk);
        counts_.rays += shared_.renew_virtual_lights();
    }

    /// In hybrid shading, the batches of a pixel continue two sequences; otherwise they are independent.
    SampleBatch next_batch(std::uint32_t pixel, std::uint32_t present, std::uint32_t wanted) const {
        constexpr std::uint32_t largest = 64;  // samples of each half in a batch of hybrid shading
        if (plan_.hybrid)
            return {.pixel = pixel, .first_index = present, .half_size = std::min(largest, wanted - present)};
        return {.pixel = pixel, .number = present / batch_size(), .half_size = batch_size()};
    }

    void trace_chunk(std::vector<SampleBatch>& chunk) {
        if (chunk.empty() || is_over()) return chunk.clear();
        counts_ += shared_.trace(
            chunk, [this] { return is_over(); }, has_all_pixels_);
        for (const SampleBatch& batch : chunk) {
            if (!batch.done) continue;
            pixels_[batch.pixel].add(batch, error_source());
            if (!nearby_.empty()) keep_nearby(batch);
            samples_done_ += batch.half_size;
        }
        chunk.clear();
        report(std::min(1.0, static_cast<double>(samples_done_) / expected_samples_));
    }

    void report(double fraction) {
        if (!monitor_.on_progress) return;
        const auto new_samples = static_cast<std::size_t>(samples_done_ - samples_of_error_);
        if (2 * new_samples >= pixels_.size() || fraction == 1) {
            error_ = error_of_picture();
            samples_of_error_ = samples_done_;
        }
        monitor_.on_progress({counts_.rays, fraction, error_});
    }

    const PathPlan& plan_;
    const PictureOptions& options_;
    const Monitor& monitor_;
    const StopRequest& time_left_;
    SharedBatches& shared_;
    bool has_all_pixels_ = false;
    std::vector<PixelStatistics> pixels_;
    std::vector<NearbyLight::Sample> nearby_;  // first samples, two of each pixel; empty once they predict light
    const std::vector<std::uint32_t> order_;   // in which pixels are traced
    double expected_samples_ = 0;              // expected number of samples of each half, summed over the pixels
    std::int64_t samples_done_ = 0;
    double error_ = std::numeric_limits<double>::infinity();  // last computed error of the picture
    std::int64_t samples_of_error_ = 0;                       // samples_done_ when error_ was computed
    RayCounts counts_;
};

void require_valid(const PictureOptions& options) {
    if (!(options.time > 0)) throw InputError(fmt::format("a time of {} s: expected more than 0", options.time));
    if (options.samples < 2)
        throw InputError(
            fmt::format("{} samples a pixel: expected 2 or more, whose spread tells the error", options.samples));
    if (!(options.until >= 0 && std::isfinite(options.until)))
        throw InputError(fmt::format("a relative error of {}: expected 0 or more", options.until));
    if (options.until > 0 && options.max_samples < options.samples)
        throw InputError(fmt::format("at most {} samples a pixel: expected no less than the least, {}",
                                     options.max_samples, options.samples));
}

Rendering draw(const PathPlan& plan, const Monitor& monitor, const StopRequest& time_left,
               VirtualLights* virtual_lights = nullptr) {
    SharedBatches batches(plan, virtual_lights, monitor.ranks);
    if (batches.is_helper()) {
        batches.help(time_left);
        return {};
    }
    PathPicture picture(plan, batches, monitor, time_left);
    picture.trace();
    batches.end();
    return picture.result();
}

}  // namespace

Rendering trace_instant_picture(const Scene& scene, const RayCaster& ray_caster, const PathStart& start,
                                const PictureOptions& options, const Monitor& monitor) {
    require_valid(options);
    if (options.light_walks < 1)
        throw InputError(fmt::format("{} walks from the light sources: expected 1 or more", options.light_walks));
    ray_caster.require_made_for(scene);
    give_order(monitor.ranks, {.kind = LightOrder::Kind::instant_picture, .options = options}, start);
    StopRequest time_left;
    time_left.limit_time(StopRequest::Clock::now(), options.time);
    const TracedScene traced(scene, ray_caster);
    VirtualLights lights(scene, ray_caster, traced.geometry, traced.panes,
                         static_cast<std::size_t>(options.light_walks), options.seed);
    const PathPlan plan{.scene = traced, .start = start, .options = options, .virtual_lights = &lights};
    return draw(plan, monitor, time_left, &lights);
}

Rendering trace_picture(const Scene& scene, const RayCaster& ray_caster, const PathStart& start,
                        const PictureOptions& options, const Monitor& monitor, const KnownIrradiance* known,
                        bool has_direct_sunlight) {
    require_valid(options);
    ray_caster.require_made_for(scene);
    give_order(monitor.ranks,
               {.kind = LightOrder::Kind::picture,
                .options = options,
                .is_known = known != nullptr,
                .is_interpolated = known && known->is_interpolated,
                .has_direct_sunlight = has_direct_sunlight},
               start);
    StopRequest time_left;
    time_left.limit_time(StopRequest::Clock::now(), options.time);
    const TracedScene traced(scene, ray_caster);
    const PathPlan plan{
        .scene = traced, .start = start, .options = options, .has_direct_sunlight = has_direct_sunlight};
    // Rough share of the time, for progress reports.
    const double share_of_records = known && known->is_interpolated ? 0.25 : 0;
    const PreparedLight prepared(plan, known, monitor_section(monitor, 0, share_of_records));
    const PathPlan with_records = prepared.plan();
    Rendering result = draw(with_records, monitor_section(monitor, share_of_records, 1, prepared.rays()), time_left);
    result.rays += prepared.rays();
    return result;
}

KnownIrradiance known_irradiance(const Scene& scene, const ElementForest& forest, std::span<const Rgb> irradiance) {
    forest.require_made_for(scene);
    require_values_of_elements(forest, irradiance.size(), "irradiance");
    return {forest, irradiance, irradiance};
}

KnownIrradiance known_irradiance(const Scene& scene, const Solution& solution) {
    KnownIrradiance known = known_irradiance(scene, *solution.forest, solution.irradiance);
    if (solution.unreduced_irradiance.empty()) return known;
    require_values_of_elements(*solution.forest, solution.unreduced_irradiance.size(), "unreduced irradiance");
    known.unreduced = solution.unreduced_irradiance;
    return known;
}

PathStart start_at_camera(const View& view, const PictureOptions& options, const Imath::V3d& origin) {
    constexpr float degree = std::numbers::pi_v<float> / 180;
    const Camera camera(view, options.width, options.height, origin);
    if (view.extent > 0) return {camera, 0, {}, view.extent / static_cast<float>(options.height)};
    return {camera, 2 * std::tan(view.fov / 2 * degree) / static_cast<float>(options.height)};
}

}  // namespace interflect::detail
