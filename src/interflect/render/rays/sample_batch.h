#pragma once

#include <ImathVec.h>

#include <array>
#include <cstdint>

#include "interflect/core.h"

namespace interflect::detail {

/// First hit of a camera ray, or a sum of such hits. All fields are 0 if the ray escapes.
struct FirstHit {
    RgbD albedo{0, 0, 0};
    Imath::V3d normal{0, 0, 0}, position{0, 0, 0};
    double distance = 0;        ///< Distance from the camera, through panes and by mirrors [m].
    double level = 0;           ///< Level of the element times Path::level_samples, if a solution is known.
    double inverse_length = 0;  ///< 1 / length of the first ray from a gauge; 0 if it escapes [1/m].
    double hits = 0;            ///< Number of first rays from gauges that hit a surface.

    FirstHit& operator+=(const FirstHit& o) {
        albedo += o.albedo;
        normal += o.normal;
        position += o.position;
        distance += o.distance;
        level += o.level;
        inverse_length += o.inverse_length;
        hits += o.hits;
        return *this;
    }
};

/// Sums of the light of paths, by the number of reflections.
struct PathLight {
    RgbD emitted{0, 0, 0};    ///< Light that is not reflected.
    RgbD direct{0, 0, 0};     ///< Light that is reflected once.
    RgbD indirect{0, 0, 0};   ///< Light that is reflected more than once.
    double record_error = 0;  ///< Standard error of recorded light, mean channel; common to all paths.
    /// Prediction of direct + indirect light by the first hit alone, from NearbyLight and the elements of a solution; 0
    /// without one.
    RgbD predicted{0, 0, 0};
    /// Squares of the emitted and predicted light of each first hit, mean channel. Their spread shows edges, where
    /// pixels need more first hits; no stated error depends on it. If mirrors and panes split a sample, each path is
    /// squared alone, so the spread is underestimated there.
    double square_of_first_hit = 0;

    PathLight& operator+=(const PathLight& o) {
        emitted += o.emitted;
        direct += o.direct;
        indirect += o.indirect;
        record_error += o.record_error;
        predicted += o.predicted;
        square_of_first_hit += o.square_of_first_hit;
        return *this;
    }
    PathLight operator*(double factor) const {
        return {emitted * factor,      direct * factor,    indirect * factor,
                record_error * factor, predicted * factor, square_of_first_hit * factor};
    }
};

/// Extent of the paths of a batch.
enum class Tracing : std::uint8_t {
    paths,         ///< Whole paths.
    first_hits,    ///< Camera rays that end at their first hit, with emitted and predicted light alone.
    fixed_places,  ///< The same through the first corner of the pixel (first half) and its centre (second half).
};

/// Paths of a pixel or gauge: two halves of equal size, whose difference shows the error. They are independent, except
/// that hybrid shading shares lookups and fits coefficients across them (RecordLookups, DirectLight).
struct SampleBatch {
    std::uint32_t pixel = 0;
    std::uint32_t number = 0;       ///< Number of the batch of its pixel. Batches of different numbers are independent.
    std::uint32_t first_index = 0;  ///< Index of the first path in the sequence of each half.
    std::uint32_t half_size = 1;    ///< Number of paths of each half.
    Tracing tracing = Tracing::paths;
    bool done = false;
    std::array<PathLight, 2> halves{};
    std::array<FirstHit, 2> first{};  ///< Sums of the first hits of each half.
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

}  // namespace interflect::detail
