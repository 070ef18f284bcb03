#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "interflect/core.h"
#include "interflect/render.h"
#include "interflect/render/paths/group_mean.h"
#include "interflect/render/rays/sample_batch.h"

namespace interflect::detail {

/// Relative standard error in hybrid shading above which a pixel or texel gets more samples.
inline constexpr double hybrid_target = 0.06;

/// Independent parts of a pixel's samples, whose spread gives its standard error.
enum class ErrorSource {
    batches,       ///< The halves of a batch share virtual lights.
    half_batches,  ///< Each is a sequence of its own.
    halves,        ///< Two halves, which all batches continue.
};

/// Means over the samples of a pixel or gauge.
class PixelStatistics {
  public:
    /// @param source  Equal for all batches.
    void add(const SampleBatch& batch, ErrorSource source);

    std::uint32_t samples_of_half() const { return samples_; }
    bool has_error() const { return spread_.parts > 1; }
    PathLight half(std::size_t h) const { return sums_[h] * (samples_ > 0 ? 1.0 / samples_ : 0.0); }
    PathLight light() const;
    RgbD mean() const;
    FirstHit first() const;
    double reflected() const { return mean_channel(light().direct + light().indirect); }

    /// Squared standard errors per channel; they include the error of records.
    RgbD squared_error() const { return sampling_error(0) + record_error(); }
    RgbD direct_squared_error() const { return sampling_error(1); }
    RgbD indirect_squared_error() const { return sampling_error(2) + record_error(); }
    /// Returns the squared error of sampling, without the error of records, which more samples do not reduce.
    /// @param part  0: all light, 1: direct, 2: indirect.
    RgbD sampling_error(std::size_t part = 0) const;

  private:
    /// Mean and squared deviations of independent parts (Welford 1962).
    struct Spread {
        std::array<RgbD, 3> mean{RgbD(0), RgbD(0), RgbD(0)}, squares{RgbD(0), RgbD(0), RgbD(0)};
        std::uint32_t parts = 0;
        void add(const PathLight& light);
    };
    RgbD record_error() const;

    std::array<PathLight, 2> sums_{};  // over the samples
    std::uint32_t samples_ = 0;        // of each half
    FirstHit first_sum_;
    Spread spread_;
};

/// Returns Rendering::relative_error.
double relative_error(const std::vector<PixelStatistics>& pixels, const PictureOptions& options);

/// Returns the number of samples of each half by which each pixel reaches the target, from the errors of its
/// neighbours: a pixel's own samples would bias it.
/// @param target  Of the relative standard error.
std::vector<double> needed_samples(const std::vector<PixelStatistics>& pixels, const PictureOptions& options,
                                   double target);

}  // namespace interflect::detail
