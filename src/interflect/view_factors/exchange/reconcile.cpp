#include <algorithm>
#include <array>
#include <cmath>

#include "interflect/base/threads/parallel.h"
#include "interflect/base/threads/stop_request.h"
#include "interflect/view_factors.h"
#include "interflect/view_factors/exchange/exchange.h"

namespace interflect {

using namespace detail;

namespace {

/// Tolerance of closure, relative to the area of each row: below the rounding of a sum of floats.
constexpr double tolerance = 1e-8;
/// Far above the numbers in use: 1 to 3 solves with 4 to 26 iterations in total (docs/method/view-factors.md).
constexpr int max_solves = 50, max_iterations = 1000;

/// Weighted least squares: minimises sum (X - Y)^2 / V over X >= 0 whose rows sum to the areas, for the values Y and
/// variances V of an ExchangeAreas. Its solution is X_ij = max(0, Y_ij + V_ij (lambda_i + lambda_j)), or without
/// lambda_j if the directions are independent. Newton's method finds the multipliers lambda: each solve has a symmetric
/// positive semidefinite matrix, of the entries that are currently positive.
class Fit {
  public:
    Fit(const ExchangeAreas& exchange, const std::vector<double>& areas, bool is_symmetric)
        : x_(exchange), areas_(areas), is_symmetric_(is_symmetric), lambda_(areas.size(), 0.0) {}

    void run(const StopRequest& stop, Reconciliation& result) {
        for (std::vector<double> rest = residual(); largest_relative(rest) > tolerance && result.solves < max_solves;
             rest = residual()) {
            solve(rest, stop, result.iterations);
            ++result.solves;
        }
    }

    double fitted(std::size_t i, std::size_t entry) const {
        const auto j = static_cast<std::size_t>(x_.columns[entry]);
        const double multiplier = is_symmetric_ && j != i ? lambda_[i] + lambda_[j] : lambda_[i];
        return std::max(0.0, x_.values[entry] + x_.variances[entry] * multiplier);
    }
    double fitted_other(std::size_t i, std::size_t c) const {
        return std::max(0.0, x_.other_values[c][i] + x_.other_variances[c][i] * lambda_[i]);
    }

  private:
    template <class Row>
    std::vector<double> by_row(const Row& row) const {
        std::vector<double> result(x_.size());
        parallel_for_ranges(x_.size(), ExchangeAreas::rows_per_task, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) result[i] = row(i);
        });
        return result;
    }

    std::vector<double> residual() const {
        return by_row([&](std::size_t i) {
            double rest = areas_[i];
            for (std::size_t e = x_.begin(i); e < x_.end(i); ++e) rest -= fitted(i, e);
            for (std::size_t c = 0; c < ExchangeAreas::others; ++c) rest -= fitted_other(i, c);
            return rest;
        });
    }

    double largest_relative(const std::vector<double>& rest) const {
        double largest = 0;
        for (std::size_t i = 0; i < rest.size(); ++i)
            if (areas_[i] > 0) largest = std::max(largest, std::abs(rest[i]) / areas_[i]);
        return largest;
    }

    /// Multiplies v by the derivative of the row sums with respect to lambda.
    std::vector<double> multiply(const std::vector<double>& v) const {
        return by_row([&](std::size_t i) {
            double sum = 0;
            for (std::size_t e = x_.begin(i); e < x_.end(i); ++e) {
                if (!(fitted(i, e) > 0)) continue;
                const auto j = static_cast<std::size_t>(x_.columns[e]);
                sum += x_.variances[e] * (is_symmetric_ && j != i ? v[i] + v[j] : v[i]);
            }
            for (std::size_t c = 0; c < ExchangeAreas::others; ++c)
                if (fitted_other(i, c) > 0) sum += x_.other_variances[c][i] * v[i];
            return sum;
        });
    }

