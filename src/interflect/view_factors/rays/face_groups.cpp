#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "interflect/view_factors.h"

namespace interflect {

namespace {

bool belongs(const Scene& scene, PatchIndex patch, FaceSides sides) {
    const std::uint32_t other = scene.patches[patch].other_side;
    if (sides == FaceSides::both || other == none) return true;
    return (patch < other) == (sides == FaceSides::front);
}

/// @param group_of  Index of the group of a patch; names.size() or more if it has no group.
template <class GroupOf>
std::vector<FaceGroup> collect(const Scene& scene, FaceSides sides, const std::vector<std::string>& names,
                               const GroupOf& group_of) {
    std::vector<FaceGroup> groups(names.size());
    for (std::size_t g = 0; g < names.size(); ++g) groups[g].name = names[g];
    for (PatchIndex p{0}; p < scene.patches.size(); ++p)
        if (const std::size_t g = group_of(scene.patches[p]); g < groups.size() && belongs(scene, p, sides))
            groups[g].patches.push_back(p);
    return groups;
}

std::vector<FaceGroup> named_and_used(std::vector<FaceGroup> groups) {
    std::erase_if(groups, [](const FaceGroup& g) { return g.name.empty() || g.patches.empty(); });
    return groups;
}

void require_patterns(std::span<const FacePattern> patterns) {
    std::set<std::string> names;
    for (const FacePattern& p : patterns) {
        if (p.name.empty() || p.pattern.empty())
            throw InputError("a group of faces needs a name and a pattern, as in 'walls=room.wall*'");
        if (!names.insert(p.name).second) throw InputError(fmt::format("two groups of faces are called '{}'", p.name));
    }
}

}  // namespace

Scene with_opaque_backs(const Scene& scene) {
    Scene result = scene;
    const auto black = static_cast<std::uint32_t>(result.materials.size());
    result.materials.emplace_back();
    // All backs form one surface, because faces of larger surfaces have lower priority.
    std::uint32_t surface = 0;
    for (const Patch& patch : scene.patches)
        if (patch.surface != none) surface = std::max(surface, patch.surface + 1);
    for (const Patch& patch : scene.patches) {
        if (patch.other_side != none) continue;
        Patch back{patch.vertices, black, no_patch, 0, surface};
        std::reverse(back.vertices.begin() + 1, back.vertices.begin() + back.vertex_count());
        result.patches.push_back(back);
    }
    return result;
}

std::vector<FaceGroup> facet_groups(const Scene& scene, FaceSides sides) {
    std::vector<FaceGroup> groups;
    for (PatchIndex p{0}; p < scene.patches.size(); ++p) {
        const std::string& object = scene.objects[scene.patches[p].object];
        const bool has_name = !object.empty() || !scene.materials[scene.patches[p].material].name.empty();
        if (!has_name || !belongs(scene, p, sides)) continue;
        groups.push_back({object.empty() ? fmt::format("{}", p) : fmt::format("{}:{}", object, p), {p}});
    }
    return groups;
}

std::vector<FaceGroup> object_groups(const Scene& scene, FaceSides sides) {
    return named_and_used(collect(scene, sides, scene.objects, [](const Patch& p) { return p.object; }));
}

std::vector<FaceGroup> material_groups(const Scene& scene, FaceSides sides) {
    std::vector<std::string> names;
    for (const Material& m : scene.materials) names.push_back(m.name);
    return named_and_used(collect(scene, sides, names, [](const Patch& p) { return p.material; }));
}

std::vector<FaceGroup> named_groups(const Scene& scene, FaceSides sides) {
    std::vector<FaceGroup> objects = object_groups(scene, sides);
    return objects.empty() ? material_groups(scene, sides) : objects;
}

std::vector<FaceGroup> pattern_groups(const Scene& scene, std::span<const FacePattern> patterns, FaceSides sides) {
    require_patterns(patterns);
    std::vector<std::string> names;
    for (const FacePattern& p : patterns) names.push_back(p.name);
    // First matching pattern of each object and material; patterns.size() without a match.
    const auto first_match = [&](const auto& is_match) {
        std::size_t first = 0;
        while (first < patterns.size() && !is_match(patterns[first].pattern)) ++first;
        return first;
    };
    std::vector<std::size_t> by_object, by_material;
    for (const std::string& name : scene.objects)
        by_object.push_back(first_match([&](const std::string& pattern) { return matches_object(pattern, name); }));
    for (const Material& m : scene.materials)
        by_material.push_back(first_match([&](const std::string& pattern) { return matches(pattern, m.name); }));
    std::vector<FaceGroup> groups = collect(
        scene, sides, names, [&](const Patch& p) { return std::min(by_object[p.object], by_material[p.material]); });
    for (std::size_t g = 0; g < groups.size(); ++g)
        if (groups[g].patches.empty())
            throw InputError(fmt::format("group '{}': no object or material of a face matches '{}'", groups[g].name,
                                         patterns[g].pattern));
    return groups;
}

}  // namespace interflect
