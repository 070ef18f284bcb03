#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interflect/elements/forest.h"

namespace interflect::inline detail {

/// Binary tree of neighbouring patches. Each range is halved along the longest axis of the box around its centres, down
/// to single patches. 4 bytes per patch.
class Neighbourhoods {
  public:
    Neighbourhoods() = default;  ///< Empty.
    explicit Neighbourhoods(const ElementForest& forest);

    bool empty() const { return patches_.empty(); }

    /// Moves the mean of every neighbourhood by `share` towards the smoothed mean of the next larger one, from the root
    /// to the patches. @param values  Per area, one for each patch. @param share  In [0, 1].
    void smooth(const ElementForest& forest, std::span<float> values, float share) const;

  private:
    std::vector<std::uint32_t> patches_;  // a neighbourhood is a range; its halves are the next smaller ones
};

}  // namespace interflect::inline detail
