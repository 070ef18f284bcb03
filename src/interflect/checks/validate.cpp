#include "interflect/prepare.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "interflect/checks/faces/face_surroundings.h"
#include "interflect/checks/faces/open_edges.h"
#include "interflect/checks/lights/lamp_backs.h"
#include "interflect/checks/search/finder.h"
#include "interflect/raycast/embree/coincident.h"
#include "interflect/scene/core/limits.h"
#include "interflect/scene/luminaires/luminaire.h"

namespace interflect {

using namespace detail;

namespace {

class Validator {
  public:
    Validator(const Scene& scene, const RayCaster& ray_caster, const ValidateOptions& options)
        : scene_(scene), ray_caster_(ray_caster), options_(options), surroundings_(scene, ray_caster) {}

    std::vector<Finding> run() {
        add_warnings("degenerate-face", "faces without area were left out",
                     "remove them, or repair the mesh where they leave gaps");
        add_coincident_faces();
        add_inverted_faces();
        add_lamps();
        add_reflectances();
        add_warnings("no-light", "nothing emits light", "give surfaces an emission, or add lamps, a sky or the sun");
        add_warnings("implausible-size", "the scene has an implausible size", "tell the unit of the file");
        add_warnings("maintenance-factor", "maintenance factors are above 1, as if light grew with age",
                     "give 1 for new luminaires, and less for old ones: 0.8 is usual");
        add_open_edges();
        if (scene_.views.empty())
            findings_.push_back({"no-view",
                                 false,
                                 "the file has no view",
                                 "give a view, which concentrates the work on visible surfaces",
                                 1,
                                 {}});
        for (Finding& finding : validate_setup(scene_, ray_caster_, options_)) findings_.push_back(std::move(finding));
        return std::move(findings_);
    }

  private:
    Finder finder(const char* kind, const char* message, const char* advice, bool is_problem = true) {
        return {scene_, options_.places, {kind, is_problem, message, advice, 0, {}}};
    }

    void add_warnings(const char* kind, const char* message, const char* advice) {
        Finding finding{kind, true, message, advice, 0, {}};
        for (const Warnings::Entry& warning : scene_.warnings.entries())
            if (warning.kind == kind) {
                finding.count += warning.count;
                if (!warning.where.empty() && finding.places.size() < options_.places)
                    finding.places.push_back({"", "", warning.where});
            }
        if (finding.count > 0) findings_.push_back(std::move(finding));
    }

    bool is_back(PatchIndex i) const {
        return scene_.patches[i].other_side != none && scene_.patches[i].other_side < i;
    }

    void add_coincident_faces() {
        constexpr float offset_over_tolerance = 4;  // RayCaster::ray_offset()
        std::vector<float> tolerance(scene_.patches.size());
        for (PatchIndex i{0}; i < tolerance.size(); ++i)
            tolerance[i] = ray_caster_.ray_offset(i) / offset_over_tolerance;
        const CoincidentFaces coincident(scene_, tolerance);
        Finder duplicates = finder("duplicate-face", "faces have the same corners as another face, which hides them",
                                   "remove one face of each pair");
        Finder overlaps = finder("coincident-face", "faces lie in the plane of another, which covers a part of them",
                                 "the smaller one is seen there; move the other away where that is not meant", false);
        for (PatchIndex i{0}; i < scene_.patches.size(); ++i) {
            if (is_back(i)) continue;
            if (coincident.is_hidden(i)) duplicates.add_patch(i);
            if (coincident.is_overlapped(i) && !coincident.is_hidden(i)) overlaps.add_patch(i);
        }
        duplicates.append_to(findings_);
        overlaps.append_to(findings_);
    }

    bool emits(PatchIndex i) const {
        return largest_channel(scene_.materials[scene_.patches[i].material].exitance) > 0;
    }

    template <class Condition>
    std::vector<PatchIndex> sampled_patches(const Condition& condition) const {
        constexpr std::size_t most = 4096;
        std::vector<PatchIndex> all, result;
        for (PatchIndex i{0}; i < scene_.patches.size(); ++i)
            if (condition(i)) all.push_back(i);
        const std::size_t step = (all.size() + most - 1) / most;
        for (std::size_t k = 0; k < all.size(); k += step) result.push_back(all[k]);
        return result;
    }

