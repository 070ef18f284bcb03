#include "interflect/checks/lights/enclosed_lights.h"

#include <ImathBox.h>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <span>
#include <variant>

#include "interflect/base/numbers/random.h"
#include "interflect/checks/search/finder.h"
#include "interflect/geometry/polygons/patch_geometry.h"
#include "interflect/scene/core/core.h"

namespace interflect::detail {

namespace {

constexpr std::uint64_t segments_per_path = 16;
constexpr std::uint64_t seed_of_reflections = 51, seed_of_faces = 52, seed_of_volume = 53, seed_of_starts = 54,
                        seed_of_choices = 55;

struct Path {
    std::vector<V3f> points;
    bool stays = true;
};

/// Random paths within one space: every surface reflects diffusely, and panes transmit.
class Paths {
  public:
    Paths(const Scene& scene, const RayCaster& ray_caster, const SightLines& lines)
        : scene_(scene), ray_caster_(ray_caster), lines_(lines) {}

    Path trace(Ray ray, std::uint64_t index, std::uint64_t segments = segments_per_path) const {
        Path path;
        for (std::uint64_t k = 0; k < segments; ++k) {
            const Hit hit = lines_.first_surface(ray);
            if (hit.patch == none) {
                path.stays = false;
                break;
            }
            const V3f normal = PatchGeometry(scene_, scene_.patches[hit.patch]).normal();
            path.points.push_back(ray.origin + hit.distance * ray.direction +
                                  ray_caster_.ray_offset(hit.patch) * normal);
            ray = {path.points.back(),
                   SightLines::cosine_direction(normal, seed_of_reflections, index * segments_per_path + k)};
        }
        return path;
    }

    /// Whether paths from `x` leave to the sky or see a lit point.
    bool is_lit(const V3f& x, std::span<const V3f> lit, bool has_sky) const {
        constexpr std::uint64_t paths = 16, segments = 8;
        for (std::uint64_t i = 0; i < paths; ++i) {
            Path path = trace({x, SightLines::uniform_direction(seed_of_starts, i)}, i, segments);
            if (has_sky && !path.stays) return true;
            path.points.push_back(x);
            for (std::uint64_t k = 0; k < path.points.size() && !lit.empty(); ++k) {
                const std::uint32_t word = random_words(seed_of_choices, i * (segments + 1) + k)[0];
                if (lines_.is_clear(path.points[k], lit[word % lit.size()])) return true;
            }
        }
        return false;
    }

