#include "interflect/view_factors/exchange/exchange.h"

#include <algorithm>

#include "interflect/base/threads/parallel.h"
#include "interflect/view_factors/exchange/transposed.h"

namespace interflect::detail {

namespace {

double square(double x) { return x * x; }

void add_others(const ViewFactors& f, ExchangeAreas& exchange) {
    const std::array<const std::vector<float>*, ExchangeAreas::others> values{&f.sky, &f.ground, &f.blocked},
        errors{&f.sky_errors, &f.ground_errors, &f.blocked_errors};
    for (std::size_t c = 0; c < ExchangeAreas::others; ++c)
        for (std::size_t i = 0; i < f.size(); ++i) {
            const double value = f.areas[i] * (*values[c])[i];
            exchange.other_values[c].push_back(value);
            exchange.other_variances[c].push_back(value > 0 ? square(f.areas[i] * (*errors[c])[i]) : 0);
        }
}

struct Average {
    double value, variance;  // [m^2], [m^4]
};

/// Averages X_ij and X_ji. Symmetric in i and j, bit for bit.
Average average(const ViewFactors& f, std::size_t i, std::size_t j, ViewFactors::Factor there,
                ViewFactors::Factor back) {
    const double a = f.areas[i], b = f.areas[j];
    if (!(std::min(a, b) > 0)) return {0, 0};
    const double common = (there.value + back.value) / (1 / a + 1 / b);
    const auto weight = [&](double area) { return 1 / (area * std::max(1 - common / area, f.smallest_error())); };
    const double wa = weight(a), wb = weight(b), sum = wa + wb;
    return {(wa * a * there.value + wb * b * back.value) / sum,
            (square(wa * a * there.error) + square(wb * b * back.error)) / square(sum)};
}

/// Counts the entries (j, i) of each row j that are absent although (i, j) exists.
std::vector<std::int64_t> count_absent(const ViewFactors& f) {
    std::vector<std::int64_t> absent(f.size(), 0);
    Transposed transposed(f);
    for (std::size_t i = 0; i < f.size(); ++i)
        for (std::int64_t e = f.row_offsets[i]; e < f.row_offsets[i + 1]; ++e) {
            const auto j = static_cast<std::size_t>(f.columns[static_cast<std::size_t>(e)]);
            absent[j] += transposed.find(i, j) == Transposed::absent;
        }
    return absent;
}

/// Merges two increasing lists of a row: the first `added` entries, and the rest.
void merge_row(ExchangeAreas& x, std::size_t row, std::size_t added) {
    struct Entry {
        std::int32_t column;
        float value, variance;
    };
    std::vector<Entry> first;
    std::size_t write = x.begin(row), read = write + added;
    for (std::size_t e = write; e < read; ++e) first.push_back({x.columns[e], x.values[e], x.variances[e]});
    for (const Entry& entry : first) {
        for (; read < x.end(row) && x.columns[read] < entry.column; ++read, ++write) {
            x.columns[write] = x.columns[read];
            x.values[write] = x.values[read];
            x.variances[write] = x.variances[read];
        }
        x.columns[write] = entry.column;
        x.values[write] = entry.value;
        x.variances[write++] = entry.variance;
    }
}

}  // namespace

ExchangeAreas directed_exchange(const ViewFactors& f) {
    ExchangeAreas x{f.row_offsets, f.columns, f.values, f.errors, {}, {}};
    parallel_for_ranges(f.size(), ExchangeAreas::rows_per_task, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            for (std::size_t e = x.begin(i); e < x.end(i); ++e) {
                x.values[e] = static_cast<float>(f.areas[i] * f.values[e]);
                x.variances[e] = static_cast<float>(square(f.areas[i] * f.errors[e]));
            }
    });
    add_others(f, x);
    return x;
}

ExchangeAreas symmetric_exchange(const ViewFactors& f) {
    // Allocate rows with room for entries whose opposite entry alone exists
    const std::vector<std::int64_t> absent = count_absent(f);
    ExchangeAreas x;
    x.row_offsets.assign(1, 0);
    for (std::size_t i = 0; i < f.size(); ++i)
        x.row_offsets.push_back(x.row_offsets[i] + f.row_offsets[i + 1] - f.row_offsets[i] + absent[i]);
    const auto entries = static_cast<std::size_t>(x.row_offsets.back());
    x.columns.resize(entries);
    x.values.resize(entries);
    x.variances.resize(entries);
    const auto put = [&](std::size_t entry, std::size_t column, const Average& a) {
        x.columns[entry] = static_cast<std::int32_t>(column);
        x.values[entry] = static_cast<float>(a.value);
        x.variances[entry] = static_cast<float>(a.variance);
    };
    // Write the added entries of each row first, then its own entries; both are in increasing order
    std::vector<std::size_t> added(f.size(), 0);
    Transposed transposed(f);
    for (std::size_t i = 0; i < f.size(); ++i) {
        std::size_t own = x.begin(i) + static_cast<std::size_t>(absent[i]);
        for (auto e = static_cast<std::size_t>(f.row_offsets[i]); e < static_cast<std::size_t>(f.row_offsets[i + 1]);
             ++e) {
            const auto j = static_cast<std::size_t>(f.columns[e]);
            const std::int64_t back = transposed.find(i, j);
            ViewFactors::Factor other{0, f.smallest_error()};
            if (back != Transposed::absent)
                other = {f.values[static_cast<std::size_t>(back)], f.errors[static_cast<std::size_t>(back)]};
            const ViewFactors::Factor there{f.values[e], f.errors[e]};
            const Average mean = i == j ? Average{f.areas[i] * there.value, square(f.areas[i] * there.error)}
                                        : average(f, i, j, there, other);
            put(own++, j, mean);
            if (back == Transposed::absent) put(x.begin(j) + added[j]++, i, mean);
        }
    }
    parallel_for_ranges(f.size(), ExchangeAreas::rows_per_task, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) merge_row(x, i, added[i]);
    });
    add_others(f, x);
    return x;
}

}  // namespace interflect::detail
