#include "apps/interflect/distinct_files.h"

#include <fmt/format.h>

#include <system_error>

#include "interflect/base/error.h"

namespace interflect::command {

namespace {

namespace fs = std::filesystem;

bool is_same_file(const fs::path& a, const fs::path& b) {
    std::error_code error;
    if (fs::exists(a, error) && fs::exists(b, error))
        return fs::is_regular_file(a, error) && fs::equivalent(a, b, error);
    const fs::path canonical_a = fs::weakly_canonical(fs::absolute(a), error);
    return !error && canonical_a == fs::weakly_canonical(fs::absolute(b), error);
}

}  // namespace

void require_distinct_files(std::span<const NamedFile> files) {
    for (std::size_t i = 0; i < files.size(); ++i)
        for (std::size_t j = i + 1; j < files.size(); ++j) {
            const auto& [first, a] = files[i];
            const auto& [second, b] = files[j];
            if (!a.empty() && !b.empty() && is_same_file(a, b))
                throw InputError(fmt::format("{} and {} are the same file, '{}': one would overwrite the other", first,
                                             second, b.string()));
        }
}

}  // namespace interflect::command
