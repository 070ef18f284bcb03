#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace interflect {

struct Scene;

/// Sources of light that are dimmed together.
struct LightGroup {
    std::string name;
    /// Of the names of their objects, materials or luminaires: '*' stands for any characters, '?' for one; an object
    /// brings those within it ("lamps" holds "lamps.left").
    std::string pattern;
};

/// Most groups of a scene, with the one for what no pattern matches.
inline constexpr std::size_t most_light_groups = 32;

/// Whether a pattern of '*', '?' and other characters matches all of `name`. O(length of both, multiplied).
bool matches(std::string_view pattern, std::string_view name);

/// Which group each source is in: the first whose pattern matches it.
struct SourceGroups {
    std::vector<std::string> names;          ///< Those of Scene::light_groups, then "other" where some match none.
    std::vector<std::uint8_t> of_patch;      ///< Index into names; of patches that do not emit it means nothing.
    std::vector<std::uint8_t> of_luminaire;  ///< The same.

    bool empty() const { return names.empty(); }
    std::size_t size() const { return names.size(); }
    /// @throws InputError that lists the names, where there is no such group.
    std::size_t index_of(const std::string& name) const;
};

/// Empty where the scene has no groups. @throws InputError for more than most_light_groups and for two of one name.
SourceGroups source_groups(const Scene& scene);

/// @throws InputError for a group that no source is in, and as source_groups().
void require_sources_of_groups(const Scene& scene);

/// A group for each object that is in no other one and has a source; where the sources are in one object or in none, a
/// group for each material and luminaire. @throws InputError where that is more than most_light_groups.
std::vector<LightGroup> groups_by_name(const Scene& scene);

/// The scene with the sources of each group scaled. @param factors  Of source_groups(scene); >= 0.
Scene dimmed(const Scene& scene, const SourceGroups& groups, const std::vector<float>& factors);

}  // namespace interflect
