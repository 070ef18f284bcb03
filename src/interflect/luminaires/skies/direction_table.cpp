#include "interflect/luminaires/skies/direction_table.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace interflect::detail {

namespace {

constexpr double full_turn = 2 * std::numbers::pi;  // [rad]

}  // namespace

double SkyGrid::edge_cosine(std::size_t row) const {
    if (2 * row == rows) return 0;
    return std::cos(std::numbers::pi * static_cast<double>(row) / static_cast<double>(rows));
}

double SkyGrid::solid_angle(std::size_t row) const {
    return full_turn / static_cast<double>(columns) * (edge_cosine(row) - edge_cosine(row + 1));
}

SkyPlace SkyGrid::middle(std::size_t column, std::size_t row) const {
    return {static_cast<float>((static_cast<double>(column) + 0.5) / static_cast<double>(columns)),
            static_cast<float>((edge_cosine(row) + edge_cosine(row + 1)) / 2)};
}

std::size_t SkyGrid::row_of(float cosine) const {
    const double angle = std::acos(std::clamp(static_cast<double>(cosine), -1.0, 1.0));
    return std::min(rows - 1, static_cast<std::size_t>(angle / std::numbers::pi * static_cast<double>(rows)));
}

std::size_t SkyGrid::column_of(float s) const {
    const double column = std::floor(static_cast<double>(s) * static_cast<double>(columns));
    return std::min(columns - 1, static_cast<std::size_t>(std::max(0.0, column)));
}

DirectionTable::DirectionTable(const SkyGrid& grid, std::span<const float> weights)
    : grid_(grid), rows_(grid.rows + 1, 0.0), columns_(grid.size(), 1.0f) {
    for (std::size_t row = 0; row < grid.rows; ++row) {
        const std::size_t first = row * grid.columns;
        double sum = 0;
        for (std::size_t i = 0; i < grid.columns; ++i) sum += static_cast<double>(weights[first + i]);
        double so_far = 0;
        for (std::size_t i = 0; i + 1 < grid.columns; ++i) {
            so_far += static_cast<double>(weights[first + i]);
            if (sum > 0) columns_[first + i] = static_cast<float>(so_far / sum);
        }
        rows_[row + 1] = rows_[row] + sum;
    }
    sum_ = rows_.back();
    if (sum_ > 0)
        for (double& row : rows_) row /= sum_;
}

SkyPlace DirectionTable::sample(float u, float v) const {
    const auto row_end = std::upper_bound(rows_.begin() + 1, rows_.end() - 1, static_cast<double>(v));
    const auto row = static_cast<std::size_t>(row_end - rows_.begin()) - 1;
    const double of_row = rows_[row + 1] - rows_[row];
    const double down = of_row > 0 ? (static_cast<double>(v) - rows_[row]) / of_row : 0.5;
    const float* cells = &columns_[row * grid_.columns];
    const float* cell = std::upper_bound(cells, cells + grid_.columns - 1, u);
    const float before = cell == cells ? 0 : cell[-1], share = *cell - before;
    const double across = share > 0 ? static_cast<double>((u - before) / share) : 0.5;
    const double upper = grid_.edge_cosine(row), lower = grid_.edge_cosine(row + 1);
    return {static_cast<float>((static_cast<double>(cell - cells) + across) / static_cast<double>(grid_.columns)),
            static_cast<float>(upper + (lower - upper) * down)};
}

float DirectionTable::density(const SkyPlace& place) const {
    const std::size_t row = grid_.row_of(place.cosine), column = grid_.column_of(place.s);
    const float* cell = &columns_[row * grid_.columns + column];
    const float before = column == 0 ? 0 : cell[-1];
    return static_cast<float>((rows_[row + 1] - rows_[row]) * static_cast<double>(*cell - before) /
                              grid_.solid_angle(row));
}

}  // namespace interflect::detail
