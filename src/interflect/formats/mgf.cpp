#include "interflect/formats/mgf.h"

#include <fmt/format.h>

#include "interflect/error.h"
#include "interflect/formats/mgf_reader.h"
#include "interflect/formats/text_file.h"

namespace interflect::inline detail {

namespace {

namespace fs = std::filesystem;
using Imath::V3d;

ReadOptions checked(const ReadOptions& options) {
    if (options.curve_divisions < 1 || options.curve_divisions > 1000)
        throw InputError(fmt::format("curve_divisions: expected 1 to 1000, not {}", options.curve_divisions));
    if (options.max_patches > 4'000'000'000)
        throw InputError(fmt::format("max_patches: expected at most 4 * 10^9, not {}", options.max_patches));
    return options;
}

/// Reads a scene about the world's origin, and where that is far from it, once more about an origin of its own.
Scene read_about_middle(const fs::path& path, const ReadOptions& options, const std::string& text) {
    V3d origin(0);
    {
        MgfReader reader(path, options, origin);
        reader.read(path, text);
        origin = reader.suitable_origin();
        if (origin == V3d(0)) return reader.finish();
    }
    MgfReader reader(path, options, origin);
    reader.read(path, text);
    return reader.finish();
}

}  // namespace

Scene read_mgf(const fs::path& path, const ReadOptions& options) {
    return read_about_middle(path, checked(options), read_text_file(path));
}

Scene read_mgf_text(std::string_view text, const fs::path& path, const ReadOptions& options) {
    require_text(text, path);
    return read_about_middle(path, checked(options), std::string(text));
}

}  // namespace interflect::inline detail
