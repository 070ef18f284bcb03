#include <ImathBox.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <numbers>
#include <optional>
#include <vector>

#include "interflect/base/threads/parallel.h"
#include "interflect/checks/faces/up_axis.h"
#include "interflect/checks/views/eye_places.h"
#include "interflect/checks/views/lit_sights.h"
#include "interflect/geometry/textures/tangent_frame.h"
#include "interflect/prepare.h"
#include "interflect/raycast/camera.h"
#include "interflect/scene/core/core.h"
#include "interflect/scene/core/view.h"

namespace interflect {

using namespace detail;

namespace {

/// Minimum share of rays that find light: paths of six reflections find a window of 0.2% of the surfaces that often.
constexpr float least_lit = 0.01f;

/// Distances [m] beyond which a larger room is not rated higher, and beyond which surfaces near the eye do not matter.
constexpr float far_enough = 4, free_enough = 1;

/// Number of rays from each of the best eyes.
constexpr std::size_t many_rays = 96;

/// Summary of the rays from an eye.
struct Prospect {
    float fronts = 0, backs = 0, enclosed = 0, lit = 0;  ///< Shares of all rays, as in Sight.
    float openness = 0;   ///< Mean distance of fronts, with a limit of far_enough; other rays count 0 [m].
    float closeness = 0;  ///< Distance within which a tenth of the fronts are [m].

    /// Whether the eye sees light from the free space of the scene.
    bool is_usable() const {
        constexpr float most_backs = 0.1f, least_fronts = 0.5f;  // a ground fills half of all directions
        return backs <= most_backs && fronts >= least_fronts && lit >= least_lit;
    }
    /// Few paths find light where windows are small, so the share of lit rays counts by its square root. Surfaces that
    /// are not enclosed count little, for eyes in windows and below canopies.
    float rating() const {
        return std::sqrt(lit) * enclosed * enclosed * openness * std::min(closeness / free_enough, 1.0f);
    }
};

Prospect prospect_of(const std::vector<Sight>& sights) {
    Prospect result;
    std::vector<float> distances;
    for (const Sight& sight : sights) {
        result.fronts += sight.meets_front;
        result.backs += sight.meets_back;
        result.enclosed += sight.is_enclosed;
        result.lit += sight.is_lit;
        result.openness += std::min(sight.distance, far_enough);
        if (sight.meets_front) distances.push_back(sight.distance);
    }
    const auto count = static_cast<float>(sights.size());
    for (float* sum : {&result.fronts, &result.backs, &result.enclosed, &result.lit, &result.openness}) *sum /= count;
    if (distances.empty()) return result;
    const auto tenth = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 10);
    std::nth_element(distances.begin(), tenth, distances.end());
    result.closeness = *tenth;
    return result;
}

/// An eye with its prospect in all directions.
struct RatedEye {
    V3f eye{0, 0, 0};
    Prospect prospect{};
};

/// Returns directions that divide the sphere evenly, on a spiral.
std::vector<V3f> sphere_directions(std::size_t count) {
    constexpr float golden_angle = std::numbers::pi_v<float> * (3 - 2.2360680f);
    std::vector<V3f> directions;
    for (std::size_t i = 0; i < count; ++i) {
        const float z = 1 - (2 * static_cast<float>(i) + 1) / static_cast<float>(count);
        const float radius = std::sqrt(1 - z * z), angle = golden_angle * static_cast<float>(i);
        directions.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
    }
    return directions;
}

/// Returns whether a ceiling is above an eye. Some of the rays, up to 18 degrees from the zenith, leave streets and
/// courtyards. One ray may pass a skylight.
bool has_ceiling(const LitSights& sights, const V3f& eye, const V3f& up) {
    constexpr int around = 7;
    constexpr float sine = 0.31f, cosine = 0.95f;
    const TangentFrame frame(up);
    int met = sights.meets_front({eye, up});
    for (int k = 0; k < around; ++k) {
        const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(k) / around;
        const V3f across = std::cos(angle) * frame.s + std::sin(angle) * frame.t;
        met += sights.meets_front({eye, (sine * across + cosine * up).normalized()});
    }
    return met >= around;
}

/// @param rays  Number of rays from each eye, in all directions.
std::vector<RatedEye> rate(const LitSights& sights, const std::vector<V3f>& eyes, std::size_t rays) {
    const std::vector<V3f> directions = sphere_directions(rays);
    std::vector<RatedEye> rated(eyes.size());
    parallel_for_ranges(eyes.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) rated[i] = {eyes[i], prospect_of(sights.look(eyes[i], directions))};
    });
    return rated;
}