    std::vector<double> diagonal() const {
        return by_row([&](std::size_t i) {
            double sum = 0;
            for (std::size_t e = x_.begin(i); e < x_.end(i); ++e)
                if (fitted(i, e) > 0) sum += x_.variances[e];
            for (std::size_t c = 0; c < ExchangeAreas::others; ++c)
                if (fitted_other(i, c) > 0) sum += x_.other_variances[c][i];
            return sum;
        });
    }

    /// Adds the solution of one linear system to lambda: conjugate gradients, preconditioned by the diagonal.
    void solve(std::vector<double> rest, const StopRequest& stop, int& iterations) {
        const std::vector<double> scale = diagonal();
        const auto preconditioned = [&](const std::vector<double>& r) {
            std::vector<double> result(r.size(), 0.0);
            for (std::size_t i = 0; i < r.size(); ++i)
                if (scale[i] > 0) result[i] = r[i] / scale[i];
            return result;
        };
        const auto dot = [](const std::vector<double>& a, const std::vector<double>& b) {
            double sum = 0;
            for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
            return sum;
        };
        std::vector<double> step(rest.size(), 0.0), z = preconditioned(rest), direction = z;
        double rest_z = dot(rest, z);
        for (int k = 0; k < max_iterations && largest_relative(rest) > tolerance / 2; ++k, ++iterations) {
            if (stop.is_due()) throw Interrupted();
            const std::vector<double> image = multiply(direction);
            const double curvature = dot(direction, image);
            if (!(curvature > 0)) break;  // closure contradicts reciprocity, so the rest cannot be reduced
            const double length = rest_z / curvature;
            for (std::size_t i = 0; i < rest.size(); ++i) {
                step[i] += length * direction[i];
                rest[i] -= length * image[i];
            }
            z = preconditioned(rest);
            const double next = dot(rest, z), ratio = next / rest_z;
            rest_z = next;
            for (std::size_t i = 0; i < rest.size(); ++i) direction[i] = z[i] + ratio * direction[i];
        }
        for (std::size_t i = 0; i < rest.size(); ++i) lambda_[i] += step[i];
    }

    const ExchangeAreas& x_;
    const std::vector<double>& areas_;
    const bool is_symmetric_;
    std::vector<double> lambda_;
};

/// Converts fitted exchange areas to factors, in the memory of `x`.
void replace(ViewFactors& factors, ExchangeAreas&& x, const Fit& fit) {
    const auto divided = [](double value, double area) { return static_cast<float>(area > 0 ? value / area : 0); };
    const std::array<std::vector<float>*, ExchangeAreas::others> others{&factors.sky, &factors.ground,
                                                                        &factors.blocked};
    for (std::size_t c = 0; c < ExchangeAreas::others; ++c)
        for (std::size_t i = 0; i < factors.size(); ++i)
            (*others[c])[i] = divided(fit.fitted_other(i, c), factors.areas[i]);
    parallel_for_ranges(factors.size(), ExchangeAreas::rows_per_task, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            for (std::size_t e = x.begin(i); e < x.end(i); ++e) {
                const double value = fit.fitted(i, e), error = std::sqrt(x.variances[e]);
                x.values[e] = divided(value, factors.areas[i]);
                x.variances[e] = divided(error, factors.areas[i]);
            }
    });
    factors.row_offsets = std::move(x.row_offsets);
    factors.columns = std::move(x.columns);
    factors.values = std::move(x.values);
    factors.errors = std::move(x.variances);
}

}  // namespace

Reconciliation reconcile(ViewFactors& factors, const ReconcileOptions& options, const Monitor& monitor) {
    Reconciliation result;
    result.before = consistency(factors);
    ExchangeAreas exchange = options.reciprocity ? symmetric_exchange(factors) : directed_exchange(factors);
    Fit fit(exchange, factors.areas, options.reciprocity);
    try {
        if (options.closure) fit.run(StopRequest(monitor.stop), result);
    } catch (const Interrupted&) {
        throw Stopped("the view factors were not reconciled");
    }
    replace(factors, std::move(exchange), fit);
    result.after = consistency(factors);
    return result;
}

}  // namespace interflect
