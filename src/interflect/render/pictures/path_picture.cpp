#include "interflect/render/pictures/path_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <tuple>
#include <vector>

#include "interflect/base/common_stop.h"
#include "interflect/base/monitor_section.h"
#include "interflect/base/stop_request.h"
#include "interflect/core.h"
#include "interflect/geometry/patch_geometry.h"
#include "interflect/geometry/smooth_surfaces.h"
#include "interflect/render/paths/indirect_field.h"
#include "interflect/render/pictures/camera_samples.h"
#include "interflect/render/pictures/pixel_statistics.h"
#include "interflect/render/sharing/light_order.h"
#include "interflect/render/sharing/shared_batches.h"
#include "interflect/render/smooth/smooth_normals.h"

namespace interflect::detail {

namespace {

/// Minimum batches per pixel: 7 degrees of freedom for its standard error.
constexpr int min_batches = 8;
/// Hybrid shading and pictures with a time limit begin with fewer, one for each half of the samples. In hybrid shading
/// without a target, only pixels of a larger relative error get all.
constexpr std::uint32_t starting_batches = 2;
/// Minimum of hybrid shading, whose batches look up indirect and unoccluded light; maximum within a time limit.
constexpr std::size_t small_batch = 2;

bool is_limited(const PathOptions& options) { return std::isfinite(options.time); }

class PathPicture {
  public:
    /// @param time_left  As PathOptions::time.
    PathPicture(const PathScene& scene, SharedBatches& batches, const PathOptions& options, const Monitor& monitor,
                const StopRequest& time_left)
        : s_(scene),
          options_(options),
          monitor_(monitor),
          time_left_(time_left),
          shared_(batches),
          pixels_(static_cast<std::size_t>(options.width) * static_cast<std::size_t>(options.height)) {}

    void trace() {
        const auto batches_of = [&](int samples) {
            const auto batch = static_cast<int>(s_.batch_size);
            return static_cast<std::uint32_t>((samples + batch - 1) / batch);
        };
        const bool has_target = options_.until > 0, is_hybrid = s_.indirect_field != nullptr;
        const double target = has_target || !is_hybrid ? options_.until : hybrid_target;
        const bool starts_small = is_hybrid || is_limited(options_);
        const std::uint32_t usual =
            starts_small ? std::max(batches_of(options_.samples), starting_batches) : batches_of(options_.samples);
        const std::uint32_t least = starts_small ? starting_batches : usual;
        const std::uint32_t most = has_target ? batches_of(std::max(options_.max_samples, options_.samples)) : usual;
        std::vector<std::uint32_t> wanted(pixels_.size(), least);
        foreseen_ = static_cast<double>(least) * static_cast<double>(pixels_.size());
        trace_round(wanted);
        has_all_pixels_ = true;
        if (target <= 0 && !is_limited(options_)) return;
        while (!is_over() && want_more(wanted, target, most)) trace_round(wanted);
        if (!stopped()) report(1);
    }

    PathTracing result() const {
        PathTracing result;
        result.image = Image(options_.width, options_.height);
        result.standard_error = Image(options_.width, options_.height);
        result.batches.reserve(pixels_.size());
        for (std::size_t i = 0; i < pixels_.size(); ++i) {
            result.batches.push_back(pixels_[i].batches);
            const RgbD e = pixels_[i].squared_error();
            result.image.pixels[i] = Rgb(pixels_[i].mean);
            result.standard_error.pixels[i] = Rgb(RgbD(std::sqrt(e.x), std::sqrt(e.y), std::sqrt(e.z)));
        }
        result.layers = layers();
        result.relative_error = relative_error(pixels_);
        result.rays = counts_.rays;
        result.shadow_rays = counts_.shadow_rays;
        result.escaped_rays = counts_.escaped_rays;
        result.paths = batches_done_ * static_cast<std::int64_t>(s_.batch_size);
        result.non_finite_pixels = count_non_finite(result.image);
        result.interrupted = stopped();
        return result;
    }

  private:
    SampledLight light_of(const auto& parts) const {
        SampledLight light{Image(options_.width, options_.height), Image(options_.width, options_.height),
                           std::vector<float>(pixels_.size()), std::vector<float>(pixels_.size())};
        for (std::size_t i = 0; i < pixels_.size(); ++i) {
            const auto& [direct, indirect] = parts(pixels_[i]);
            light.direct.pixels[i] = Rgb(direct.mean);
            light.indirect.pixels[i] = Rgb(indirect.mean);
            light.direct_variance[i] = static_cast<float>(direct.squared_error());
            light.indirect_variance[i] = static_cast<float>(indirect.squared_error());
        }
        return light;
    }

