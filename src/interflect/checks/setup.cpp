#include <ImathBox.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <string_view>
#include <utility>
#include <variant>

#include "interflect/checks/faces/up_axis.h"
#include "interflect/checks/lights/enclosed_lights.h"
#include "interflect/checks/lights/light_places.h"
#include "interflect/checks/search/finder.h"
#include "interflect/checks/search/shell.h"
#include "interflect/geometry/surfaces/corner_normals.h"
#include "interflect/prepare.h"
#include "interflect/scene/core/core.h"

namespace interflect {

using namespace detail;

namespace {

bool is_far_light(const Luminaire& luminaire) {
    return is_sky(luminaire) || std::holds_alternative<DirectionalLight>(luminaire.kind);
}

void add_shut_out_light(const Scene& scene, const RayCaster& ray_caster, const SightLines& lines, std::size_t places,
                        std::vector<Finding>& findings) {
    Finder shut_out(scene, places,
                    {"shut-out-sky",
                     true,
                     "the sky or the sun lights only the outside of the scene, which is closed",
                     "open it: windows need a hole, or a material that transmits light",
                     0,
                     {}});
    for (const Luminaire& luminaire : scene.luminaires)
        if (is_far_light(luminaire) && largest_channel(rating(luminaire)) > 0)
            shut_out.add({scene.objects[luminaire.object], luminaire.name});
    std::vector<Finding> found;
    shut_out.append_to(found);
    if (found.empty() || has_opening(scene, ray_caster, lines)) return;
    findings.push_back(std::move(found.front()));
}

/// Whether the format specifies neither unit nor up axis.
bool is_bare_mesh(const Scene& scene) {
    const std::string extension = std::filesystem::path(scene.name).extension().string();
    constexpr std::string_view bare[] = {".obj", ".ply", ".stl", ".OBJ", ".PLY", ".STL"};
    return std::find(std::begin(bare), std::end(bare), extension) != std::end(bare);
}

/// Meshes in metres have fractional coordinates.
bool has_integer_coordinates(const Scene& scene) {
    constexpr std::size_t min_vertices = 8;
    if (scene.vertices.size() < min_vertices) return false;
    constexpr double rounding = 1e-6;
    const std::size_t coordinates = 3 * scene.vertices.size();
    std::size_t integers = 0;
    for (const V3f& vertex : scene.vertices) {
        const Imath::V3d x = scene.origin + Imath::V3d(vertex);
        for (int k = 0; k < 3; ++k)
            integers += std::abs(x[k] - std::round(x[k])) <= rounding * std::max(1.0, x.length());
    }
    return 100 * integers >= 99 * coordinates;
}

void add_unit(const Scene& scene, const Shell& shell, std::vector<Finding>& findings) {
    for (const Warnings::Entry& warning : scene.warnings.entries())
        if (warning.kind == "implausible-size") return;  // the reader has already asked for the unit
    constexpr float largest_path = 80;   // a hangar of 300 x 100 x 40 m has 52; a room in centimetres 230
    constexpr float largest_mesh = 200;  // diagonal [m]
    const float size = core_bounds(scene).size().length();
    std::string evidence;
    if (shell.mean_free_path > largest_path)
        evidence = fmt::format("light goes {:.3g} m from wall to wall", shell.mean_free_path);
    else if (is_bare_mesh(scene) && size > largest_mesh && has_integer_coordinates(scene))
        evidence = fmt::format("it is {:.3g} m across, with integers as coordinates", size);
    if (evidence.empty()) return;
    findings.push_back({"probable-unit",
                        false,
                        "the scene is probably in another unit than metres: " + evidence,
                        "read it in its unit, such as millimetres",
                        1,
                        {}});
}

void add_up_axis(const Scene& scene, std::vector<Finding>& findings) {
    if (!is_bare_mesh(scene)) return;
    if (const char* axis = find_other_up_axis(scene))
        findings.push_back({"probable-up-axis",
                            false,
                            fmt::format("{} is probably up in this file, but z is taken", axis),
                            fmt::format("read it with {} as the up axis", axis),
                            1,
                            {}});
}

void add_contradicting_normals(const Scene& scene, std::size_t places, std::vector<Finding>& findings) {
    if (scene.normals.empty()) return;
    // Changes the irradiance by up to 17% at an incidence of 45 degrees; rounding and nearly flat meshes stay below.
    constexpr float least_degrees = 10;
    Finder contradicting(scene, places,
                         {"contradicting-normals",
                          false,
                          "the file's normals bend faces that are plane: they are shaded by their own normals",
                          "export normals of faces or mark sharp edges; the light is right either way",
                          0,
                          {}});
    const CornerNormals normals(scene, find_smooth_surfaces(scene));
    for (const PatchIndex patch : normals.contradicted_patches(scene, least_degrees)) contradicting.add_patch(patch);
    contradicting.append_to(findings);
}

}  // namespace

std::vector<Finding> validate_setup(const Scene& scene, const RayCaster& ray_caster, const ValidateOptions& options) {
    ray_caster.require_made_for(scene);
    if (scene.patches.empty()) return {};
    const SightLines lines(scene, ray_caster);
    const Shell shell = find_shell(scene, ray_caster, lines);
    const LocalLights lights(scene);
    std::vector<Finding> findings = find_misplaced_lights(scene, lights, lines, shell, options.places);
    for (Finding& finding : find_enclosed_lights(scene, ray_caster, lights, lines, options.places))
        findings.push_back(std::move(finding));
    if (shell.is_room) add_shut_out_light(scene, ray_caster, lines, options.places, findings);
    add_unit(scene, shell, findings);
    add_up_axis(scene, findings);
    add_contradicting_normals(scene, options.places, findings);
    std::stable_partition(findings.begin(), findings.end(), [](const Finding& f) { return f.is_problem; });
    return findings;
}

}  // namespace interflect
