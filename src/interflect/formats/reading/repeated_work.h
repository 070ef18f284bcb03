#pragma once

#include <cstdint>

namespace interflect::detail {

/// Limits words repeated by arrays and includes: a short file can request 10^14.
class RepeatedWork {
  public:
    /// Numbers of words that represent the work of an include and of a copy.
    static constexpr std::uint64_t words_per_include = 50, words_per_copy = 10;

    explicit RepeatedWork(std::uint64_t max_patches) : max_patches_(max_patches) {}

    /// @param patches  Number of patches made so far. @throws ReadFault, std::invalid_argument
    void add(std::uint64_t words, std::uint64_t patches);

  private:
    std::uint64_t max_patches_, words_ = 0;
};

}  // namespace interflect::detail
