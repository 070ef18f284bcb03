#include "interflect/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include "interflect/base/threads/parallel.h"
#include "interflect/core.h"
#include "interflect/scene/core/limits.h"
#include "interflect/scene/core/view.h"
#include "interflect/scene/sky/environment_maps.h"

namespace interflect {

using namespace detail;

namespace {

constexpr std::size_t listed_faults = 20;

bool is_share(const Rgb& c) { return is_finite(c) && std::min({c.x, c.y, c.z}) >= 0; }
bool is_reflectance(const Rgb& c) { return is_share(c) && largest_channel(c) < 1; }

/// Part of a scene that is checked. Its text is composed only for faults, since scenes have millions of patches.
struct Subject {
    const std::string* name = nullptr;
    std::string_view kind = {};  // of parts without a name: "patch"
    std::size_t index = 0;

    std::string text() const {
        if (name) return *name;
        return kind.empty() ? std::string() : fmt::format("{} {}", kind, index);
    }
};

Subject named(const std::string& name) { return {&name}; }
Subject numbered(std::string_view kind, std::size_t index) { return {nullptr, kind, index}; }

class Faults {
  public:
    template <class Describe>
    void check(bool holds, const Subject& subject, const Describe& describe) {
        if (!holds && list_.size() < listed_faults) list_.push_back({describe(), subject.text()});
    }
    /// @param fault  Predicate, or empty. @param start  Makes the start of the sentence.
    template <class Start>
    void add(const std::string& fault, const Subject& subject, const Start& start) {
        check(fault.empty(), subject, [&] { return start() + fault; });
    }
    bool empty() const { return list_.empty(); }
    std::vector<Fault> take() { return std::move(list_); }