    PictureLayers layers() const {
        PictureLayers layers;
        layers.pixel_angle = s_.start->pixel_angle;
        layers.pixel_size = s_.start->pixel_size;
        layers.is_indirect_interpolated = s_.indirect_field != nullptr;
        layers.reflected = light_of([](const PixelStatistics& p) { return std::tie(p.direct, p.indirect); });
        for (std::size_t h = 0; h < layers.halves.size(); ++h) {
            SampledLight& half = layers.halves[h];
            half = light_of([h](const PixelStatistics& p) {
                return p.batches > h ? std::tie(p.direct_halves[h], p.indirect_halves[h])
                                     : std::tie(p.direct, p.indirect);
            });
            for (std::size_t i = 0; i < pixels_.size(); ++i) {
                if (pixels_[i].direct_halves[h].batches > 1) continue;
                half.direct_variance[i] = 2 * layers.reflected.direct_variance[i];
                half.indirect_variance[i] = 2 * layers.reflected.indirect_variance[i];
            }
        }
        for (Image* image : {&layers.emitted, &layers.albedo, &layers.normal, &layers.position})
            *image = Image(options_.width, options_.height);
        layers.depth.resize(pixels_.size());
        layers.level.resize(pixels_.size());
        for (std::size_t i = 0; i < pixels_.size(); ++i) {
            const PixelStatistics& p = pixels_[i];
            layers.emitted.pixels[i] = Rgb(p.emitted);
            layers.albedo.pixels[i] = Rgb(p.first.albedo);
            layers.normal.pixels[i] = Rgb(V3f(p.first.normal));
            layers.position.pixels[i] = Rgb(V3f(p.first.position));
            layers.depth[i] = static_cast<float>(p.first.distance);
            layers.level[i] = static_cast<float>(p.first.level);
        }
        return layers;
    }

    bool stopped() const { return monitor_.stop && *monitor_.stop; }
    bool is_over() const { return stopped() || (has_all_pixels_ && time_left_.is_out_of_time()); }

    bool want_more(std::vector<std::uint32_t>& wanted, double target, std::uint32_t most) {
        const std::vector<double> needed =
            target > 0 ? needed_batches(pixels_, options_, target) : std::vector<double>(pixels_.size(), most);
        bool more = false;
        foreseen_ = 0;
        for (std::size_t i = 0; i < pixels_.size(); ++i) {
            const std::uint32_t present = pixels_[i].batches;
            const double in_all = std::max<double>(present, std::min<double>(most, std::ceil(needed[i])));
            wanted[i] = static_cast<std::uint32_t>(std::min(in_all, 2.0 * present));
            more = more || wanted[i] > present;
            foreseen_ += in_all;
        }
        return more;
    }

    void trace_round(const std::vector<std::uint32_t>& wanted) {
        const std::size_t per_chunk = SharedBatches::paths_at_once(monitor_.ranks) / s_.batch_size;
        std::vector<std::uint32_t> present(pixels_.size());
        for (std::size_t i = 0; i < pixels_.size(); ++i) present[i] = pixels_[i].batches;
        std::vector<BatchOfPaths> chunk;
        for (bool more = true; more;) {
            more = false;
            for (std::uint32_t i = 0; i < pixels_.size() && !is_over(); ++i) {
                if (present[i] >= wanted[i]) continue;
                if (!more) renew_virtual_lights(chunk);
                chunk.push_back(batch_of(i, present[i]++));
                more = true;
                if (chunk.size() >= per_chunk) trace_chunk(chunk);
            }
        }
        trace_chunk(chunk);
    }

    /// Each batch of a pixel is lit by another set of virtual lights, so their spread includes the error of the sets.
    void renew_virtual_lights(std::vector<BatchOfPaths>& chunk) {
        if (!s_.virtual_lights) return;
        trace_chunk(chunk);
        counts_.rays += shared_.renew_virtual_lights();
    }

    /// In hybrid shading, one sequence stratifies the batches of a pixel, so the error is overestimated. Otherwise they
    /// are independent.
    BatchOfPaths batch_of(std::uint32_t pixel, std::uint32_t number) const {
        if (!s_.indirect_field) return {pixel, number};
        return {pixel, 0, number * static_cast<std::uint32_t>(s_.batch_size)};
    }

    void trace_chunk(std::vector<BatchOfPaths>& chunk) {
        if (chunk.empty() || is_over()) return chunk.clear();
        counts_ += shared_.trace(
            chunk, [this] { return is_over(); }, has_all_pixels_);
        for (const BatchOfPaths& batch : chunk) {
            if (!batch.done) continue;
            pixels_[batch.pixel].add(batch, static_cast<double>(s_.batch_size));
            ++batches_done_;
        }
        chunk.clear();
        report(std::min(1.0, static_cast<double>(batches_done_) / foreseen_));
    }

