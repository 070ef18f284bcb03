#include "interflect/render/path_tracer.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <vector>

#include "interflect/base/error.h"
#include "interflect/base/parallel.h"
#include "interflect/base/points.h"
#include "interflect/base/random.h"
#include "interflect/geometry/patch_geometry.h"
#include "interflect/raycast/camera.h"
#include "interflect/render/light_tree.h"

namespace interflect {

namespace {

constexpr float pi = std::numbers::pi_v<float>;

/// Batches that a pixel's samples are divided into, at least: 7 degrees of freedom for its standard error.
constexpr int least_batches = 8;
/// Samples of a batch, at most: beyond them stratification gains little, and more batches tell the error better.
constexpr int largest_batch = 64;
/// Paths that advance together, about: many enough to hide the cost of a call, few enough to stay in the cache.
constexpr std::size_t paths_per_tile = 2048;
/// Paths between two reports of progress, about.
constexpr std::size_t paths_per_chunk = std::size_t{1} << 18;
/// Throughput below which Russian roulette ends paths. Lower: less variance, longer paths; from 0.25 to 1 it is all
/// one.
constexpr float roulette_threshold = 0.5f;
/// Vertices of a path with Sobol' points; later ones gain nothing by them and get pseudo-random numbers.
constexpr std::uint32_t stratified_vertices = 4;
/// Variance is averaged over the pixels at most this far away, in columns and in rows.
constexpr int neighbourhood_radius = 3;

double mean_channel(const RgbD& c) { return channel_sum(c) / 3; }

/// What all paths share.
struct PathScene {
    const Scene& scene;
    const RayCaster& ray_caster;
    Camera camera;
    std::vector<PatchGeometry> geometry;  // of each patch
    LightTree lights;
    EmitterSampling sampling;
    std::uint64_t seed;
    int width;
    std::size_t batch_size;

    const Material& material(std::uint32_t patch) const { return scene.materials[scene.patches[patch].material]; }
};

std::vector<PatchGeometry> geometry_of(const Scene& scene) {
    std::vector<PatchGeometry> geometry;
    geometry.reserve(scene.patches.size());
    for (const Patch& patch : scene.patches) geometry.emplace_back(scene, patch);
    return geometry;
}

/// Two unit vectors that make a right-handed frame with the unit vector n (Duff et al. 2017).
struct TangentFrame {
    V3f s, t;
    explicit TangentFrame(const V3f& n) {
        const float sign = std::copysign(1.0f, n.z), a = -1 / (sign + n.z), b = n.x * n.y * a;
        s = V3f(1 + sign * n.x * n.x * a, sign * b, -sign * n.x);
        t = V3f(b, sign + n.y * n.y * a, -n.y);
    }
};

/// A direction with density cosine / pi over the hemisphere of n: Malley's method.
V3f cosine_direction(const V3f& n, float a, float b) {
    const TangentFrame frame(n);
    const float radius = std::sqrt(a), height = std::sqrt(1 - a), turn = 2 * pi * b;
    return frame.s * (radius * std::cos(turn)) + frame.t * (radius * std::sin(turn)) + n * height;
}

/// Where a ray leaves the patch that another has hit at x: on the patch's surface, up by the ray caster's offset.
V3f offset_origin(const PathScene& s, std::uint32_t patch, const V3f& x) {
    const PatchGeometry& geometry = s.geometry[patch];
    return geometry.point(geometry.parameters_of(x)) + geometry.normal() * s.ray_caster.ray_offset(patch);
}

/// The random numbers of one vertex of a path.
struct VertexSample {
    double light;            // chooses the emitting patch
    float light_u, light_v;  // and the point on it
    float direction_u, direction_v;
    float roulette;
};

VertexSample vertex_sample(std::uint64_t batch_key, std::uint32_t vertex, std::uint32_t index) {
    const std::uint64_t key = mix(batch_key, vertex);
    const auto words = random_words(key, index);
    if (vertex > stratified_vertices) {
        const auto more = random_words(~key, index);
        return {(words[0] + 0.5) * 0x1p-32, unit_float(words[1]), unit_float(words[2]),
                unit_float(words[3]),       unit_float(more[0]),  unit_float(more[1])};
    }
    const auto of_light = shuffled_point(mix(key, 1), index), of_direction = shuffled_point(mix(key, 2), index);
    // A point is the middle of one of 2^23 cells, too coarse for one of millions of lamps: move it within its cell.
    const double within_cell = (words[0] + 0.5) * 0x1p-32 - 0.5;
    return {
        of_light[0] + within_cell * 0x1p-23, of_light[1], of_light[2], of_direction[0], of_direction[1], of_light[3]};
}

/// Density per solid angle, seen from x over normal n, of sampling a point of an emitting patch in this direction.
float light_density(const PatchGeometry& lamp, float probability, const V3f& direction, float distance2) {
    const float cosine = -lamp.normal().dot(direction);
    return cosine > 0 ? probability * distance2 / (lamp.area() * cosine) : 0;
}

/// The balance heuristic: the weight of a sample of density p where another technique has density q.
float balance(float p, float q) { return p / (p + q); }

/// One batch of a pixel, and its outcome: sums over the batch's paths.
struct BatchOfPaths {
    std::uint32_t pixel = 0, batch = 0;
    bool done = false;
    RgbD emitted{0, 0, 0};  // seen directly
    RgbD reflected{0, 0, 0};
};

struct RayCounts {
    std::int64_t rays = 0, shadow_rays = 0, escaped_rays = 0;
    RayCounts& operator+=(const RayCounts& o) {
        rays += o.rays;
        shadow_rays += o.shadow_rays;
        escaped_rays += o.escaped_rays;
        return *this;
    }
};

/// Some batches, whose paths advance side by side: all of them by a bounce, then all by the next.
class Wavefront {
  public:
    explicit Wavefront(const PathScene& scene) : s_(scene) {}