  private:
    std::vector<Fault> list_;
};

/// Calls check(index, faults) for the indices in [0, count), in parallel, and again in order where it finds faults.
template <class Check>
void check_each(std::size_t count, Faults& faults, const Check& check) {
    constexpr std::size_t at_once = 4096;
    std::vector<char> has_faults((count + at_once - 1) / at_once);
    parallel_for_ranges(count, at_once, [&](std::size_t begin, std::size_t end) {
        Faults found;
        for (std::size_t i = begin; i < end; ++i) check(i, found);
        has_faults[begin / at_once] = !found.empty();
    });
    for (std::size_t range = 0; range < has_faults.size(); ++range)
        if (has_faults[range])
            for (std::size_t i = range * at_once; i < std::min(count, (range + 1) * at_once); ++i) check(i, faults);
}

bool has_vertices(const Scene& scene, const Patch& patch) {
    return std::all_of(patch.vertices.begin(), patch.vertices.begin() + patch.vertex_count(),
                       [&](std::uint32_t v) { return v < scene.vertices.size(); });
}

void check_points(const Scene& scene, Faults& all) {
    const auto check = [](const Imath::V3d& x, const Subject& point, Faults& faults) {
        faults.check(is_finite(x), point, [&] { return point.text() + " is not finite"; });
        faults.check(!is_finite(x) || is_within_reach(x), point, [&] {
            return fmt::format("{} is ({:g}, {:g}, {:g}), farther than {:g} m from the origin", point.text(), x.x, x.y,
                               x.z, farthest_coordinate);
        });
    };
    const std::string origin = "the origin";
    check(scene.origin, named(origin), all);
    check_each(scene.vertices.size(), all, [&](std::size_t i, Faults& faults) {
        check(Imath::V3d(scene.vertices[i]), numbered("vertex", i), faults);
    });
    for (std::size_t i = 0; i < scene.contacts.size(); ++i)
        for (const V3f& end : {scene.contacts[i].a, scene.contacts[i].b})
            check(Imath::V3d(end), numbered("contact", i), all);
}

void check_material(const Scene& scene, const Material& m, Faults& faults) {
    for (const std::uint32_t texture : {m.reflectance_texture, m.exitance_texture, m.transmittance_texture})
        faults.check(texture == none || texture < scene.textures.size(), named(m.name),
                     [&] { return fmt::format("material '{}': texture {} does not exist", m.name, texture); });
    const Rgb& r = m.reflectance;
    faults.check(is_reflectance(r), named(m.name), [&] {
        return fmt::format("material '{}': reflectance ({}, {}, {}) is not in [0, 1)", m.name, r.x, r.y, r.z);
    });
    const Rgb &t = m.transmittance, &s = m.specular_reflectance;
    // check_products() checks textured sums; an invalid reflectance is reported above.
    const bool are_added = m.transmittance_texture == none && is_reflectance(r);
    faults.check(
        is_share(t) && is_share(s) && (!are_added || largest_channel(Rgb(r + t + s)) <= 1), named(m.name), [&] {
            return fmt::format(
                "material '{}': transmittance ({}, {}, {}), specular reflectance ({}, {}, {}): expected 0 to 1, and no "
                "more than 1 with the reflectance",
                m.name, t.x, t.y, t.z, s.x, s.y, s.z);
        });
    faults.add(exitance_fault(m.exitance), named(m.name), [&] { return fmt::format("material '{}': ", m.name); });
}

void check_products(const Material& m, const std::vector<Texture>& textures, const std::vector<Rgb>& largest,
                    Faults& faults) {
    const Rgb r = textured(m.reflectance, m.reflectance_texture, largest);
    faults.check(is_reflectance(r), named(m.name), [&] {
        return fmt::format("material '{}': reflectance times its texture is up to ({}, {}, {}), not in [0, 1)", m.name,
                           r.x, r.y, r.z);
    });
    faults.add(exitance_fault(textured(m.exitance, m.exitance_texture, largest)), named(m.name),
               [&] { return fmt::format("material '{}' times its texture: ", m.name); });
    if (m.transmittance_texture == none) return;
    const Rgb sum = largest_sum(m, textures, largest);
    faults.check(largest_channel(sum) <= 1, named(m.name), [&] {
        return fmt::format(
            "material '{}': reflectance and transmittance, times their textures, are up to ({}, {}, {}) in sum; "
            "expected at most 1",
            m.name, sum.x, sum.y, sum.z);
    });
}

void check_textures(const Scene& scene, Faults& faults) {
    std::uint64_t texels = 0;
    for (const Texture& texture : scene.textures) {
        faults.add(texture_fault(texture), named(texture.name),
                   [&] { return fmt::format("texture '{}' ", texture.name); });
        texels += texture.texels.size();
    }
    faults.check(texels <= max_texels, {}, [&] {
        return fmt::format("the textures have {} texels together; at most {} can be computed", texels, max_texels);
    });
    if (scene.texture_coordinates.empty()) return;
    faults.check(scene.texture_coordinates.size() == scene.vertices.size(), {}, [&] {
        return fmt::format("{} vertices, but {} texture coordinates", scene.vertices.size(),
                           scene.texture_coordinates.size());
    });
    for (std::size_t i = 0; i < scene.texture_coordinates.size(); ++i)
        faults.add(texture_coordinate_fault(scene.texture_coordinates[i]), numbered("vertex", i),
                   [&] { return fmt::format("vertex {} ", i); });
}

bool is_missing(const V2f& c) { return std::isnan(c.x) && std::isnan(c.y); }

void check_lightmap_coordinates(const Scene& scene, Faults& faults) {
    const std::vector<V2f>& all = scene.lightmap_coordinates;
    if (all.empty()) return;
    faults.check(all.size() == scene.vertices.size(), {}, [&] {
        return fmt::format("{} vertices, but {} lightmap coordinates", scene.vertices.size(), all.size());
    });
    for (std::size_t i = 0; i < all.size(); ++i) {
        const V2f& c = all[i];
        const bool is_inside = c.x >= 0 && c.x <= 1 && c.y >= 0 && c.y <= 1;
        faults.check(is_inside || is_missing(c), numbered("vertex", i), [&] {
            return fmt::format("vertex {} has the lightmap coordinates ({}, {}); expected 0 to 1, or NaN for none", i,
                               c.x, c.y);
        });
    }
}

void check_normals(const Scene& scene, Faults& faults) {
    if (scene.normals.empty()) return;
    faults.check(scene.normals.size() == scene.vertices.size(), {}, [&] {
        return fmt::format("{} vertices, but {} normals", scene.vertices.size(), scene.normals.size());
    });
    constexpr float tolerance = 1e-3f;  // of the length
    for (std::size_t i = 0; i < scene.normals.size(); ++i) {
        const V3f& n = scene.normals[i];
        faults.check(n == V3f(0) || std::abs(n.length() - 1) <= tolerance, numbered("vertex", i), [&] {
            return fmt::format("vertex {} has the normal ({}, {}, {}); expected length 1, or 0 for none", i, n.x, n.y,
                               n.z);
        });
    }
}

/// @param patch  With valid vertices.
bool has_some_lightmap_coordinates_only(const Scene& scene, const Patch& patch) {
    if (scene.lightmap_coordinates.size() != scene.vertices.size()) return false;
    const auto count = std::count_if(patch.vertices.begin(), patch.vertices.begin() + patch.vertex_count(),
                                     [&](std::uint32_t v) { return is_missing(scene.lightmap_coordinates[v]); });
    return count != 0 && count != patch.vertex_count();
}

void check_materials(const Scene& scene, Faults& faults) {
    for (const Material& m : scene.materials) check_material(scene, m, faults);
    if (!faults.empty()) return;
    const std::vector<Rgb> largest = largest_texels(scene);
    for (const Material& m : scene.materials)
        if (m.is_textured()) check_products(m, scene.textures, largest, faults);
    faults.add(brightness_fault(brightest_source(scene)), {}, [] { return std::string("the scene "); });
}

void check_luminaire(const Scene& scene, const Luminaire& l, Faults& faults) {
    faults.add(luminaire_fault(l), named(l.name), [&] { return fmt::format("light '{}' ", l.name); });
    faults.check(l.object < scene.objects.size(), named(l.name),
                 [&] { return fmt::format("light '{}': object {} does not exist", l.name, l.object); });
}

void check_patch(const Scene& scene, PatchIndex i, Faults& faults) {
    const Patch& p = scene.patches[i];
    const Subject patch = numbered("patch", i);
    if (has_vertices(scene, p))
        faults.add(patch_fault(scene, p), patch, [&] { return fmt::format("patch {} ", i); });
    else
        faults.check(false, patch, [&] { return fmt::format("patch {}: a vertex index is out of range", i); });
    faults.check(p.material < scene.materials.size(), patch,
                 [&] { return fmt::format("patch {}: material {} does not exist", i, p.material); });
    faults.check(p.material >= scene.materials.size() || !scene.materials[p.material].is_textured() ||
                     !scene.texture_coordinates.empty(),
                 patch, [&] { return fmt::format("patch {} has a texture, but no texture coordinates", i); });
    faults.check(!has_vertices(scene, p) || !has_some_lightmap_coordinates_only(scene, p), patch,
                 [&] { return fmt::format("patch {} has lightmap coordinates at some of its vertices only", i); });
    faults.check(p.object < scene.objects.size(), patch,
                 [&] { return fmt::format("patch {}: object {} does not exist", i, p.object); });
    const bool are_neighbours = p.other_side == i + 1 || p.other_side + 1 == i;
    faults.check(
        p.other_side == none ||
            (are_neighbours && p.other_side < scene.patches.size() && scene.patches[p.other_side].other_side == i),
        patch,
        [&] { return fmt::format("patch {}: its other side {} is no neighbour that points back", i, p.other_side); });
}

}  // namespace

std::vector<Fault> scene_faults(const Scene& scene) {
    Faults faults;
    const auto the_scene = [] { return std::string("the scene "); };
    check_points(scene, faults);
    check_textures(scene, faults);
    check_lightmap_coordinates(scene, faults);
    check_normals(scene, faults);
    for (const Luminaire& l : scene.luminaires) check_luminaire(scene, l, faults);
    faults.add(sky_count_fault(scene), {}, the_scene);
    check_materials(scene, faults);
    check_each(scene.patches.size(), faults,
               [&](std::size_t i, Faults& found) { check_patch(scene, PatchIndex(i), found); });
    if (!scene.patches.empty()) faults.add(scene_width_fault(scene_width(scene)), {}, the_scene);
    for (const View& v : scene.views)
        faults.add(view_fault(v), named(v.name), [&] { return fmt::format("view '{}': ", v.name); });
    return faults.take();
}

void require_no_faults(const std::vector<Fault>& faults, const std::string& purpose, const Scene& scene) {
    if (faults.empty()) return;
    std::string message = purpose + " '" + scene.name + "':";
    for (const Fault& fault : faults) message += "\n  " + fault.text;
    throw InputError(message, faults);
}

}  // namespace interflect
