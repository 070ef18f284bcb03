#pragma once

#include <cstdint>

#include "interflect/solver/solve.h"

namespace interflect {

/// One iteration to come.
struct IterationPlan {
    std::int64_t rays = 0;  ///< 0: the run is over.
    bool warms_up = false;  ///< It is not averaged: the next one takes its place.
};

/// How many rays the next iteration gets. Iterations are averaged by their ray counts, tau = N_m / (N_1 + ... + N_m) in
/// Eq. 6, which is the paper's 1/m when all have the same; without a fixed size they grow with what was averaged
/// before, so that early iterations, which still lack late bounces and a fine mesh, soon weigh little.
class Schedule {
  public:
    Schedule(const SolveOptions& options, std::size_t patches);

    /// Rays for the incremental start.
    std::int64_t start_rays() const { return smallest_; }
    /// Enters the incremental start's rays; those that carried power are the first term of the average.
    void began_with(std::int64_t power_rays, std::int64_t other_rays);
    /// @param seconds  Since the run began.
    IterationPlan next(double seconds) const;
    void done(const IterationPlan& plan);

    std::int64_t rays() const { return rays_; }
    std::int64_t averaged_rays() const { return averaged_rays_; }

  private:
    SolveOptions options_;
    std::int64_t smallest_;           // rays of the first iteration
    std::int64_t rays_ = 0;           // traced so far
    std::int64_t averaged_rays_ = 0;  // of them in the running mean
    int finished_ = 0;                // iterations
};

/// Estimates the error of the running mean from the iterations themselves. One iteration of N rays has the variance
/// S^2 / N, the mean of M earlier rays S^2 / M, and they are independent, so the weighted mean square of their
/// difference, divided by 1/N + 1/M, estimates S^2; the error of the mean is then S / sqrt(M + N). Sobol' points of
/// successive iterations repel each other, which makes this an overestimate.
class ErrorEstimate {
  public:
    /// What is added up over the elements.
    struct Sums {
        double weight = 0, square = 0, received = 0;

        /// @param element_weight  How much the element counts: V with a view, area without.
        /// @param mean, fresh     Luminance of what counts: of the running mean, and of the new estimate.
        void add(double element_weight, double mean, double fresh) {
            weight += element_weight;
            square += element_weight * (fresh - mean) * (fresh - mean);
            received += element_weight * fresh;
        }
        Sums& operator+=(const Sums& other) {
            weight += other.weight;
            square += other.square;
            received += other.received;
            return *this;
        }
    };

    /// Call before the merge. @param mean_rays  Of the running mean. @param rays  Of the new estimate.
    void add(const Sums& sums, std::int64_t mean_rays, std::int64_t rays);
    /// Relative to the weighted mean of the last call; infinite before the first.
    double relative(std::int64_t averaged_rays) const;
    int terms() const { return terms_; }  ///< Calls of add().

  private:
    double variance_sum_ = 0;  // of S^2 [irradiance^2]
    int terms_ = 0;
    double mean_ = 0;
};

}  // namespace interflect