    void report(double fraction) {
        if (!monitor_.on_progress) return;
        const auto new_batches = static_cast<std::size_t>(batches_done_ - batches_of_error_);
        if (new_batches * s_.batch_size >= pixels_.size() || fraction == 1) {
            error_ = relative_error(pixels_);
            batches_of_error_ = batches_done_;
        }
        monitor_.on_progress({counts_.rays, fraction, error_});
    }

    const PathScene& s_;
    const PathOptions& options_;
    const Monitor& monitor_;
    const StopRequest& time_left_;
    SharedBatches& shared_;
    bool has_all_pixels_ = false;
    std::vector<PixelStatistics> pixels_;
    double foreseen_ = 0;  // expected total of batches
    std::int64_t batches_done_ = 0;
    double error_ = std::numeric_limits<double>::infinity();  // after batches_of_error_ batches
    std::int64_t batches_of_error_ = 0;
    RayCounts counts_;
};

void require_valid(const PathOptions& options) {
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

}  // namespace

namespace {

PathTracing draw(const PathScene& scene, const PathOptions& options, const Monitor& monitor,
                 const StopRequest& time_left, VirtualLights* virtual_lights = nullptr) {
    SharedBatches batches(scene, virtual_lights, monitor.ranks);
    if (batches.is_helper()) {
        batches.help(time_left);
        return {};
    }
    PathPicture picture(scene, batches, options, monitor, time_left);
    picture.trace();
    batches.end();
    return picture.result();
}

}  // namespace

PathTracing trace_instant_picture(const Scene& scene, const RayCaster& ray_caster, const PathStart& start,
                                  const PathOptions& options, const Monitor& monitor) {
    require_valid(options);
    if (options.light_walks < 1)
        throw InputError(fmt::format("{} walks from the light sources: expected 1 or more", options.light_walks));
    ray_caster.require_made_for(scene);
    give_order(monitor.ranks, {.kind = LightOrder::Kind::instant_picture, .options = options}, start);
    StopRequest time_left;
    time_left.limit_time(StopRequest::Clock::now(), options.time);
    const TracedScene traced(scene, ray_caster, nullptr);
    PathScene paths = traced.paths(start, options, TracedScene::batch_size(options.samples, min_batches));
    VirtualLights lights = traced.virtual_lights(options);
    paths.virtual_lights = &lights;
    return draw(paths, options, monitor, time_left, &lights);
}

PathTracing trace_picture(const Scene& scene, const RayCaster& ray_caster, const PathStart& start,
                          const PathOptions& options, const Monitor& monitor, const KnownIrradiance* known) {
    require_valid(options);
    ray_caster.require_made_for(scene);
    const bool is_hybrid = known && known->is_interpolated;
    give_order(monitor.ranks,
               {.kind = LightOrder::Kind::picture,
                .options = options,
                .is_known = known != nullptr,
                .is_interpolated = is_hybrid},
               start);
    StopRequest time_left;
    time_left.limit_time(StopRequest::Clock::now(), options.time);
    const TracedScene traced(scene, ray_caster, known);
    const std::size_t usual_batch = TracedScene::batch_size(options.samples, min_batches);
    PathScene path_scene =
        traced.paths(start, options, is_limited(options) ? std::min(usual_batch, small_batch) : usual_batch);
    if (!known) return draw(path_scene, options, monitor, time_left);
    const CommonStop stop(monitor.stop, monitor.ranks);
    const std::vector<SurfacePoint> points = first_points(path_scene, stop.within_process());
    const KnownLight light = traced.known_light(path_scene, points);
    path_scene.known = &light;
    if (!is_hybrid) return draw(path_scene, options, monitor, time_left);
    path_scene.batch_size = std::max(path_scene.batch_size, small_batch);
    constexpr double share_of_records = 0.25;  // of the time; roughly
    const IndirectField field(path_scene, points, monitor_section(monitor, 0, share_of_records));
    path_scene.indirect_field = &field;
    const SkyGuide guide(path_scene, field, stop);
    path_scene.sky_guide = &guide;
    const std::int64_t rays = field.rays() + guide.rays();
    PathTracing result = draw(path_scene, options, monitor_section(monitor, share_of_records, 1, rays), time_left);
    result.rays += rays;
    return result;
}

KnownIrradiance known_irradiance(const Scene& scene, const ElementForest& forest, std::span<const Rgb> irradiance) {
    forest.require_made_for(scene);
    require_values_of_elements(forest, irradiance.size(), "irradiance");
    return {forest, irradiance};
}

PathStart start_at_camera(const View& view, const PathOptions& options, const Imath::V3d& origin) {
    constexpr float degree = std::numbers::pi_v<float> / 180;
    const Camera camera(view, options.width, options.height, origin);
    if (view.extent > 0) return {camera, 0, {}, view.extent / static_cast<float>(options.height)};
    return {camera, 2 * std::tan(view.fov / 2 * degree) / static_cast<float>(options.height)};
}

}  // namespace interflect::detail
