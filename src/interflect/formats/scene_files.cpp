#include "interflect/formats/scene_files.h"

#include <algorithm>
#include <cstddef>
#include <fstream>
#include <iterator>
#include <string>

#include "interflect/formats/build/texture_files.h"
#include "interflect/formats/mgf/write_mgf.h"
#include "interflect/formats/view_files.h"
#include "interflect/load.h"

namespace interflect::detail {

namespace fs = std::filesystem;

namespace {

std::string file_content(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

bool replaces_other_content(const PendingFile& file) {
    const fs::path& existing = file.final_path();
    return fs::exists(existing) &&
           !(fs::is_regular_file(existing) && file_content(existing) == file_content(file.temporary_path()));
}

}  // namespace

SceneFiles::SceneFiles(const fs::path& path) : scene_file_(path), view_file_(view_list_path(path)) {}

void SceneFiles::write(const Scene& scene) {
    const fs::path& path = scene_file_.final_path();
    const std::vector<std::string> names = texture_files(scene, path);
    scene_file_.write_by([&](const fs::path& temporary) { write_mgf(scene, temporary, names); });
    view_file_.write_by([&](const fs::path& temporary) { write_view_list(scene.views, temporary); });
    for (std::size_t i = 0; i < names.size(); ++i)
        textures_.emplace_back(path.parent_path() / names[i]).write_by([&](const fs::path& temporary) {
            write_texture(temporary, scene.textures[i]);
        });
}

std::optional<SceneFiles::Difference> SceneFiles::find_difference() const {
    if (replaces_other_content(view_file_)) return Difference{view_file_.final_path(), "views"};
    const auto texture = std::find_if(textures_.begin(), textures_.end(), replaces_other_content);
    if (texture != textures_.end()) return Difference{texture->final_path(), "texels"};
    return {};
}

void SceneFiles::commit() {
    for (PendingFile& file : textures_) file.commit();
    scene_file_.commit();
    view_file_.commit();
}

}  // namespace interflect::detail
