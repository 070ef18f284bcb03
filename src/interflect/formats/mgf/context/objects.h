#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interflect/formats/mgf/context/contexts.h"
#include "interflect/formats/mgf/context/scene_builder.h"
#include "interflect/load.h"

namespace interflect::detail {

/// Objects that are open. Each entity `o` and each array copy opens one.
class MgfObjects {
  public:
    MgfObjects(const ReadOptions& options, MgfSceneBuilder& scene) : options_(options), scene_(scene) {}

    std::size_t depth() const { return open_.size(); }

    /// @param is_copy  Whether the object is an array copy, which only close_copy() closes.
    void open(std::string_view name, bool is_copy, const Location& where);
    /// Closes the innermost object. @return  false for an array copy or a depth of at most `outer_depth`.
    bool close_innermost(std::size_t outer_depth);
    void close_copy();
    /// Closes objects until `depth` remain. Warns about each, except for array copies.
    void close_down_to(std::size_t depth);

    /// Returns the index of the innermost object in Scene::objects.
    std::uint32_t current();

  private:
    struct OpenObject {
        std::string dotted_name;
        Location opened;
        bool is_copy = false;
        std::optional<std::uint32_t> scene_index;
    };

    const ReadOptions& options_;
    MgfSceneBuilder& scene_;
    std::vector<OpenObject> open_;
};

}  // namespace interflect::detail
