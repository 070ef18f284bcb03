#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "interflect/audit/sampled_sources.h"
#include "interflect/base/numbers/points.h"
#include "interflect/base/numbers/random.h"
#include "interflect/base/threads/parallel.h"
#include "interflect/geometry/polygons/patch_geometry.h"
#include "interflect/leaks.h"
#include "interflect/luminaires/emission.h"
#include "interflect/render/lights/path_samples.h"
#include "interflect/solver/light/materials.h"

namespace interflect {

using namespace detail;

namespace {

/// Extra or missing light, by the faces that cause it.
struct LightByFace {
    std::map<std::pair<std::uint32_t, std::uint32_t>, double> power;  // power by object and material
    double sum = 0, reflected = 0;

    /// Adds power that is extra or missing because of a face. @param count  Number of surfaces that receive it in turn,
    /// including the first.
    void add(const Patch& face, double first_received, double count) {
        power[{face.object, face.material}] += first_received * count;
        sum += first_received * count;
        if (count > 1) reflected += first_received * (count - 1);
    }
    std::pair<std::uint32_t, std::uint32_t> object_and_material() const {
        return std::max_element(power.begin(), power.end(),
                                [](const auto& a, const auto& b) { return a.second < b.second; })
            ->first;
    }
};

/// Number of rays that are tested together. All of them would take megabytes.
constexpr std::size_t rays_at_once = 1 << 12;

/// Compares the hits of light rays with the hits of the reversed rays.
class OneWayTest {
  public:
    OneWayTest(const Scene& scene, const RayCaster& ray_caster)
        : scene_(scene), ray_caster_(ray_caster), materials_(scene, ray_caster) {}

    /// Tests rays. @param source  Returns the patch at the start of ray i; `none` for luminaires.
    /// @param power  Power of each ray, sum of the channels [lm or W].
    template <class Source>
    void add(std::span<const Ray> rays, const Source& source, double power) {
        std::vector<Outcome> outcomes;
        for (std::size_t first = 0; first < rays.size(); first += rays_at_once) {
            const auto some = rays.subspan(first, std::min(rays_at_once, rays.size() - first));
            outcomes.assign(some.size(), {});
            constexpr std::size_t rays_per_task = 256;
            parallel_for_ranges(some.size(), rays_per_task, [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i) outcomes[i] = test(some[i], source(first + i));
            });
            for (const Outcome& outcome : outcomes) {
                if (outcome.is_received) received_ += power;
                for (const Crossing& crossing : outcome.crossings)
                    (crossing.is_extra ? extra_ : missing_)
                        .add(scene_.patches[crossing.face], power, spread(crossing.place, crossing.patch));
            }
        }
    }
    OneWayLight result() const {
        const LightByFace& most = extra_.sum > missing_.sum ? extra_ : missing_;
        if (!(most.sum > 0)) return {};
        const auto [object, material] = most.object_and_material();
        return {(extra_.sum - missing_.sum) / received_, (extra_.reflected - missing_.reflected) / received_, object,
                material};
    }

  private:
    /// One-sided face that hides a surface from a source, or a source from a surface.
    struct Crossing {
        std::uint32_t face;
        bool is_extra;  // whether the surface receives light; otherwise it misses light
        V3f place;      // on the surface
        PatchIndex patch;
    };
    struct Outcome {
        bool is_received = false;
        std::vector<Crossing> crossings;
    };

    Outcome test(const Ray& ray, PatchIndex source) const {
        Outcome outcome;
        Hit hit = trace(ray);
        if (hit.patch == none) return outcome;
        outcome.is_received = true;
        V3f place = ray.origin + hit.distance * ray.direction;
        if (const std::uint32_t face = face_between(ray.origin, source, place, hit.patch); face != none) {
            outcome.crossings.push_back({face, true, place, hit.patch});
            return outcome;
        }
        // Surfaces behind a one-sided face miss this light if they see the source through its back.
        const std::uint32_t stopped_by = hit.patch;
        while (scene_.patches[hit.patch].other_side == none) {
            const Ray behind{place - ray_caster_.ray_offset(hit.patch) * normal(hit.patch), ray.direction};
            hit = trace(behind);
            if (hit.patch == none) return outcome;
            place = behind.origin + hit.distance * ray.direction;
            if (face_between(ray.origin, source, place, hit.patch) != none) return outcome;
            outcome.crossings.push_back({stopped_by, false, place, hit.patch});
        }
        return outcome;
    }

