#include "interflect/render.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "interflect/base/parallel.h"

namespace interflect {

using namespace detail;

namespace {

constexpr int window_radius = 8, patch_radius = 1, variance_radius = 1, mean_radius = 3;  // [pixels]
/// k^2 of Rousselle et al. 2012.
constexpr float noise_share = 0.45f * 0.45f;
/// Actual over estimated variance of hybrid shading, whose batches stratify each other: 0.33 to 0.72 in six scenes.
constexpr float stratified_variance = 0.4f;
/// Share of the noise that reduces the returned differences. With 1, blocks of 9 pixels lose more detail than noise.
constexpr float returned_noise = 0.35f;
constexpr float min_albedo = 0.01f;
constexpr float normal_scale = 0.1f;  // about 18 degrees
constexpr float plane_scale = 1.5f;   // relative to the pixel spacing

/// Approximates exp(-d).
float exp_minus(float d) {
    const float t = 1 / (1 + d * 0.125f), t2 = t * t, t4 = t2 * t2;
    return t4 * t4;
}

/// Irradiance / pi.
struct Field {
    std::array<std::vector<float>, 3> value;
    std::vector<float> grey, variance;
};

std::size_t pixel_at(int x, int y, int width) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
}

Rgb floored(const Rgb& albedo) {
    return {std::max(albedo.x, min_albedo), std::max(albedo.y, min_albedo), std::max(albedo.z, min_albedo)};
}

Field make_field(const Image& light, const std::vector<float>& variance, const Image& albedo) {
    Field field;
    for (std::vector<float>* numbers :
         {&field.value[0], &field.value[1], &field.value[2], &field.grey, &field.variance})
        numbers->resize(light.pixels.size());
    for (std::size_t i = 0; i < light.pixels.size(); ++i) {
        const Rgb reflectance = floored(albedo.pixels[i]), irradiance = light.pixels[i] / reflectance;
        for (int c = 0; c < 3; ++c) field.value[static_cast<std::size_t>(c)][i] = irradiance[c];
        field.grey[i] = channel_sum(irradiance) / 3;
        const float mean = channel_sum(reflectance) / 3;
        field.variance[i] = variance[i] / (mean * mean);
    }
    return field;
}

/// Direct light comes first.
using Fields = std::array<Field, 2>;
std::size_t noisy_kinds(const PictureLayers& layers) { return layers.is_indirect_interpolated ? 1 : 2; }

/// Distance between pixels, at least 1.
float distance_of(int dx, int dy) { return std::max(1.0f, std::sqrt(static_cast<float>(dx * dx + dy * dy))); }

using Vectors = std::array<std::vector<float>, 3>;

Vectors coordinates(const Image& image) {
    Vectors vectors;
    for (int c = 0; c < 3; ++c)
        for (const Rgb& v : image.pixels) vectors[static_cast<std::size_t>(c)].push_back(v[c]);
    return vectors;
}

/// Visible surfaces, by pixel.
class Surfaces {
  public:
    explicit Surfaces(const PictureLayers& layers)
        : width(layers.albedo.width),
          height(layers.albedo.height),
          normal_(coordinates(layers.normal)),
          position_(coordinates(layers.position)) {
        for (const float depth : layers.depth) {
            footprint_.push_back(plane_scale * (depth * layers.pixel_angle + layers.pixel_size));
            is_hit_.push_back(depth > 0 ? 1.0f : 0.0f);
        }
    }

    /// Returns the weight of pixel k for pixel i, `steps` apart: 1 in its tangent plane with equal normals, 0 without a
    /// surface.
    float weight(std::size_t i, std::size_t k, float steps) const {
        float turn2 = 0, height_above = 0;
        for (std::size_t c = 0; c < 3; ++c) {
            const float turn = normal_[c][i] - normal_[c][k];
            turn2 += turn * turn;
            height_above += (position_[c][k] - position_[c][i]) * normal_[c][i];
        }
        const float footprint = footprint_[i] * steps;
        return is_hit_[k] * exp_minus(turn2 / normal_scale) *
               exp_minus(height_above * height_above / (footprint * footprint + 1e-12f));
    }

