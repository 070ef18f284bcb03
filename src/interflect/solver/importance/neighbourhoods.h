#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interflect/elements/forest.h"

namespace interflect::detail {

/// Binary tree of patches, split along the longest axis of their centres.
class Neighbourhoods {
  public:
    Neighbourhoods() = default;
    explicit Neighbourhoods(const ElementForest& forest);

    bool empty() const { return patches_.empty(); }

    /// Moves each neighbourhood's mean towards its parent's by `share`, from the root to the patches.
    /// @param values  Per area, by patch.
    void smooth(const ElementForest& forest, std::span<float> values, float share) const;

  private:
    std::vector<PatchIndex> patches_;  // nodes are ranges, halved recursively
};

}  // namespace interflect::detail