    void trace(std::span<BatchOfPaths> batches) {
        start_paths(batches);
        for (vertex_ = 1; !paths_.empty(); ++vertex_) advance_paths();
        for (std::size_t i = 0; i < light_.size(); ++i) {
            BatchOfPaths& batch = batches[i / s_.batch_size];
            batch.emitted += RgbD(light_[i].emitted);
            batch.reflected += RgbD(light_[i].reflected);
            batch.done = true;
        }
    }
    const RayCounts& counts() const { return counts_; }

  private:
    struct Path {
        Rgb throughput;
        std::uint32_t index;  // in light_
        V3f normal;           // of the surface that its ray leaves
    };
    struct PathLight {
        Rgb emitted{0, 0, 0}, reflected{0, 0, 0};
    };
    /// What a shadow ray brings if it hits the patch that it is sent to.
    struct Connection {
        std::uint32_t patch, index;
        Rgb radiance;
    };

    void start_paths(std::span<const BatchOfPaths> batches) {
        const std::size_t size = s_.batch_size;
        thread_local PointBlock points;
        light_.assign(batches.size() * size, {});
        for (const BatchOfPaths& b : batches) {
            const std::uint64_t key = mix(mix(s_.seed, b.pixel), b.batch);
            keys_.push_back(key);
            fill_points(PointSet::sobol, key, 0, size, points);
            const auto width = static_cast<std::uint32_t>(s_.width);
            const std::uint32_t column = b.pixel % width, row = b.pixel / width;
            const auto left = static_cast<float>(column), top = static_cast<float>(row);
            for (std::size_t i = 0; i < size; ++i) {
                rays_.push_back(s_.camera.ray(left + points.coordinate[0][i], top + points.coordinate[1][i]));
                paths_.push_back({Rgb(1, 1, 1), static_cast<std::uint32_t>(paths_.size()), V3f(0, 0, 0)});
            }
        }
    }

    /// Traces the rays of all paths and keeps those that go on.
    void advance_paths() {
        hits_.resize(rays_.size());
        s_.ray_caster.trace(rays_, hits_);
        counts_.rays += static_cast<std::int64_t>(rays_.size());
        shadow_rays_.clear();
        connections_.clear();
        std::size_t alive = 0;
        for (std::size_t i = 0; i < rays_.size(); ++i) {
            Path path = paths_[i];
            Ray ray = rays_[i];
            if (!interact(hits_[i], ray, path)) continue;
            rays_[alive] = ray;
            paths_[alive++] = path;
        }
        rays_.resize(alive);
        paths_.resize(alive);
        trace_shadow_rays();
    }

