#pragma once

#include <cstdint>

namespace interflect::inline detail {

/// Counts the words that arrays and includes make the reader read again, and limits them: a file of a few lines can ask
/// for 10^14. A two-sided quadrilateral that defines its own vertices takes 33 words.
class RepeatedWork {
  public:
    /// What opening an included file takes, and going on to the next copy of an array, in the time that words take.
    static constexpr std::uint64_t words_per_include = 50, words_per_copy = 10;

    explicit RepeatedWork(std::uint64_t max_patches) : max_patches_(max_patches) {}

    /// @param patches  Those made so far.
    /// @throws std::invalid_argument  where the words are more than the limit of patches could need, or more than a
    ///         scene of so many patches could.
    void add(std::uint64_t words, std::uint64_t patches);

  private:
    std::uint64_t max_patches_, words_ = 0;
};

}  // namespace interflect::inline detail
