#include "interflect/formats/reading/repeated_work.h"

#include <fmt/format.h>

#include <stdexcept>

#include "interflect/formats/reading/read_fault.h"

namespace interflect::detail {

namespace {

// Limits of repeated words: a free number, plus a number per patch. A quadrilateral with its vertices takes 33 words.
// The first limit counts the patches that max_patches allows, the second one the patches made so far.
constexpr std::uint64_t free_of_limit = 100'000, words_per_allowed_patch = 25;
constexpr std::uint64_t free_of_made = 50'000'000, words_per_made_patch = 1000;

}  // namespace

void RepeatedWork::add(std::uint64_t words, std::uint64_t patches) {
    words_ += words;
    if (words_ > free_of_limit + words_per_allowed_patch * max_patches_)
        throw ReadFault(
            fmt::format("arrays and includes repeat more than {} patches (max_patches) could need", max_patches_),
            "max_patches");
    if (words_ > free_of_made + words_per_made_patch * patches)
        throw std::invalid_argument(
            fmt::format("arrays and includes repeat {} million words, from which only {} patches were made: expected "
                        "files that include each other, or arrays in each other, fewer times",
                        words_ / 1'000'000, patches));
}

}  // namespace interflect::detail