    /// What happens where a ray hits; afterwards `ray` and `path` are the reflected ones. @return Whether it goes on.
    bool interact(const Hit& hit, Ray& ray, Path& path) {
        if (hit.patch == none) {
            ++counts_.escaped_rays;
            return false;
        }
        const Material& material = s_.material(hit.patch);
        if (channel_sum(material.exitance) > 0) add_emission(hit, ray, path, material.exitance);

        path.throughput *= material.reflectance;
        if (largest_channel(path.throughput) <= 0) return false;
        const std::uint32_t size = static_cast<std::uint32_t>(s_.batch_size);
        const VertexSample sample = vertex_sample(keys_[path.index / size], vertex_, path.index % size);
        ray.origin = offset_origin(s_, hit.patch, ray.origin + hit.distance * ray.direction);
        path.normal = s_.geometry[hit.patch].normal();
        if (s_.sampling != EmitterSampling::directions) connect_to_light(ray.origin, path, sample);

        const float survival = std::min(1.0f, largest_channel(path.throughput) / roulette_threshold);
        if (sample.roulette >= survival) return false;
        path.throughput /= survival;
        ray.direction = cosine_direction(path.normal, sample.direction_u, sample.direction_v);
        return true;
    }

    /// Light from the emitting patch that a ray has hit.
    void add_emission(const Hit& hit, const Ray& ray, const Path& path, const Rgb& exitance) {
        const Rgb radiance = path.throughput * exitance / pi;
        if (vertex_ == 1) {
            light_[path.index].emitted += radiance;
            return;
        }
        float weight = 1;
        if (s_.sampling == EmitterSampling::lights) weight = 0;
        if (s_.sampling == EmitterSampling::combined) {
            const float probability = s_.lights.probability(hit.patch, ray.origin, path.normal);
            const float of_light =
                light_density(s_.geometry[hit.patch], probability, ray.direction, hit.distance * hit.distance);
            weight = balance(path.normal.dot(ray.direction) / pi, of_light);
        }
        light_[path.index].reflected += radiance * weight;
    }

    /// Next event estimation. @param path  Of which the throughput has the reflectance at x.
    void connect_to_light(const V3f& x, const Path& path, const VertexSample& sample) {
        const LightTree::Choice choice = s_.lights.choose(x, path.normal, sample.light);
        if (choice.patch == none) return;
        const PatchGeometry& lamp = s_.geometry[choice.patch];
        const V3f to_light = lamp.point(lamp.uniform_parameters(sample.light_u, sample.light_v)) - x;
        const float distance2 = to_light.length2();
        if (!(distance2 > 0)) return;
        const V3f direction = to_light / std::sqrt(distance2);
        const float of_direction = path.normal.dot(direction) / pi;  // density; also cosine / pi
        const float of_light = light_density(lamp, choice.probability, direction, distance2);
        if (!(of_direction > 0 && of_light > 0)) return;
        const float weight = s_.sampling == EmitterSampling::lights ? 1 : balance(of_light, of_direction);
        // The integral over the hemisphere of (rho / pi) (M / pi) cosine.
        const Rgb radiance = s_.material(choice.patch).exitance / pi;
        shadow_rays_.push_back({x, direction});
        connections_.push_back(
            {choice.patch, path.index, path.throughput * radiance * (of_direction / of_light * weight)});
    }

    void trace_shadow_rays() {
        hits_.resize(shadow_rays_.size());
        s_.ray_caster.trace(shadow_rays_, hits_);
        counts_.rays += static_cast<std::int64_t>(shadow_rays_.size());
        counts_.shadow_rays += static_cast<std::int64_t>(shadow_rays_.size());
        for (std::size_t i = 0; i < connections_.size(); ++i)
            if (hits_[i].patch == connections_[i].patch)
                light_[connections_[i].index].reflected += connections_[i].radiance;
    }

    const PathScene& s_;
    std::uint32_t vertex_ = 1;         // which vertex of the paths comes next; the camera is vertex 0
    std::vector<std::uint64_t> keys_;  // of each batch
    std::vector<PathLight> light_;     // of each path, those that have ended too
    std::vector<Path> paths_;          // those that go on, as are rays_
    std::vector<Ray> rays_, shadow_rays_;
    std::vector<Hit> hits_;
    std::vector<Connection> connections_;
    RayCounts counts_;
};

/// Mean and variance of a pixel's batches, gathered one by one (Welford 1962).
struct PixelStatistics {
    RgbD mean{0, 0, 0}, squares{0, 0, 0};  // squares: sum of squared differences from the mean
    double reflected = 0;                  // mean over the batches of the channels' mean
    std::uint32_t batches = 0;

