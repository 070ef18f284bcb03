#pragma once

#include <ImathMatrix.h>

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace interflect::detail {

/// Arguments of MGF's `xf`, applied from left to right to row vectors. Copy k of -a, from 0, repeats its transforms k
/// times; several -a make a grid.
class TransformSequence {
  public:
    /// @throws std::invalid_argument for invalid arguments and scaling by 0.
    explicit TransformSequence(std::span<const std::string_view> arguments);

    bool is_array() const { return !array_sizes_.empty(); }
    std::span<const int> array_sizes() const { return array_sizes_; }  ///< N of each -a, >= 1.

    /// @param copy  One index per -a.
    Imath::M44d matrix(std::span<const int> copy) const;

  private:
    struct Segment {
        Imath::M44d step;  // product of transforms up to the next -i or -a
        int repetitions = 1;
        bool is_array = false;  // the copy's index replaces `repetitions`
    };
    std::vector<Segment> segments_;
    std::vector<int> array_sizes_;
};

/// Advances to the next copy, the last array fastest; returns false after the last.
bool next_index(std::vector<int>& copy, std::span<const int> sizes);

}  // namespace interflect::detail
