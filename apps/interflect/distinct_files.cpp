#include "apps/interflect/distinct_files.h"

#include <fmt/format.h>

#include <string>
#include <system_error>

#include "apps/interflect/parse.h"

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

void require_distinct_files(std::span<const NamedFile> inputs, std::span<const NamedFile> outputs) {
    const auto require_distinct = [](const NamedFile& a, const NamedFile& b) {
        if (!a.path.empty() && !b.path.empty() && is_same_file(a.path, b.path))
            throw UsageError(std::string(b.argument),
                             fmt::format("{} and {} are the same file, '{}': one would overwrite the other", a.argument,
                                         b.argument, b.path.string()));
    };
    for (std::size_t i = 0; i < outputs.size(); ++i) {
        for (const NamedFile& input : inputs) require_distinct(input, outputs[i]);
        for (std::size_t j = 0; j < i; ++j) require_distinct(outputs[j], outputs[i]);
    }
}

}  // namespace interflect::command
