#include "interflect/formats/rad/statements/data.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "interflect/formats/text/line_reader.h"
#include "interflect/formats/text/number.h"

namespace interflect::detail {

namespace {

constexpr std::size_t max_dimensions = 2;

/// Reads numbers; `#` starts a comment.
class Numbers {
  public:
    explicit Numbers(std::string_view text) : lines_(text) {}

    double next(std::string_view expected) {
        while (word_ == words_.size()) {
            if (!lines_.next()) throw std::invalid_argument(fmt::format("it ends where {} is expected", expected));
            const auto words = lines_.words();
            words_.assign(words.begin(),
                          std::find_if(words.begin(), words.end(), [](auto word) { return word.starts_with('#'); }));
            word_ = 0;
        }
        const auto value = parse_number(words_[word_++]);
        if (!value) throw std::invalid_argument(fmt::format("line {}: expected {}", lines_.line(), expected));
        return *value;
    }
    std::size_t count(std::string_view expected, std::size_t least, std::size_t most) {
        const double value = next(expected);
        if (!(value >= static_cast<double>(least) && value <= static_cast<double>(most)) || value != std::floor(value))
            throw std::invalid_argument(
                fmt::format("line {}: expected {} from {} to {}", lines_.line(), expected, least, most));
        return static_cast<std::size_t>(value);
    }

  private:
    LineReader lines_;
    std::vector<std::string_view> words_;
    std::size_t word_ = 0;
};

/// Reads an axis. Two equal ends mean that its coordinates follow.
std::vector<double> read_axis(Numbers& numbers, std::size_t most) {
    const double first = numbers.next("the first coordinate"), last = numbers.next("the last coordinate");
    const std::size_t count = numbers.count("the number of coordinates", 2, most);
    std::vector<double> axis;
    for (std::size_t i = 0; i < count; ++i)
        axis.push_back(first == last
                           ? numbers.next("a coordinate")
                           : first + (last - first) * static_cast<double>(i) / static_cast<double>(count - 1));
    if (std::adjacent_find(axis.begin(), axis.end(), std::greater_equal<>()) != axis.end())
        throw std::invalid_argument("its coordinates must ascend");
    return axis;
}

}  // namespace

double RadData::at(std::span<const double> coordinates) const {
    // Sums over the corners of the cell.
    struct Corner {
        std::size_t index;
        double weight;
    };
    std::vector<Corner> corners{{0, 1}};
    for (std::size_t k = 0; k < axes.size(); ++k) {
        const std::vector<double>& axis = axes[k];
        const double x = coordinates[k];
        if (!(x >= axis.front() && x <= axis.back())) return 0;
        const auto above = std::upper_bound(axis.begin() + 1, axis.end() - 1, x);
        const auto cell = static_cast<std::size_t>(above - axis.begin()) - 1;
        const double share = (x - axis[cell]) / (axis[cell + 1] - axis[cell]);
        std::vector<Corner> refined;
        for (const Corner& corner : corners) {
            refined.push_back({corner.index * axis.size() + cell, corner.weight * (1 - share)});
            refined.push_back({corner.index * axis.size() + cell + 1, corner.weight * share});
        }
        corners = std::move(refined);
    }
    double sum = 0;
    for (const Corner& corner : corners) sum += corner.weight * values[corner.index];
    return sum;
}

RadData parse_rad_data(std::string_view text, std::size_t most) {
    Numbers numbers(text);
    RadData result;
    std::size_t size = 1;
    for (std::size_t left = numbers.count("the number of dimensions", 1, max_dimensions); left > 0; --left) {
        result.axes.push_back(read_axis(numbers, most / size));
        size *= result.axes.back().size();
    }
    for (std::size_t i = 0; i < size; ++i) result.values.push_back(numbers.next("a value"));
    return result;
}

}  // namespace interflect::detail