/// Returns the best eye that meets a condition. The best few are rated again with more rays, by the same condition.
template <class Condition>
std::optional<RatedEye> best_eye(const LitSights& sights, const std::vector<RatedEye>& rated,
                                 const Condition& condition) {
    constexpr std::size_t few = 4;
    const auto better = [](const RatedEye& a, const RatedEye& b) { return a.prospect.rating() > b.prospect.rating(); };
    std::vector<RatedEye> fit;
    std::copy_if(rated.begin(), rated.end(), std::back_inserter(fit), condition);
    std::stable_sort(fit.begin(), fit.end(), better);
    std::vector<V3f> eyes;
    for (std::size_t i = 0; i < std::min(few, fit.size()); ++i) eyes.push_back(fit[i].eye);
    std::optional<RatedEye> best;
    for (const RatedEye& eye : rate(sights, eyes, many_rays))
        if (condition(eye) && (!best || better(eye, *best))) best = eye;
    return best;
}

/// Returns the horizontal direction in which a camera shows most lit surfaces.
V3f best_direction(const LitSights& sights, const RatedEye& eye, const V3f& up) {
    constexpr int azimuths = 24, rows = 8, half_width = 2;  // columns on each side of a picture's middle: 75 degrees
    constexpr float lowest = -0.7f, highest = 0.3f;         // vertical components of the rays
    constexpr float step = 2 * std::numbers::pi_v<float> / azimuths;
    const TangentFrame frame(up);
    const auto horizontal = [&](int column) {
        const float angle = step * static_cast<float>(column);
        return std::cos(angle) * frame.s + std::sin(angle) * frame.t;
    };
    std::vector<V3f> directions;
    for (int column = 0; column < azimuths; ++column)
        for (int row = 0; row < rows; ++row) {
            const float z = lowest + (highest - lowest) * (static_cast<float>(row) + 0.5f) / rows;
            directions.push_back(std::sqrt(1 - z * z) * horizontal(column) + z * up);
        }
    const std::vector<Sight> seen = sights.look(eye.eye, directions);
    // Lit surfaces count by their squared distance, since close ones hide the room. Surfaces outside of windows are
    // rarely enclosed, and count little.
    std::array<float, azimuths> lit{}, enclosed{};
    for (std::size_t i = 0; i < seen.size(); ++i) {
        const float distance = std::min(seen[i].distance / (2 * eye.prospect.openness), 1.0f);
        if (seen[i].is_lit) lit[i / rows] += distance * distance;
        enclosed[i / rows] += seen[i].is_enclosed;
    }
    int best = 0;
    float most = -1;
    for (int column = 0; column < azimuths; ++column) {
        float lit_sum = 0, enclosed_sum = 0;
        for (int k = -half_width; k <= half_width; ++k) {
            const auto i = static_cast<std::size_t>((column + k + azimuths) % azimuths);
            lit_sum += lit[i];
            enclosed_sum += enclosed[i];
        }
        if (const float score = lit_sum * enclosed_sum * enclosed_sum; score > most) {
            most = score;
            best = column;
        }
    }
    return horizontal(best);
}