    /// Finds faces with the void in front and the lit scene behind, except bottoms of solids and outer faces of thick
    /// walls.
    void add_inverted_faces() {
        Finder inverted = finder("inverted-face", "one-sided faces have the scene only behind them",
                                 "turn them round: reverse the order of their vertices");
        for (const PatchIndex i :
             sampled_patches([&](PatchIndex k) { return scene_.patches[k].other_side == none && !emits(k); })) {
            const Surroundings front = surroundings_.measure(i, Side::front),
                               back = surroundings_.measure(i, Side::back);
            if (front.escaped == 1 && back.escaped == 0 && 2 * back.one_way < 1) inverted.add_patch(i);
        }
        inverted.append_to(findings_);
    }

    void add_lamps() {
        Finder inverted =
            finder("inverted-lamp", "lamps shine against a surface close before them, with free space behind them",
                   "turn them round: reverse the order of their vertices");
        Finder hidden = finder("hidden-lamp", "lamps are covered or closely enclosed, and light nothing",
                               "move them into the open, or make their enclosure transparent");
        Finder dark = finder("zero-power-lamp", "lamps emit nothing", "remove them, or give them an intensity");
        for (const PatchIndex i : sampled_patches([&](PatchIndex k) { return emits(k); })) {
            if (ray_caster_.uncovered_share(i) == 0) {
                hidden.add_patch(i);
                continue;
            }
            const PatchIndex other = scene_.patches[i].other_side;
            if (other != none && emits(other)) continue;
            const Surroundings front = surroundings_.measure(i, Side::front),
                               back = surroundings_.measure(i, Side::back);
            if (front.blocked > max_blocked && back.blocked < 1 - max_blocked)
                inverted.add_patch(i);
            else if (front.blocked > max_blocked || surroundings_.is_enclosed(i))
                hidden.add_patch(i);
        }
        for (const Luminaire& luminaire : scene_.luminaires) {
            const std::optional<V3f> position = position_of(luminaire);
            const V3f x = position.value_or(V3f(0));
            if (largest_channel(rating(luminaire)) == 0)
                dark.add({scene_.objects[luminaire.object], luminaire.name, "", scene_.origin + Imath::V3d(x),
                          position.has_value()});
        }
        inverted.append_to(findings_);
        hidden.append_to(findings_);
        const SightLines lines(scene_, ray_caster_);
        for (Finding& finding : find_open_lamp_backs(scene_, ray_caster_, lines, options_.places))
            findings_.push_back(std::move(finding));
        dark.append_to(findings_);
    }

    void add_reflectances() {
        Finder high = finder("high-reflectance", "materials reflect more than real surfaces, and lose light slowly",
                             "check them: white paint has 0.8 to 0.9");
        const std::vector<Rgb> largest = largest_texels(scene_);
        std::vector<bool> is_used(scene_.materials.size());
        for (const Patch& patch : scene_.patches) is_used[patch.material] = true;
        for (std::size_t m = 0; m < scene_.materials.size(); ++m) {
            const Material& material = scene_.materials[m];
            const Rgb reflectance = textured(material.reflectance, material.reflectance_texture, largest);
            if (is_used[m] && largest_channel(reflectance) > options_.high_reflectance)
                high.add({"", material.name, ""});
        }
        high.append_to(findings_);
    }

    void add_open_edges() {
        Finder open = finder("open-edge",
                             "edges belong to one face alone: rooms must be closed, though sheets and panels need not",
                             "close gaps through which light would leak", false);
        for (const OpenEdge& edge : open_edges(scene_)) {
            const Patch& patch = scene_.patches[edge.patch];
            open.add_at((edge.a + edge.b) / 2, scene_.objects[patch.object], scene_.materials[patch.material].name);
        }
        open.append_to(findings_);
    }

    static constexpr float max_blocked = 0.9f;

    const Scene& scene_;
    const RayCaster& ray_caster_;
    const ValidateOptions& options_;
    FaceSurroundings surroundings_;
    std::vector<Finding> findings_;
};

}  // namespace

std::vector<Finding> validate(const Scene& scene, const RayCaster& ray_caster, const ValidateOptions& options) {
    ray_caster.require_made_for(scene);
    return Validator(scene, ray_caster, options).run();
}

}  // namespace interflect
