#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace interflect {

struct Scene;

/// Light sources that are dimmed together.
struct LightGroup {
    std::string name;
    /// Pattern of the names of objects, materials or luminaires: '*' matches any characters, '?' one. An object
    /// includes nested objects ("lamps" includes "lamps.left").
    std::string pattern;
};

/// Maximum number of groups, including that of unmatched sources.
inline constexpr std::size_t most_light_groups = 32;

/// Whether a pattern matches all of `name`. O(product of both lengths).
bool matches(std::string_view pattern, std::string_view name);

/// Group of each source: the first whose pattern matches.
struct SourceGroups {
    std::vector<std::string> names;          ///< Those of Scene::light_groups, then "other" if some sources match none.
    std::vector<std::uint8_t> of_patch;      ///< Index into names; undefined for patches that do not emit.
    std::vector<std::uint8_t> of_luminaire;  ///< Index into names.

    bool empty() const { return names.empty(); }
    std::size_t size() const { return names.size(); }
    /// @throws InputError that lists the names, for an unknown group.
    std::size_t index_of(const std::string& name) const;
};

/// Empty for a scene without groups. @throws InputError for more than most_light_groups or a duplicate name.
SourceGroups source_groups(const Scene& scene);

/// @throws InputError for a group without sources, and as source_groups().
void require_sources_of_groups(const Scene& scene);

/// One group for each top-level object with a source; if at most one object has sources, one for each material and
/// luminaire. @throws InputError for more than most_light_groups.
std::vector<LightGroup> groups_by_name(const Scene& scene);

/// Copy of the scene with the sources of each group scaled. Materials keep their order.
/// @param factors  One per group of source_groups(scene); >= 0.
Scene dimmed(const Scene& scene, const SourceGroups& groups, const std::vector<float>& factors);

}  // namespace interflect