  private:
    const Scene& scene_;
    const RayCaster& ray_caster_;
    const SightLines& lines_;
};

/// Space that the light of a luminaire reaches.
struct LitSpace {
    std::vector<V3f> points;
    Imath::Box3f box;
    bool is_closed = true;
};

std::vector<LitSpace> lit_spaces(const LocalLights& lights, const Paths& paths) {
    constexpr std::size_t min_paths = 8, max_paths = 64, all_paths = 1024;
    const std::size_t count = std::clamp(all_paths / lights.size(), min_paths, max_paths);
    std::vector<LitSpace> spaces(lights.size());
    for (std::size_t i = 0; i < lights.size(); ++i) {
        LitSpace& space = spaces[i];
        for (std::size_t k = 0; k < count; ++k) {
            const Path path = paths.trace(lights.rays(i)[k * LocalLights::rays_per_light / count], k);
            space.is_closed = space.is_closed && path.stays;
            for (const V3f& x : path.points) space.box.extendBy(x);
            space.points.insert(space.points.end(), path.points.begin(), path.points.end());
        }
    }
    return spaces;
}

std::vector<V3f> points_lit_by_surfaces(const Scene& scene, const RayCaster& ray_caster, const Paths& paths) {
    constexpr std::size_t most = 256, all_paths = 256;
    std::vector<PatchIndex> emitting;
    for (PatchIndex i{0}; i < scene.patches.size(); ++i)
        if (largest_channel(scene.materials[scene.patches[i].material].exitance) > 0) emitting.push_back(i);
    const std::size_t count = std::min(emitting.size(), most), paths_each = count > 0 ? all_paths / count : 0;
    std::vector<V3f> points;
    for (std::size_t k = 0; k < count; ++k) {
        const PatchIndex patch = emitting[k * emitting.size() / count];
        const PatchGeometry geometry(scene, scene.patches[patch]);
        const V3f start = geometry.centre() + ray_caster.ray_offset(patch) * geometry.normal();
        for (std::size_t j = 0; j < paths_each; ++j) {
            const std::uint64_t index = k * paths_each + j;
            const Path path =
                paths.trace({start, SightLines::cosine_direction(geometry.normal(), seed_of_faces, index)}, index);
            points.insert(points.end(), path.points.begin(), path.points.end());
        }
    }
    return points;
}

/// Whether a space is too narrow for a room.
bool is_narrow(const Imath::Box3f& space, const V3f& scene_size) {
    constexpr float narrow = 0.5f, min_room = 2;  // [m]
    const V3f size = space.size();
    if (size.length() <= std::min(narrow, scene_size.length() / 10)) return true;
    return std::min({size.x, size.y, size.z}) < narrow &&
           std::min({scene_size.x, scene_size.y, scene_size.z}) >= min_room;
}

std::vector<V3f> views_inside(const Scene& scene, const SightLines& lines) {
    constexpr std::size_t most = 64;
    std::vector<V3f> eyes;
    for (const View& view : scene.views) {
        const V3f eye(view.eye - scene.origin);
        if (eyes.size() < most && !lines.is_open(eye)) eyes.push_back(eye);
    }
    return eyes;
}

std::vector<V3f> enclosed_points(const Scene& scene, const SightLines& lines) {
    constexpr std::uint64_t count = 256;
    const Imath::Box3f box = core_bounds(scene);
    std::vector<V3f> points;
    for (std::uint64_t i = 0; i < count; ++i) {
        const auto words = random_words(seed_of_volume, i);
        const V3f x = box.min + box.size() * V3f(unit_float(words[0]), unit_float(words[1]), unit_float(words[2]));
        if (!lines.is_open(x)) points.push_back(x);
    }
    return points;
}

}  // namespace

std::vector<Finding> find_enclosed_lights(const Scene& scene, const RayCaster& ray_caster, const LocalLights& lights,
                                          const SightLines& lines, std::size_t places) {
    std::vector<Finding> findings;
    if (lights.size() == 0) return findings;
    const Paths paths(scene, ray_caster, lines);
    const std::vector<LitSpace> spaces = lit_spaces(lights, paths);
    const auto is_closed = [](const LitSpace& space) { return space.is_closed; };
    if (std::none_of(spaces.begin(), spaces.end(), is_closed)) return findings;

    // Test whether the views, or without views most of the enclosed volume, are dark.
    std::vector<V3f> lit = points_lit_by_surfaces(scene, ray_caster, paths);
    for (const LitSpace& space : spaces) lit.insert(lit.end(), space.points.begin(), space.points.end());
    const bool has_sky = std::any_of(scene.luminaires.begin(), scene.luminaires.end(), [](const Luminaire& luminaire) {
        return is_sky(luminaire) || std::holds_alternative<DirectionalLight>(luminaire.kind);
    });
    const std::vector<V3f> eyes = views_inside(scene, lines);
    const std::vector<V3f> tested = eyes.empty() ? enclosed_points(scene, lines) : eyes;
    const auto lit_count =
        std::count_if(tested.begin(), tested.end(), [&](const V3f& x) { return paths.is_lit(x, lit, has_sky); });
    const bool is_dark = eyes.empty() ? 8 * lit_count < std::ssize(tested) : lit_count == 0;

    // Report luminaires in closed spaces that are narrow or keep the light, unless a view sees their light.
    const V3f size = core_bounds(scene).size();
    Finder enclosed(scene, places,
                    {"enclosed-luminaire",
                     true,
                     "luminaires lie in a closed space that keeps their light from the rest of the scene",
                     "move them into the open, or make a surface that encloses them transparent",
                     0,
                     {}});
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const LitSpace& space = spaces[i];
        if (!space.is_closed || !(is_dark || is_narrow(space.box, size))) continue;
        if (std::any_of(eyes.begin(), eyes.end(),
                        [&](const V3f& eye) { return paths.is_lit(eye, space.points, false); }))
            continue;
        const Luminaire& luminaire = lights.luminaire(i);
        enclosed.add_at(lights.position(i), scene.objects[luminaire.object], luminaire.name);
    }
    enclosed.append_to(findings);
    return findings;
}

}  // namespace interflect::detail