/// Returns an eye farther back that meets the condition too and shows more of the room, else the same eye.
template <class Condition>
RatedEye step_back(const LitSights& sights, const RatedEye& eye, const V3f& direction, const Condition& condition) {
    constexpr float clearance = 0.4f;                 // of the surface behind [m]
    constexpr float least_relative_lit = 0.5f;        // a place behind a wardrobe shows less light
    constexpr std::array shares{1.0f, 0.67f, 0.33f};  // of the free distance, for rooms with niches and doors
    const Sight behind = sights.look(eye.eye, {{-direction}}).front();
    const float distance = std::min(behind.distance - clearance, far_enough);
    if (!behind.meets_front || distance <= 0) return eye;
    std::vector<V3f> places;
    places.reserve(shares.size());
    for (const float share : shares) places.push_back(eye.eye - share * distance * direction);
    for (const RatedEye& place : rate(sights, places, many_rays))
        if (condition(place) && place.prospect.lit >= least_relative_lit * eye.prospect.lit) return place;
    return eye;
}

/// Returns a copy of a view with another eye and a horizontal direction.
View view_from(const Scene& scene, const RatedEye& eye, const V3f& direction, const V3f& up, View view) {
    constexpr float down = 0.15f;  // vertical over horizontal component: 9 degrees below the horizon
    view.eye = scene.origin + Imath::V3d(eye.eye);
    view.look_at = view.eye + Imath::V3d(direction - down * up) * static_cast<double>(eye.prospect.openness);
    view.up = up;
    return view;
}

/// Returns the directions of a coarse picture.
std::vector<V3f> picture_directions(const Scene& scene, const View& view) {
    constexpr int width = 16, height = 9;
    const Camera camera(view, width, height, scene.origin);
    std::vector<V3f> directions;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            directions.push_back(camera.ray(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f).direction);
    return directions;
}

}  // namespace

View overview(const Scene& scene, const RayCaster& ray_caster) {
    ray_caster.require_made_for(scene);
    View from_corner = overview(scene);
    if (scene.patches.empty() || !emits_light(scene) || !view_fault(from_corner).empty()) return from_corner;

    // Keep the view from the corner if it shows a lit interior.
    constexpr float least_enclosed_view = 0.5f;  // a room without a ceiling has 0.6; streets have 0.3
    const LitSights sights(scene, ray_caster);
    const Prospect shown =
        prospect_of(sights.look(V3f(from_corner.eye - scene.origin), picture_directions(scene, from_corner)));
    if (shown.enclosed >= least_enclosed_view && shown.lit >= least_lit) return from_corner;

    // Otherwise prefer a lit room to all else.
    constexpr std::size_t few_rays = 20;
    constexpr float least_enclosed = 0.6f;                             // 0.5 below a canopy on columns
    constexpr float room_openness = 0.75f, relative_openness = 0.15f;  // [m]; of a small scene's diagonal
    const float least_openness = std::min(room_openness, relative_openness * core_bounds(scene).size().length());
    const char* const other_axis = find_other_up_axis(scene);
    const V3f up = other_axis ? UpAxis{other_axis, ""}.direction() : V3f(0, 0, 1);
    const auto is_in_room = [&](const RatedEye& rated) {
        const Prospect& p = rated.prospect;
        return p.is_usable() && p.enclosed >= least_enclosed && p.openness >= least_openness &&
               has_ceiling(sights, rated.eye, up);
    };
    const auto view_from_back = [&](const RatedEye& eye, const auto& condition) {
        const V3f direction = best_direction(sights, eye, up);
        return view_from(scene, step_back(sights, eye, direction, condition), direction, up, from_corner);
    };
    const std::vector<RatedEye> rated = rate(sights, eye_places(scene, ray_caster, up), few_rays);
    if (const std::optional<RatedEye> eye = best_eye(sights, rated, is_in_room))
        return view_from_back(*eye, is_in_room);

    // Without a room, replace only a dark view.
    if (shown.lit >= least_lit) return from_corner;
    const auto is_usable = [](const RatedEye& place) { return place.prospect.is_usable(); };
    const std::optional<RatedEye> eye = best_eye(sights, rated, is_usable);
    return eye ? view_from_back(*eye, is_usable) : from_corner;
}

}  // namespace interflect
