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

/// The objects (`o`, and one for each copy of an array) that are open where a file is being read.
class MgfObjects {
  public:
    MgfObjects(const ReadOptions& options, MgfSceneBuilder& scene) : options_(options), scene_(scene) {}

    std::size_t depth() const { return open_.size(); }

    /// @param is_copy  Of an array: only close_copy() closes it. @throws std::invalid_argument beyond a limit.
    void open(std::string_view name, bool is_copy, const Location& where);
    /// Closes the innermost object, as `o` without a name does. @return false where it is none of the file's own, which
    /// begin at `outer_depth`.
    bool close_innermost(std::size_t outer_depth);
    /// Closes the innermost copy, and what was left open in it.
    void close_copy();
    /// Closes all but the outermost `depth`, with a warning for each that a file left open.
    void close_down_to(std::size_t depth);

    /// Index in Scene::objects of the innermost object.
    std::uint32_t current();

  private:
    struct OpenObject {
        std::string dotted_name;
        Location opened;
        bool is_copy = false;
        std::optional<std::uint32_t> scene_index;  // in Scene::objects, once a patch was made
    };

    const ReadOptions& options_;
    MgfSceneBuilder& scene_;
    std::vector<OpenObject> open_;
};

}  // namespace interflect::inline detail