    Hit trace(const Ray& ray) const {
        Hit hit;
        ray_caster_.trace({&ray, 1}, {&hit, 1});
        return hit;
    }
    V3f normal(PatchIndex patch) const { return PatchGeometry(scene_, scene_.patches[patch]).normal(); }

    /// Returns the patch that hides the start of a light ray from `place`, or `none`.
    std::uint32_t face_between(const V3f& start, std::uint32_t source, const V3f& place, PatchIndex patch) const {
        constexpr float rounding = 1e-4f, offsets = 8;  // tolerances of the distance: relative, and in ray offsets
        const float offset = ray_caster_.ray_offset(patch), distance = (start - place).length();
        if (!(distance > 0)) return none;  // the ray starts in a corner
        const Hit back = trace({place + offset * normal(patch), (start - place) / distance});
        const bool is_seen =
            back.patch == none || back.patch == source || back.distance >= distance * (1 - rounding) - offsets * offset;
        return is_seen ? none : back.patch;
    }

    /// Samples by a random walk how many surfaces receive light that starts at `place`. The walk ends at one-way lines
    /// of sight, so light inside closed solids counts 0.
    double spread(V3f place, PatchIndex patch) {
        constexpr float longest_walk = 1000;
        float sum = 0;
        while (sum < longest_walk) {
            const std::array<std::uint32_t, 4> words = random_words(audit_seed, walk_steps_++);
            const Ray ray{place + ray_caster_.ray_offset(patch) * normal(patch),
                          cosine_direction(normal(patch), unit_float(words[0]), unit_float(words[1]))};
            const Hit hit = trace(ray);
            const V3f next = ray.origin + hit.distance * ray.direction;
            if (hit.patch != none && face_between(ray.origin, patch, next, hit.patch) != none) break;
            ++sum;
            if (hit.patch == none || unit_float(words[2]) >= materials_.mean_reflectance(patch)) break;
            place = next;
            patch = hit.patch;
        }
        return static_cast<double>(sum);
    }

    const Scene& scene_;
    const RayCaster& ray_caster_;
    Materials materials_;
    double received_ = 0;
    LightByFace extra_, missing_;
    std::uint64_t walk_steps_ = 0;
};

void add_surfaces(const Scene& scene, const RayCaster& ray_caster, const Solution& solution, OneWayTest& test) {
    PointBlock points;
    std::uint64_t sample = 0;
    const SampledSources from = sample_sources(scene, ray_caster, solution);
    std::vector<Ray> rays;
    for (std::size_t first = 0; first < from.leaves.size(); first += rays_at_once) {
        const auto leaves = std::span(from.leaves).subspan(first, std::min(rays_at_once, from.leaves.size() - first));
        rays.clear();
        for (const ElementIndex leaf : leaves)
            rays.push_back(ray_from(leaf, *solution.forest, ray_caster, sample++, points));
        test.add(
            rays, [&](std::size_t i) { return solution.forest->patch(leaves[i]); }, from.power_of_each());
    }
}

/// Traces rays of each luminaire part. Their number is in proportion to its power, rounded up.
void add_luminaires(const Scene& scene, OneWayTest& test) {
    const Emission emission(scene);
    const double total = channel_sum(emission.total_power());
    PointBlock points;
    std::vector<Ray> rays;
    for (std::size_t part = 0; part < emission.part_count() && total > 0; ++part) {
        const double power = channel_sum(emission.power(part));
        rays.resize(static_cast<std::size_t>(std::ceil(audit_rays * (power / total))));
        emission.shoot(part, PointSet::random, audit_seed, 0, points, rays);
        test.add(
            rays, [](std::size_t) { return no_patch; }, power / static_cast<double>(rays.size()));
    }
}

}  // namespace

OneWayLight find_one_way_light(const Scene& scene, const RayCaster& ray_caster, const Solution& solution) {
    solution.forest->require_made_for(scene);
    ray_caster.require_made_for(scene);
    const bool has_one_sided_faces = std::any_of(scene.patches.begin(), scene.patches.end(),
                                                 [](const Patch& patch) { return patch.other_side == none; });
    if (!has_one_sided_faces) return {};
    OneWayTest test(scene, ray_caster);
    add_surfaces(scene, ray_caster, solution, test);
    add_luminaires(scene, test);
    return test.result();
}

}  // namespace interflect
