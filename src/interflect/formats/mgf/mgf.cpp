#include "interflect/formats/mgf/mgf.h"

#include "interflect/formats/mgf/reader.h"
#include "interflect/formats/reading/checked_options.h"
#include "interflect/formats/text/text_file.h"

namespace interflect::detail {

namespace {

namespace fs = std::filesystem;
using Imath::V3d;

/// Reads a file. A scene far from the origin is read twice, because the first pass determines a suitable origin.
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

}  // namespace interflect::detail
