#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interflect/elements/forest.h"
#include "interflect/luminaires/emission.h"
#include "interflect/scene.h"
#include "interflect/solver/light/materials.h"

namespace interflect::detail {

/// Light of each group and element, [group][element]. The sum over the groups is the total. Empty without groups.
using GroupLight = std::vector<std::vector<Rgb>>;

inline void inherit(const ElementForest& forest, std::uint32_t first, GroupLight& light) {
    for (std::vector<Rgb>& of_group : light) inherit(forest, first, of_group);
}
inline void pull(const ElementForest& forest, GroupLight& light) {
    for (std::vector<Rgb>& of_group : light) pull(forest, of_group);
}
/// Adds `more` to `sum`, which may be empty.
void accumulate(GroupLight& sum, const GroupLight& more);
void scale(GroupLight& light, float factor);

/// Returns the sum over the groups. @param dimming  Solution::dimming; groups with factor 0 are excluded.
std::vector<Rgb> sum_of(const GroupLight& light, const std::vector<float>& dimming = {});

/// Radiosity by light group, computed on demand.
struct GroupRadiosity {
    const SourceGroups* groups = nullptr;  ///< Null if the light of groups is not separated.
    const GroupLight* irradiance = nullptr;
    const std::vector<float>* dimming = nullptr;
    bool emits = true;  ///< If false, B = rho H.

    std::size_t size() const { return groups ? groups->size() : 0; }
    /// Returns the radiosity B of a leaf that one group causes [lm/m^2 or W/m^2].
    Rgb of(const Materials& materials, const ElementForest& forest, ElementIndex leaf, std::size_t group) const {
        if ((*dimming)[group] == 0) return Rgb(0);
        const MeanSurface surface = materials.surface(forest.patch(leaf), leaf);
        const Rgb reflected = surface.reflectance * (*irradiance)[group][leaf];
        const bool is_own = emits && groups->of_patch[forest.patch(leaf)] == group;
        return is_own ? surface.exitance + reflected : reflected;
    }
    bool has_part(const Emission& emission, std::size_t part, std::size_t group) const {
        return groups->of_luminaire[emission.luminaire(part)] == group;
    }
};

}  // namespace interflect::detail
