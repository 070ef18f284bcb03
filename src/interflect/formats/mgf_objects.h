#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interflect/formats/mgf_contexts.h"
#include "interflect/formats/mgf_scene_builder.h"
#include "interflect/load.h"

namespace interflect::detail {

/// Open objects: of `o`, and of each array copy.
class MgfObjects {
  public:
    MgfObjects(const ReadOptions& options, MgfSceneBuilder& scene) : options_(options), scene_(scene) {}

    std::size_t depth() const { return open_.size(); }

    /// @param is_copy  Closed only by close_copy(). @throws std::invalid_argument  beyond a limit.
    void open(std::string_view name, bool is_copy, const Location& where);
    /// Closes the innermost object. @return  false if it does not belong to the current file, whose objects begin at
    /// `outer_depth`.
    bool close_innermost(std::size_t outer_depth);
    /// Closes the innermost copy with all objects in it.
    void close_copy();
    /// Closes all but `depth` objects and warns about unclosed ones.
    void close_down_to(std::size_t depth);

    /// Returns the innermost object's index in Scene::objects.
    std::uint32_t current();

  private:
    struct OpenObject {
        std::string dotted_name;
        Location opened;
        bool is_copy = false;
        std::optional<std::uint32_t> scene_index;  // set by the first patch
    };

    const ReadOptions& options_;
    MgfSceneBuilder& scene_;
    std::vector<OpenObject> open_;
};

}  // namespace interflect::detail