    void add(const BatchOfPaths& b, double batch_size) {
        ++batches;
        const double count = batches;
        const RgbD value = (b.emitted + b.reflected) / batch_size, difference = value - mean;
        mean += difference / count;
        squares += difference * (value - mean);
        reflected += (mean_channel(b.reflected) / batch_size - reflected) / count;
    }
    /// Of one batch.
    RgbD variance() const { return batches > 1 ? squares / (batches - 1.0) : RgbD(0, 0, 0); }
    RgbD squared_error() const { return batches > 1 ? variance() / static_cast<double>(batches) : RgbD(0, 0, 0); }
};

using Statistics = std::vector<PixelStatistics>;

double mean_reflected(const Statistics& pixels) {
    double sum = 0;
    for (const PixelStatistics& p : pixels) sum += p.reflected;
    return sum / static_cast<double>(pixels.size());
}

/// What a pixel's error is measured against.
double error_scale(const PixelStatistics& p, double picture_mean) {
    return std::max(mean_channel(p.mean), picture_mean);
}

double relative_error(const Statistics& pixels) {
    const double picture_mean = mean_reflected(pixels);
    double sum = 0;
    for (const PixelStatistics& p : pixels) {
        const double scale = error_scale(p, picture_mean);
        if (scale > 0) sum += mean_channel(p.squared_error()) / (scale * scale);
    }
    return std::sqrt(sum / static_cast<double>(pixels.size()));
}

/// Means over the pixels at most `neighbourhood_radius` away along one axis of a picture.
std::vector<double> mean_along(const std::vector<double>& values, std::size_t lines, std::size_t line_step,
                               std::size_t length, std::size_t step) {
    std::vector<double> means(values.size());
    for (std::size_t line = 0; line < lines; ++line)
        for (std::size_t i = 0; i < length; ++i) {
            const std::size_t first = i - std::min<std::size_t>(i, neighbourhood_radius);
            const std::size_t end = std::min(length, i + neighbourhood_radius + 1);
            double sum = 0;
            for (std::size_t k = first; k < end; ++k) sum += values[line * line_step + k * step];
            means[line * line_step + i * step] = sum / static_cast<double>(end - first);
        }
    return means;
}

/// How many batches each pixel should have in all for the target, by the variance around it.
std::vector<double> needed_batches(const Statistics& pixels, const PathOptions& options) {
    const double picture_mean = mean_reflected(pixels);
    std::vector<double> variance(pixels.size());
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const double scale = error_scale(pixels[i], picture_mean);
        variance[i] = scale > 0 ? mean_channel(pixels[i].variance()) / (scale * scale) : 0;
    }
    const auto width = static_cast<std::size_t>(options.width), height = static_cast<std::size_t>(options.height);
    variance = mean_along(variance, height, width, width, 1);
    variance = mean_along(variance, width, 1, height, width);
    for (double& v : variance) v /= options.until * options.until;
    return variance;
}

/// A picture in the making.
class PathPicture {
  public:
    PathPicture(const PathScene& scene, const PathOptions& options, const PathMonitor& monitor)
        : s_(scene),
          options_(options),
          monitor_(monitor),
          pixels_(static_cast<std::size_t>(options.width) * static_cast<std::size_t>(options.height)) {}

    void trace() {
        const auto batch = static_cast<int>(s_.batch_size);
        const auto least = static_cast<std::uint32_t>((options_.samples + batch - 1) / batch);
        const auto most =
            static_cast<std::uint32_t>((std::max(options_.max_samples, options_.samples) + batch - 1) / batch);
        std::vector<std::uint32_t> wanted(pixels_.size(), least);
        foreseen_ = static_cast<double>(least) * static_cast<double>(pixels_.size());
        trace_round(wanted);
        if (options_.until <= 0) return;
        while (!stopped() && want_more(wanted, most)) trace_round(wanted);
        if (!stopped()) report(1);
    }

