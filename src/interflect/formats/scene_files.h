#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "interflect/base/files/pending_file.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Files of a scene in MGF: the scene, its views beside it (view_list_path()) and its textures.
class SceneFiles {
  public:
    /// Opens the files of the scene and its views. @throws as PendingFile.
    explicit SceneFiles(const std::filesystem::path& path);

    /// Writes all files, without replacing any. Luminaires with files of their own are not written.
    void write(const Scene& scene);

    struct Difference {
        std::filesystem::path file;
        const char* content;  ///< "views" or "texels".
    };
    /// Finds an existing file of views or texels with other content. They may be the user's own, since only the name of
    /// the scene was given.
    std::optional<Difference> find_difference() const;

    void commit();

    const std::filesystem::path& views() const { return view_file_.final_path(); }

  private:
    PendingFile scene_file_, view_file_;
    std::vector<PendingFile> textures_;
};

}  // namespace interflect::detail
