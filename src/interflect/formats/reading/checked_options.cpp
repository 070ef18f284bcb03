#include "interflect/formats/reading/checked_options.h"

#include <fmt/format.h>

#include "interflect/core.h"

namespace interflect::detail {

const ReadOptions& checked(const ReadOptions& options) {
    if (options.curve_divisions < 1 || options.curve_divisions > 1000)
        throw InputError(fmt::format("curve_divisions: expected 1 to 1000, not {}", options.curve_divisions));
    if (options.max_patches > 4'000'000'000)
        throw InputError(fmt::format("max_patches: expected at most 4 * 10^9, not {}", options.max_patches));
    if (!(options.unit >= 1e-9 && options.unit <= 1e9))
        throw InputError(fmt::format("unit: expected 1e-9 to 1e9 m, not {}", options.unit));
    return options;
}

}  // namespace interflect::detail
