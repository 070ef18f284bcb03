#pragma once

#include <ImathMatrix.h>

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace interflect::inline detail {

/// Arguments of MGF's `xf`: -t x y z, -rx -ry -rz degrees, -s factor, -mx -my -mz, -i N, -a N. They act on a point from
/// left to right. -i repeats the following transforms N times, up to the next -i or -a. -a makes N copies; copy k, from
/// 0, repeats the following transforms k times. Several -a make a grid, the last fastest. Matrices are for row vectors,
/// x' = x M, as in Imath.
class TransformSequence {
  public:
    /// @throws std::invalid_argument  with the argument if it is unknown, lacks a number, or scales by 0.
    explicit TransformSequence(std::span<const std::string_view> arguments);

    bool is_array() const { return !array_sizes_.empty(); }
    std::span<const int> array_sizes() const { return array_sizes_; }  ///< N of each -a, >= 1, in order.

    /// Returns the matrix of the copy with these indices, one per -a.
    Imath::M44d matrix(std::span<const int> copy) const;

  private:
    struct Segment {
        Imath::M44d step;  // transforms up to the next -i or -a
        int repetitions = 1;
        bool is_array = false;  // -a: `repetitions` is the index of the copy
    };
    std::vector<Segment> segments_;
    std::vector<int> array_sizes_;
};

/// Advances to the next copy, the last array fastest. @return  false after the last copy, with `copy` reset to the
/// first.
bool next_index(std::vector<int>& copy, std::span<const int> sizes);

}  // namespace interflect::inline detail
