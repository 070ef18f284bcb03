#include "interflect/formats/load_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "interflect/base/error.h"
#include "interflect/formats/mgf.h"
#include "interflect/formats/text_file.h"

namespace interflect {

namespace fs = std::filesystem;

namespace {

struct Format {
    std::string_view extension;
    Scene (*read)(const fs::path&, const ReadOptions&);
};

constexpr Format formats[] = {{".mgf", read_mgf}};

std::string lower_case(std::string text) {
    for (char& c : text)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return text;
}

const Format& format_of(const fs::path& path) {
    const std::string extension = lower_case(path.extension().string());
    std::string known;
    for (const Format& format : formats) {
        if (format.extension == extension) return format;
        known += (known.empty() ? "" : ", ") + std::string(format.extension);
    }
    throw InputError(path, 0,
                     fmt::format("no scene format is known by the extension '{}'; known: {}", extension, known));
}

bool emits(const Scene& scene) {
    return std::any_of(scene.patches.begin(), scene.patches.end(), [&](const Patch& patch) {
        return largest_channel(scene.materials[patch.material].exitance) > 0;
    });
}

}  // namespace

Scene load_scene(const fs::path& path, const ReadOptions& options) {
    require_regular_file(path);
    Scene scene = format_of(path).read(path, options);
    const fs::path views = view_list_path(path);
    std::error_code ignored;
    if (fs::exists(views, ignored)) {
        scene.views = read_view_list(views);
        scene.files.push_back(views.string());
    }
    if (!emits(scene)) scene.warnings.add("no-light", "nothing in the scene emits light: all pictures will be black");
    return scene;
}

}  // namespace interflect
