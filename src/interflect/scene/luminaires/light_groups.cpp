#include "interflect/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <variant>

#include "interflect/core.h"

namespace interflect {

namespace {

std::string listed(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "'" : ", '") + name + "'";
    return text;
}

std::string outermost(const std::string& object) { return object.substr(0, object.find('.')); }

class Matcher {
  public:
    explicit Matcher(const Scene& scene) : scene_(scene) {}

    /// Returns the first matching group, or the number of groups.
    std::size_t group_of(std::uint32_t object, const std::string& own_name) {
        const auto [entry, is_new] = known_.try_emplace({object, own_name}, scene_.light_groups.size());
        if (!is_new) return entry->second;
        const auto found =
            std::find_if(scene_.light_groups.begin(), scene_.light_groups.end(), [&](const LightGroup& g) {
                return matches_object(g.pattern, scene_.objects[object]) || matches(g.pattern, own_name);
            });
        return entry->second = static_cast<std::size_t>(found - scene_.light_groups.begin());
    }

  private:
    const Scene& scene_;
    std::map<std::pair<std::uint32_t, std::string>, std::size_t> known_;
};

void require_names(const std::vector<LightGroup>& groups) {
    std::set<std::string> names;
    for (const LightGroup& g : groups) {
        if (g.name.empty() || g.pattern.empty())
            throw InputError("a light group needs a name and a pattern, as in 'desk=lamps.desk*'");
        if (!names.insert(g.name).second) throw InputError(fmt::format("two light groups are called '{}'", g.name));
    }
}

void require_count(std::size_t groups) {
    if (groups > max_light_groups)
        throw InputError(fmt::format("{} light groups; at most {} are kept", groups, max_light_groups));
}

void scale(Luminaire& luminaire, float factor) {
    if (auto* point = std::get_if<PointLight>(&luminaire.kind)) point->intensity *= factor;
    if (auto* spot = std::get_if<SpotLight>(&luminaire.kind)) spot->intensity *= factor;
    if (auto* directional = std::get_if<DirectionalLight>(&luminaire.kind)) directional->irradiance *= factor;
    if (auto* sky = std::get_if<UniformSky>(&luminaire.kind)) sky->radiance *= factor;
    if (auto* measured = std::get_if<MeasuredLight>(&luminaire.kind)) measured->factor *= factor;
    if (auto* dome = std::get_if<SkyDome>(&luminaire.kind)) dome->irradiance *= factor;
    if (auto* map = std::get_if<EnvironmentMap>(&luminaire.kind)) map->factor *= factor;
}

}  // namespace

bool matches(std::string_view pattern, std::string_view name) {
    std::size_t p = 0, n = 0;
    std::optional<std::size_t> star, resume;  // the last '*', and the text after its match
    while (n < name.size()) {
        if (p < pattern.size() && pattern[p] == '*') {
            star = p++;
            resume = n;
        } else if (p < pattern.size() && (pattern[p] == '?' || pattern[p] == name[n])) {
            ++p;
            ++n;
        } else if (star) {
            p = *star + 1;
            n = ++*resume;
        } else {
            return false;
        }
    }
    return pattern.find_first_not_of('*', p) == pattern.npos;
}

bool matches_object(std::string_view pattern, std::string_view name) {
    for (std::size_t end = name.find('.'); end != name.npos; end = name.find('.', end + 1))
        if (matches(pattern, name.substr(0, end))) return true;
    return !name.empty() && matches(pattern, name);
}

std::size_t SourceGroups::index_of(const std::string& name) const {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
    const std::string known = names.empty() ? ": the light was not kept by groups" : "; there are " + listed(names);
    throw InputError(Fault{.text = fmt::format("unknown light group '{}'{}", name, known), .object = name});
}