    PathTracing result() const {
        PathTracing result;
        result.image = Image(options_.width, options_.height);
        result.standard_error = Image(options_.width, options_.height);
        for (std::size_t i = 0; i < pixels_.size(); ++i) {
            const RgbD e = pixels_[i].squared_error();
            result.image.pixels[i] = Rgb(pixels_[i].mean);
            result.standard_error.pixels[i] = Rgb(RgbD(std::sqrt(e.x), std::sqrt(e.y), std::sqrt(e.z)));
        }
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
    bool stopped() const { return monitor_.stop && *monitor_.stop; }

    /// @return Whether a pixel needs more than it has.
    bool want_more(std::vector<std::uint32_t>& wanted, std::uint32_t most) {
        const std::vector<double> needed = needed_batches(pixels_, options_);
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

    /// Traces the batches that pixels lack: all of them one, then all that lack more another one, and so on.
    void trace_round(const std::vector<std::uint32_t>& wanted) {
        const std::size_t per_chunk = paths_per_chunk / s_.batch_size;
        std::vector<std::uint32_t> present(pixels_.size());
        for (std::size_t i = 0; i < pixels_.size(); ++i) present[i] = pixels_[i].batches;
        std::vector<BatchOfPaths> chunk;
        for (bool more = true; more;) {
            more = false;
            for (std::uint32_t i = 0; i < pixels_.size(); ++i) {
                if (present[i] >= wanted[i]) continue;
                chunk.push_back({i, present[i]++});
                more = true;
                if (chunk.size() >= per_chunk) trace_chunk(chunk);
            }
        }
        trace_chunk(chunk);
    }

    void trace_chunk(std::vector<BatchOfPaths>& chunk) {
        if (chunk.empty() || stopped()) return chunk.clear();
        const std::size_t per_tile = std::max<std::size_t>(1, paths_per_tile / s_.batch_size);
        std::vector<RayCounts> counts((chunk.size() + per_tile - 1) / per_tile);
        parallel_for_ranges(chunk.size(), per_tile, [&](std::size_t begin, std::size_t end) {
            if (stopped()) return;
            Wavefront wavefront(s_);
            wavefront.trace(std::span(chunk).subspan(begin, end - begin));
            counts[begin / per_tile] = wavefront.counts();
        });
        for (const RayCounts& c : counts) counts_ += c;
        for (const BatchOfPaths& batch : chunk) {
            if (!batch.done) continue;
            pixels_[batch.pixel].add(batch, static_cast<double>(s_.batch_size));
            ++batches_done_;
        }
        chunk.clear();
        report(std::min(1.0, static_cast<double>(batches_done_) / foreseen_));
    }

    void report(double fraction) const {
        if (monitor_.on_progress) monitor_.on_progress({counts_.rays, fraction, relative_error(pixels_)});
    }

    const PathScene& s_;
    const PathOptions& options_;
    const PathMonitor& monitor_;
    Statistics pixels_;
    double foreseen_ = 0;  // batches in all
    std::int64_t batches_done_ = 0;
    RayCounts counts_;
};

void require_valid(const PathOptions& options) {
    if (options.samples < 2)
        throw InputError(
            fmt::format("{} samples a pixel: expected 2 or more, whose spread tells the error", options.samples));
    if (!(options.until >= 0 && std::isfinite(options.until)))
        throw InputError(fmt::format("a relative error of {}: expected 0 or more", options.until));
    if (options.until > 0 && options.max_samples < options.samples)
        throw InputError(fmt::format("at most {} samples a pixel: expected no less than the least, {}",
                                     options.max_samples, options.samples));
}

std::size_t batch_size_for(int samples) {
    return std::bit_floor(static_cast<unsigned>(std::clamp(samples / least_batches, 1, largest_batch)));
}

}  // namespace

PathTracing trace_paths(const Scene& scene, const RayCaster& ray_caster, const View& view, const PathOptions& options,
                        const PathMonitor& monitor) {
    require_valid(options);
    ray_caster.require_made_for(scene);
    const Camera camera(view, options.width, options.height, scene.origin);
    std::vector<PatchGeometry> geometry = geometry_of(scene);
    LightTree lights(scene, geometry);
    const PathScene path_scene{scene,
                               ray_caster,
                               camera,
                               std::move(geometry),
                               std::move(lights),
                               options.emitter_sampling,
                               options.seed,
                               options.width,
                               batch_size_for(options.samples)};
    PathPicture picture(path_scene, options, monitor);
    picture.trace();
    return picture.result();
}

}  // namespace interflect
