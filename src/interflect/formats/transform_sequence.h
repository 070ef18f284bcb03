#pragma once

#include <ImathMatrix.h>

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace interflect::inline detail {

/// The arguments of MGF's `xf`: -t x y z, -rx -ry -rz degrees, -s factor, -mx -my -mz, -i N, -a N. They act on a point
/// from left to right. -i repeats what follows it, up to the next -i or -a, N times; -a makes N copies, the k-th of
/// which repeats what follows k times, k from 0; several -a make a grid, of which the last runs fastest.
/// Matrices multiply row vectors from the right, as Imath has it: x' = x M.
class TransformSequence {
  public:
    /// @throws std::invalid_argument  with the offending argument, where it is unknown, lacks a number, or scales by 0.
    explicit TransformSequence(std::span<const std::string_view> arguments);

    bool is_array() const { return !array_sizes_.empty(); }
    std::span<const int> array_sizes() const { return array_sizes_; }  ///< N of each -a, in order; every N >= 1.

    /// The matrix of the copy with these indices, one for each -a.
    Imath::M44d matrix(std::span<const int> copy) const;

  private:
    struct Segment {
        Imath::M44d step;       // what stands between this -i or -a and the next
        int repetitions = 1;    // of -i
        bool is_array = false;  // of -a: repetitions is the index of the copy
    };
    std::vector<Segment> segments_;
    std::vector<int> array_sizes_;
};

/// Goes on to the next copy of arrays, the last fastest. @return false after the last one, and then back at the first.
bool next_index(std::vector<int>& copy, std::span<const int> sizes);

}  // namespace interflect::inline detail
