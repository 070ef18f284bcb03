#include "interflect/export.h"

#include <array>
#include <string_view>

#include "interflect/core.h"
#include "interflect/exports/files/exported_parts.h"
#include "interflect/exports/files/write_files.h"
#include "interflect/exports/foreign/foreign_scene.h"
#include "interflect/formats/text/extension.h"

namespace interflect {

using namespace detail;

namespace {

struct SceneFormat {
    const char* extension;
    std::string (*describe)(ForeignScene& scene);
    std::string (*escape)(std::string_view file_name);
    std::string_view excluded;  // characters of file names that the format cannot escape
};
constexpr std::array<SceneFormat, 4> scene_formats{{
    {".rad", radiance_description, quotable, ""},
    {".xml", mitsuba_description, xml_text, "$"},  // Mitsuba replaces parameters that begin with $
    {".pbrt", pbrt_description, quotable, ""},
    {".py", blender_description, quotable, ""},
}};
constexpr auto extensions = [] {
    std::array<const char*, scene_formats.size()> all{};
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = scene_formats[i].extension;
    return all;
}();

const SceneFormat* find_scene_format(const std::filesystem::path& path) {
    const std::string extension = lower_case_extension(path);
    for (const SceneFormat& format : scene_formats)
        if (extension == format.extension) return &format;
    return nullptr;
}

}  // namespace

const std::span<const char* const> scene_export_extensions(extensions);

bool is_scene_export(const std::filesystem::path& path) { return find_scene_format(path); }

SceneExport export_scene(const std::filesystem::path& path, const Scene& scene, const SceneExportOptions& options) {
    const SceneFormat* format = find_scene_format(path);
    if (!format) throw InputError(path, 0, "expected the extension .rad, .xml, .pbrt or .py");
    if (options.width < 1 || options.height < 1 || options.samples < 1)
        throw InputError("scene export: width, height and samples must be at least 1");
    require_no_faults(scene_faults(scene), "cannot export", scene);
    require_nameable(path, format->excluded);
    ForeignScene foreign(scene, path, options, format->escape);
    std::string description = format->describe(foreign);
    foreign.files.push_back({path, std::move(description)});
    return {write_files(foreign.files), foreign.warnings};
}

}  // namespace interflect
