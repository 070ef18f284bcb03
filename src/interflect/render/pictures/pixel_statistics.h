#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "interflect/core.h"
#include "interflect/render.h"
#include "interflect/render/paths/group_mean.h"
#include "interflect/render/rays/sample_batch.h"

namespace interflect::detail {

/// In hybrid shading, a pixel or texel gets more samples if its relative standard error exceeds this.
inline constexpr double hybrid_target = 0.06;

/// Independent parts of a pixel's samples. The variance between the parts gives its standard error.
enum class ErrorSource {
    batches,       ///< Whole batches, because the halves of a batch share virtual lights.
    half_batches,  ///< Half batches, each of which has its own sequence.
    halves,        ///< The two halves of all samples, because all batches continue the same two sequences.
};

/// Means over the samples of a pixel or gauge.
class PixelStatistics {
  public:
    /// Adds a batch. @param source  Must be equal for all batches.
    void add(const SampleBatch& batch, ErrorSource source);
    /// Replaces the predictions of all samples. @param batch  First hits of the same camera rays.
    void replace_prediction(const SampleBatch& batch);
    /// Adds the batch of first hits, which is independent of all others; only for ErrorSource::halves.
    void add_first_hits(const SampleBatch& batch);

    std::uint32_t samples_of_half() const { return samples_; }
    bool has_error() const { return spread_.parts > 1; }
    /// Returns the mean of a half. First hits replace the emitted light, and are a control variate of the reflected
    /// light: mean of (L - predicted) over the paths + mean of predicted over the first hits.
    PathLight half_mean(std::size_t h) const;
    PathLight light() const;
    RgbD mean() const;
    FirstHit first() const;
    double reflected() const { return mean_channel(light().direct + light().indirect); }

    /// Squared standard errors per channel, with the error of records.
    RgbD squared_error() const { return squared_sampling_error(0) + squared_record_error(); }
    RgbD direct_squared_error() const { return squared_sampling_error(1); }
    RgbD indirect_squared_error() const { return squared_sampling_error(2) + squared_record_error(); }
    /// Returns the squared error of sampling, without the error of records, which more samples do not reduce.
    /// @param part  0: all light, 1: direct, 2: indirect.
    RgbD squared_sampling_error(std::size_t part = 0) const;

  private:
    /// Mean and squared deviations of independent parts (Welford 1962).
    struct Spread {
        std::array<RgbD, 3> mean{RgbD(0), RgbD(0), RgbD(0)}, squares{RgbD(0), RgbD(0), RgbD(0)};
        std::uint32_t parts = 0;
        void add(const PathLight& light);
    };
    RgbD squared_record_error() const;

    std::array<PathLight, 2> sums_{};  // sum over the samples of each half
    std::uint32_t samples_ = 0;        // number of samples of each half
    /// Means of emitted and predicted light over the first hits of each half.
    std::array<std::array<Rgb, 2>, 2> first_hits_{};
    std::uint32_t number_of_first_hits_ = 0;  // of each half
    FirstHit first_sum_;                      // over samples and first hits
    Spread spread_;
};

/// Returns Rendering::relative_error.
double relative_error(const std::vector<PixelStatistics>& pixels, const PictureOptions& options);

/// Returns the number of samples of each half that each pixel needs to reach the target. It is estimated from the
/// errors of the pixel's neighbours, because its own samples would bias it.
/// @param target  Target of the relative standard error.
std::vector<double> needed_samples(const std::vector<PixelStatistics>& pixels, const PictureOptions& options,
                                   double target);

/// Emitted and predicted light at the first hits of two camera rays of a pixel, mean channel.
struct LightAtPlaces {
    double corner = 0, centre = 0;  ///< At the corner that the pixel shares with earlier ones, and at the centre.
};

/// Returns the number of first hits, in each half, that the edges and textures of each pixel need in addition to its
/// samples; 0 for most pixels. It is estimated from the samples of the pixel's neighbours, as in needed_samples(), and
/// from `places`, which find edges that all these samples miss.
/// @param places  Light at fixed places of each pixel, independent of all samples.
std::vector<std::uint32_t> needed_first_hits(const std::vector<PixelStatistics>& pixels,
                                             const std::vector<LightAtPlaces>& places, const PictureOptions& options);

}  // namespace interflect::detail