    /// weight(i + n, k + n, steps) for all n below weights.size().
    void weigh(std::size_t i, std::size_t k, float steps, std::span<float> weights) const {
        std::array<float, 64> some;  // cannot overlap the arguments, so a compiler can use vector code
        for (std::size_t begin = 0; begin < weights.size(); begin += some.size()) {
            const std::size_t count = std::min(some.size(), weights.size() - begin);
            for (std::size_t n = 0; n < count; ++n) some[n] = weight(i + begin + n, k + begin + n, steps);
            std::copy_n(some.begin(), count, weights.begin() + static_cast<std::ptrdiff_t>(begin));
        }
    }

    const int width, height;

  private:
    Vectors normal_, position_;
    std::vector<float> footprint_, is_hit_;
};

/// Calls visit(k, weight) for each pixel k at most `radius` from (x, y) in both directions.
template <class Visit>
void visit_surface(const Surfaces& surfaces, int x, int y, int radius, const Visit& visit) {
    const std::size_t i = pixel_at(x, y, surfaces.width);
    for (int v = std::max(0, y - radius); v <= std::min(surfaces.height - 1, y + radius); ++v)
        for (int u = std::max(0, x - radius); u <= std::min(surfaces.width - 1, x + radius); ++u) {
            const std::size_t k = pixel_at(u, v, surfaces.width);
            visit(k, surfaces.weight(i, k, distance_of(u - x, v - y)));
        }
}

/// Averages over neighbours on the same surface. The variance is large at edges of objects, and must not spread.
std::vector<float> surface_mean(const Surfaces& surfaces, const std::vector<float>& values) {
    const int width = surfaces.width, height = surfaces.height;
    std::vector<float> means(values.size());
    parallel_for_ranges(static_cast<std::size_t>(height), 8, [&](std::size_t begin, std::size_t end) {
        for (auto y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
            for (int x = 0; x < width; ++x) {
                float sum = 0, weight = 0;
                visit_surface(surfaces, x, y, variance_radius, [&](std::size_t k, float w) {
                    sum += w * values[k];
                    weight += w;
                });
                means[pixel_at(x, y, width)] = weight > 0 ? sum / weight : 0;
            }
    });
    return means;
}

Fields make_fields(const PictureLayers& layers, const Surfaces& surfaces, const SampledLight& light) {
    Fields fields{make_field(light.direct, light.direct_variance, layers.albedo),
                  make_field(light.indirect, light.indirect_variance, layers.albedo)};
    for (std::size_t kind = 0; kind < noisy_kinds(layers); ++kind) {
        std::vector<float>& variance = fields[kind].variance;
        variance = surface_mean(surfaces, variance);
        if (layers.is_indirect_interpolated)
            for (float& v : variance) v *= stratified_variance;
    }
    return fields;
}

class Band {
  public:
    Band(const PictureLayers& layers, const Surfaces& surfaces, const std::array<Fields, 2>& halves, int first_row,
         int end_row)
        : layers_(layers),
          surfaces_(surfaces),
          halves_(halves),
          width_(surfaces.width),
          height_(surfaces.height),
          first_(first_row),
          end_(end_row),
          difference_(pixel_at(0, end_row - first_row + 2 * patch_radius, width_ + 2)),
          shape_(at(0, end_row - first_row)) {
        for (auto& of_half : sums_)
            for (Sums& sums : of_half)
                for (auto& channel : sums) channel.assign(shape_.size(), 0.0f);
    }

    /// @param irradiance  Receives the result, over pi.
    void filter(Image& irradiance) {
        for (int dy = -window_radius; dy <= window_radius; ++dy)
            for (int dx = -window_radius; dx <= window_radius; ++dx) {
                compare_shapes(dx, dy);
                for (std::size_t h = 0; h < 2; ++h)
                    for (std::size_t kind = 0; kind < noisy_kinds(layers_); ++kind) {
                        compare_light(halves_[1 - h][kind], dx, dy);
                        add_neighbours(halves_[h][kind], sums_[h][kind], dx, dy);
                    }
            }
        for (int y = first_; y < end_; ++y)
            for (int x = 0; x < width_; ++x) {
                const std::size_t i = at(x, y), k = i - at(0, first_);
                if (!(layers_.depth[i] > 0)) continue;
                for (const auto& of_half : sums_)
                    for (std::size_t kind = 0; kind < noisy_kinds(layers_); ++kind) {
                        const Sums& s = of_half[kind];
                        irradiance.pixels[i] += Rgb(s[0][k], s[1][k], s[2][k]) / (2 * s[3][k]);
                    }
            }
    }

  private:
    using Sums = std::array<std::vector<float>, 4>;

    static constexpr int per_chunk = 64;

    std::size_t at(int x, int y) const { return pixel_at(x, y, width_); }
    /// Index in difference_, which has another column at each end of its rows; row 0 is first_ - patch_radius.
    std::size_t padded(int x, int row) const { return pixel_at(x + 1, row, width_ + 2); }
    std::pair<int, int> columns(int dx) const { return {std::max(0, -dx), std::min(width_, width_ - dx)}; }
    bool has_row(int y) const { return y >= 0 && y < height_; }

    void compare_shapes(int dx, int dy) {
        std::fill(shape_.begin(), shape_.end(), 0.0f);
        const float steps = distance_of(dx, dy);
        const auto [begin, end] = columns(dx);
        if (begin >= end) return;
        for (int y = first_; y < end_; ++y) {
            if (!has_row(y + dy)) continue;
            const auto row = std::span(shape_).subspan(at(begin, y - first_), static_cast<std::size_t>(end - begin));
            surfaces_.weigh(at(begin, y), at(begin + dx, y + dy), steps, row);
        }
    }

    /// Relative to the noise.
    void compare_light(const Field& field, int dx, int dy) {
        constexpr float tiny = 1e-20f;
        std::fill(difference_.begin(), difference_.end(), 0.0f);
        const auto [begin, end] = columns(dx);
        for (int y = first_ - patch_radius; y < end_ + patch_radius; ++y) {
            if (!has_row(y) || !has_row(y + dy)) continue;
            float* row = &difference_[padded(0, y - first_ + patch_radius)];
            const std::size_t i = at(0, y), k = at(0, y + dy) + static_cast<std::size_t>(dx);
            for (int x = begin; x < end; ++x) {
                const auto c = static_cast<std::size_t>(x);
                const float d = field.grey[i + c] - field.grey[k + c];
                const float here = field.variance[i + c], there = field.variance[k + c];
                row[x] = (d * d - (here + std::min(here, there))) / (noise_share * (here + there) + tiny);
            }
            row[-1] = row[0], row[width_] = row[width_ - 1];
        }
    }

    void add_neighbours(const Field& field, Sums& sums, int dx, int dy) const {
        const auto [begin, end] = columns(dx);
        for (int y = first_; y < end_; ++y)
            if (has_row(y + dy))
                for (int x = begin; x < end; x += per_chunk)
                    add_row(field, sums, x, y, at(x + dx, y + dy), std::min(per_chunk, end - x));
    }

    /// Adds pixels k, k + 1, ... to (x, y), (x + 1, y), ...
    void add_row(const Field& field, Sums& sums, int x, int y, std::size_t k, int count) const {
        const std::size_t out = at(x, y - first_);
        std::array<float, per_chunk> weight{};  // cannot overlap the vectors, so a compiler can use vector code
        const float* above = &difference_[padded(x, y - first_)];
        const float *level = above + width_ + 2, *below = level + width_ + 2;
        for (int n = 0; n < count; ++n) {
            float d = 0;
            for (const float* row : {above, level, below}) d += row[n - 1] + row[n] + row[n + 1];
            weight[static_cast<std::size_t>(n)] = exp_minus(std::max(0.0f, d / 9));
        }
        const auto size = static_cast<std::size_t>(count);
        for (std::size_t n = 0; n < size; ++n) weight[n] *= shape_[out + n];
        for (std::size_t channel = 0; channel < 3; ++channel)
            for (std::size_t n = 0; n < size; ++n) sums[channel][out + n] += weight[n] * field.value[channel][k + n];
        for (std::size_t n = 0; n < size; ++n) sums[3][out + n] += weight[n];
    }

    const PictureLayers& layers_;
    const Surfaces& surfaces_;
    const std::array<Fields, 2>& halves_;
    int width_, height_, first_, end_;
    std::vector<float> difference_, shape_;
    std::array<std::array<Sums, 2>, 2> sums_;  // [half][kind of light]
};

/// Light before filtering: mean of both halves.
struct NoisyLight {
    Image irradiance;             // over pi
    std::vector<float> variance;  // of its mean channel
};

NoisyLight noisy_light(const PictureLayers& layers, const std::array<Fields, 2>& halves) {
    NoisyLight light{Image(layers.albedo.width, layers.albedo.height),
                     std::vector<float>(layers.albedo.pixels.size(), 0.0f)};
    for (std::size_t i = 0; i < light.variance.size(); ++i)
        for (const Fields& half : halves)
            for (std::size_t kind = 0; kind < noisy_kinds(layers); ++kind) {
                const auto& value = half[kind].value;
                light.irradiance.pixels[i] += Rgb(value[0][i], value[1][i], value[2][i]) / 2;
                light.variance[i] += half[kind].variance[i] / 4;
            }
    return light;
}

/// Mean of unfiltered minus filtered light around (x, y), reduced by a share of its noise (James-Stein).
Rgb removed_around(const Surfaces& surfaces, const NoisyLight& noisy, const Image& filtered, int x, int y) {
    Rgb removed(0);
    float weight = 0, noise = 0;
    visit_surface(surfaces, x, y, mean_radius, [&](std::size_t k, float w) {
        removed += w * (noisy.irradiance.pixels[k] - filtered.pixels[k]);
        noise += returned_noise * w * w * noisy.variance[k];
        weight += w;
    });
    const float mean = channel_sum(removed) / 3, square = mean * mean;
    return square > noise ? removed * ((1 - noise / square) / weight) : Rgb(0);
}

/// Adds removed_around(), because the filter blurs variations below the noise.
Rgb result_at(const PictureLayers& layers, const Surfaces& surfaces, const NoisyLight& noisy, const Image& filtered,
              int x, int y) {
    const std::size_t i = pixel_at(x, y, filtered.width);
    Rgb light = layers.emitted.pixels[i];
    if (layers.is_indirect_interpolated) light += layers.reflected.indirect.pixels[i];
    if (!(layers.depth[i] > 0)) return light;
    const Rgb irradiance = filtered.pixels[i] + removed_around(surfaces, noisy, filtered, x, y);
    const Rgb albedo = floored(layers.albedo.pixels[i]);
    for (int c = 0; c < 3; ++c) light[c] += std::max(0.0f, irradiance[c]) * albedo[c];
    return light;
}

}  // namespace

Image denoise(const PictureLayers& layers) {
    const int width = layers.albedo.width, height = layers.albedo.height;
    const Surfaces surfaces(layers);
    const std::array<Fields, 2> halves{make_fields(layers, surfaces, layers.halves[0]),
                                       make_fields(layers, surfaces, layers.halves[1])};
    Image filtered(width, height), picture(width, height);
    constexpr std::size_t rows = 16;
    parallel_for_ranges(static_cast<std::size_t>(height), rows, [&](std::size_t begin, std::size_t end) {
        Band(layers, surfaces, halves, static_cast<int>(begin), static_cast<int>(end)).filter(filtered);
    });
    const NoisyLight noisy = noisy_light(layers, halves);
    parallel_for_ranges(static_cast<std::size_t>(height), 1, [&](std::size_t row, std::size_t) {
        const auto y = static_cast<int>(row);
        for (int x = 0; x < width; ++x) picture.at(x, y) = result_at(layers, surfaces, noisy, filtered, x, y);
    });
    return picture;
}

}  // namespace interflect
