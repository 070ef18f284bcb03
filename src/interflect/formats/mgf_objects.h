#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interflect/formats/mgf_contexts.h"
#include "interflect/formats/mgf_scene_builder.h"
#include "interflect/read_options.h"

namespace interflect::inline detail {

/// Objects open at the current line: those of `o`, and one per copy of an array.
class MgfObjects {
  public:
    MgfObjects(const ReadOptions& options, MgfSceneBuilder& scene) : options_(options), scene_(scene) {}

    std::size_t depth() const { return open_.size(); }

    /// @param is_copy  Copy of an array, closed only by close_copy(). @throws std::invalid_argument  beyond a limit.
    void open(std::string_view name, bool is_copy, const Location& where);
    /// Closes the innermost object, like `o` without a name. @return  false if it does not belong to the current file,
    /// whose objects start at `outer_depth`.
    bool close_innermost(std::size_t outer_depth);
    /// Closes the innermost copy and all objects opened in it.
    void close_copy();
    /// Closes all but the outermost `depth` objects. Warns about each object that the file did not close.
    void close_down_to(std::size_t depth);

    /// Returns the index of the innermost object in Scene::objects.
    std::uint32_t current();

  private:
    struct OpenObject {
        std::string dotted_name;
        Location opened;
        bool is_copy = false;
        std::optional<std::uint32_t> scene_index;  // in Scene::objects, after the first patch
    };

    const ReadOptions& options_;
    MgfSceneBuilder& scene_;
    std::vector<OpenObject> open_;
};

}  // namespace interflect::inline detail
