#include "apps/interflect/values/distinct_files.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <string>
#include <system_error>

#include "apps/interflect/values/parse.h"

namespace interflect::command {

using namespace detail;

namespace {

namespace fs = std::filesystem;

bool is_same_file(const fs::path& a, const fs::path& b) {
    std::error_code error;
    if (fs::exists(a, error) && fs::exists(b, error))
        return fs::is_regular_file(a, error) && fs::equivalent(a, b, error);
    const fs::path canonical_a = fs::weakly_canonical(fs::absolute(a), error);
    return !error && canonical_a == fs::weakly_canonical(fs::absolute(b), error);
}

/// Extensions of all files that the command reads or writes, except text. They decide how a file is read.
constexpr std::array<std::string_view, 28> known_extensions = {
    ".mgf",  ".gltf", ".glb", ".obj",    ".mtl", ".ply",  ".stl",  ".rad", ".mat", ".vs3",
    ".vf",   ".ies",  ".ldt", ".h5",     ".png", ".jpg",  ".jpeg", ".exr", ".hdr", ".xml",
    ".pbrt", ".py",   ".vtu", ".vtkhdf", ".hdf", ".html", ".htm",  ".npz"};

}  // namespace

std::string lower_case_extension(const fs::path& path) { return CLI::detail::to_lower(path.extension().string()); }

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

void refuse_overwriting(const Scene& scene, std::span<const NamedFile> outputs) {
    for (const std::string& file : scene.files) {
        const NamedFile input{"a file of the scene", file};
        require_distinct_files({&input, 1}, outputs);
    }
}

void require_text_name(const NamedFile& output) {
    const std::string extension = lower_case_extension(output.path);
    if (std::find(known_extensions.begin(), known_extensions.end(), extension) == known_extensions.end()) return;
    throw UsageError(std::string(output.argument),
                     fmt::format("text is written, which {} files do not hold: expected another extension, found '{}'",
                                 extension, output.path.string()));
}

}  // namespace interflect::command
