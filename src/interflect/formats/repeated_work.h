#pragma once

#include <cstdint>

namespace interflect::inline detail {

/// Limits the words that arrays and includes read repeatedly: a file of a few lines can request 10^14. For scale, a
/// two-sided quadrilateral with its own vertices takes 33 words.
class RepeatedWork {
  public:
    /// Cost of opening an include and of starting a copy, in equivalent words.
    static constexpr std::uint64_t words_per_include = 50, words_per_copy = 10;

    explicit RepeatedWork(std::uint64_t max_patches) : max_patches_(max_patches) {}

    /// @param patches  Number of patches so far.
    /// @throws std::invalid_argument  if there are too many words for the limit of patches, or for the patches so far.
    void add(std::uint64_t words, std::uint64_t patches);

  private:
    std::uint64_t max_patches_, words_ = 0;
};

}  // namespace interflect::inline detail
