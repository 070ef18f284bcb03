#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "interflect/base/threads/parallel.h"
#include "interflect/render.h"

namespace interflect::detail {

inline std::size_t pixel_at(int x, int y, int width) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
}

/// Distance between pixels, at least 1.
inline float distance_of(int dx, int dy) { return std::max(1.0f, std::sqrt(static_cast<float>(dx * dx + dy * dy))); }

/// Approximates exp(-d).
inline float exp_minus(float d) {
    const float t = 1 / (1 + d * 0.125f), t2 = t * t, t4 = t2 * t2;
    return t4 * t4;
}

/// Least reflectance by which light is divided to get irradiance.
constexpr float least_albedo = 0.01f;

inline Rgb floored(const Rgb& albedo) {
    return {std::max(albedo.x, least_albedo), std::max(albedo.y, least_albedo), std::max(albedo.z, least_albedo)};
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

    /// Returns the weight of the pair of pixels i and k, `steps` apart: 1 if each lies in the tangent plane of the
    /// other and the normals are equal, 0 without a surface.
    float weight(std::size_t i, std::size_t k, float steps) const {
        float turn2 = 0, above_i = 0, above_k = 0;
        for (std::size_t c = 0; c < 3; ++c) {
            const float turn = normal_[c][i] - normal_[c][k], step = position_[c][k] - position_[c][i];
            turn2 += turn * turn;
            above_i += step * normal_[c][i];
            above_k += step * normal_[c][k];
        }
        constexpr float tiny = 1e-12f;
        const float of_i = footprint_[i] * steps, of_k = footprint_[k] * steps;
        const float height2 =
            std::max(above_i * above_i / (of_i * of_i + tiny), above_k * above_k / (of_k * of_k + tiny));
        return is_hit_[i] * is_hit_[k] * exp_minus(turn2 / normal_scale) * exp_minus(height2);
    }

    /// Computes weight(i + n, k + n, steps) for all n below weights.size().
    void weigh(std::size_t i, std::size_t k, float steps, std::span<float> weights) const {
        std::array<float, 64> block;  // cannot overlap the arguments, so a compiler can use vector code
        for (std::size_t begin = 0; begin < weights.size(); begin += block.size()) {
            const std::size_t count = std::min(block.size(), weights.size() - begin);
            for (std::size_t n = 0; n < count; ++n) block[n] = weight(i + begin + n, k + begin + n, steps);
            std::copy_n(block.begin(), count, weights.begin() + static_cast<std::ptrdiff_t>(begin));
        }
    }

    const int width, height;

  private:
    static constexpr float normal_scale = 0.1f;  // squared difference of normals, about 18 degrees
    static constexpr float plane_scale = 1.5f;   // relative to the pixel spacing
    using Vectors = std::array<std::vector<float>, 3>;

    static Vectors coordinates(const Image& image) {
        Vectors vectors;
        for (int c = 0; c < 3; ++c)
            for (const Rgb& v : image.pixels) vectors[static_cast<std::size_t>(c)].push_back(v[c]);
        return vectors;
    }

    Vectors normal_, position_;
    std::vector<float> footprint_;  // height above the tangent plane that lowers the weight, per step [m]
    std::vector<float> is_hit_;
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

/// Calls visit(i, x, y) for all pixels.
void for_pixels(const Surfaces& surfaces, const auto& visit) {
    parallel_for_ranges(static_cast<std::size_t>(surfaces.height), 8, [&](std::size_t begin, std::size_t end) {
        for (auto y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
            for (int x = 0; x < surfaces.width; ++x) visit(pixel_at(x, y, surfaces.width), x, y);
    });
}

}  // namespace interflect::detail
