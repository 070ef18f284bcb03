#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interflect/elements/forest.h"

namespace interflect::detail {

/// Binary tree of patches. Each node is split at the median along the longest axis of the patches' centres.
class Neighbourhoods {
  public:
    Neighbourhoods() = default;
    explicit Neighbourhoods(const ElementForest& forest);

    bool empty() const { return patches_.empty(); }

    /// Moves the mean of each neighbourhood towards that of its parent by `share`, from the root down to the patches.
    /// @param values  One value per patch, which is a density per area.
    void smooth(const ElementForest& forest, std::span<float> values, float share) const;

  private:
    std::vector<PatchIndex> patches_;  // a node is a range of this array; its children are the halves of the range
};

}  // namespace interflect::detail
