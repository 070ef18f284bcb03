#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "interflect/base/files/state_archive.h"
#include "interflect/base/threads/parallel.h"
#include "interflect/elements/forest.h"

namespace interflect::detail {

/// Number of rays averaged into each element's mean. Siblings have the same.
class History {
  public:
    explicit History(std::uint32_t patches) : patches_(patches), rays_(patches, 0.0f) {}

    float operator[](std::size_t e) const { return rays_[place(e)]; }
    void set(std::size_t e, float rays) { rays_[place(e)] = rays; }  ///< Also sets the siblings.
    std::size_t size() const { return patches_ + 4 * (rays_.size() - patches_); }
    void resize(std::size_t elements) { rays_.resize(place(elements)); }
    void assign(std::size_t elements, float rays) { rays_.assign(place(elements), rays); }
    /// Adds the elements from `first` on, with the history of their parents.
    void grow(const ElementForest& forest, std::uint32_t first) {
        resize(forest.size());
        for (ElementIndex e(first); e < forest.size(); e += 4) set(e, (*this)[forest.parent(e)]);
    }
    /// Replaces each number by changed(e, number), where e is a patch or the first of four siblings.
    template <class Change>
    void change(const Change& changed) {
        parallel_for_indices(rays_.size(), [&](std::size_t i) {
            rays_[i] = changed(ElementIndex(i < patches_ ? i : patches_ + 4 * (i - patches_)), rays_[i]);
        });
    }
    /// @throws std::runtime_error if the numbers are fewer than the patches.
    void archive(StateArchive& archive) {
        archive.amounts("history", rays_);
        StateArchive::require_range(rays_.size() >= patches_, "history");
    }

  private:
    std::size_t place(std::size_t e) const { return e < patches_ ? e : patches_ + (e - patches_) / 4; }

    std::size_t patches_;
    std::vector<float> rays_;  // of the patches, then of each four siblings
};

}  // namespace interflect::detail
