#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interflect/elements/forest.h"

namespace interflect::inline detail {

/// Patches that are close to each other: a binary tree, halved again and again along the longest axis of the box around
/// their centres until every patch is alone. 4 bytes a patch.
class Neighbourhoods {
  public:
    Neighbourhoods() = default;  ///< None.
    explicit Neighbourhoods(const ElementForest& forest);

    bool empty() const { return patches_.empty(); }

    /// Moves every patch's value by a share of the way to its neighbourhood's mean, and that likewise towards the mean
    /// of the next larger one.
    /// @param values  Per area, one for each patch. @param share  In [0, 1].
    void smooth(const ElementForest& forest, std::span<float> values, float share) const;

  private:
    std::vector<std::uint32_t> patches_;  // a neighbourhood is a range of them, its halves are the next smaller ones
};

}  // namespace interflect::inline detail