SourceGroups source_groups(const Scene& scene) {
    SourceGroups groups;
    if (scene.light_groups.empty()) return groups;
    require_names(scene.light_groups);
    require_count(scene.light_groups.size());
    const std::size_t other = scene.light_groups.size();
    std::vector<bool> used(other + 1, false);
    Matcher matcher(scene);
    const auto group_of = [&](std::uint32_t object, const std::string& name) {
        const std::size_t group = matcher.group_of(object, name);
        used[group] = true;
        return static_cast<std::uint8_t>(group);
    };
    for (const Patch& p : scene.patches) {
        const Material& m = scene.materials[p.material];
        groups.of_patch.push_back(channel_sum(m.exitance) > 0 ? group_of(p.object, m.name) : 0);
    }
    for (const Luminaire& l : scene.luminaires) groups.of_luminaire.push_back(group_of(l.object, l.name));
    for (const LightGroup& g : scene.light_groups) groups.names.push_back(g.name);
    if (used[other]) groups.names.emplace_back("other");
    require_count(groups.size());
    return groups;
}

void require_sources_of_groups(const Scene& scene) {
    const SourceGroups groups = source_groups(scene);
    std::vector<bool> used(groups.size(), false);
    for (std::size_t i = 0; i < groups.of_patch.size(); ++i)
        if (channel_sum(scene.materials[scene.patches[i].material].exitance) > 0) used[groups.of_patch[i]] = true;
    for (const std::uint8_t g : groups.of_luminaire) used[g] = true;
    for (std::size_t g = 0; g < scene.light_groups.size(); ++g)
        if (!used[g])
            throw InputError(fmt::format("light group '{}': no source of light matches '{}'",
                                         scene.light_groups[g].name, scene.light_groups[g].pattern));
}

std::vector<LightGroup> groups_by_name(const Scene& scene) {
    std::set<std::string> objects, names;
    const auto add = [&](std::uint32_t object, const std::string& name) {
        objects.insert(outermost(scene.objects[object]));
        names.insert(name);
    };
    for (const Patch& p : scene.patches)
        if (const Material& m = scene.materials[p.material]; channel_sum(m.exitance) > 0) add(p.object, m.name);
    for (const Luminaire& l : scene.luminaires) add(l.object, l.name);
    const std::set<std::string>& chosen = objects.size() > 1 ? objects : names;
    std::vector<LightGroup> groups;
    for (const std::string& name : chosen)
        if (!name.empty()) groups.push_back({name, name});
    if (groups.size() > max_light_groups)
        throw InputError(
            fmt::format("the sources of light have {} names, at most {} light groups are kept: name the "
                        "groups, with patterns of their members",
                        groups.size(), max_light_groups));
    return groups;
}

Scene dimmed(const Scene& scene, const SourceGroups& groups, const std::vector<float>& factors) {
    const auto factor_of = [&](std::size_t patch) {
        const bool emits = channel_sum(scene.materials[scene.patches[patch].material].exitance) > 0;
        return emits ? factors[groups.of_patch[patch]] : 1;
    };
    std::map<std::pair<std::uint32_t, float>, std::uint32_t> scaled;  // new material by old material and factor
    for (std::size_t i = 0; i < scene.patches.size(); ++i)
        scaled.try_emplace({scene.patches[i].material, factor_of(i)});
    // Keep unused materials.
    for (std::uint32_t m = 0; m < scene.materials.size(); ++m) {
        const auto used = scaled.lower_bound({m, 0.0f});
        if (used == scaled.end() || used->first.first != m) scaled.try_emplace({m, 1.0f});
    }
    Scene result = scene;
    // Materials keep their order, so exports have the same meshes for all factors.
    result.materials.clear();
    for (auto& [key, index] : scaled) {
        index = static_cast<std::uint32_t>(result.materials.size());
        result.materials.push_back(scene.materials[key.first]);
        result.materials.back().exitance *= key.second;
    }
    for (std::size_t i = 0; i < result.patches.size(); ++i)
        result.patches[i].material = scaled.at({scene.patches[i].material, factor_of(i)});
    for (std::size_t i = 0; i < result.luminaires.size(); ++i)
        scale(result.luminaires[i], factors[groups.of_luminaire[i]]);
    return result;
}

}  // namespace interflect
