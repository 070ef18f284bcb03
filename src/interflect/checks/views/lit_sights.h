#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "interflect/checks/search/sight_lines.h"
#include "interflect/ray_caster.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// First surface along a ray, beyond panes, and whether light reaches it.
struct Sight {
    V3f direction{0, 0, 1};
    float distance = 0;        ///< [m]; 0 unless the ray meets a front.
    bool meets_front = false;  ///< Otherwise the ray escapes or meets a back.
    bool meets_back = false;   ///< Whether the ray first passes the back of a one-sided face.
    bool is_enclosed = false;  ///< Whether a diffuse ray from the surface meets another one: probable inside rooms.
    /// Whether the surface emits, or a random path of at most LitSights::max_reflections finds light. In a room whose
    /// windows are a fiftieth of its surfaces, about one path in ten does.
    bool is_lit = false;
};

/// Traces rays from an eye, and short random paths from the surfaces that they meet. Deterministic and thread-safe.
/// Arguments must outlive it.
class LitSights {
  public:
    LitSights(const Scene& scene, const RayCaster& ray_caster);

    static constexpr std::uint64_t max_reflections = 6;

    /// Traces at most 36 rays for each direction, usually 6 to 20.
    std::vector<Sight> look(const V3f& eye, std::span<const V3f> directions) const;

    bool meets_front(const Ray& ray) const { return meet(ray).patch != none; }

  private:
    /// Point light, spot, measured light or emitting patch.
    struct Source {
        V3f position;
        float intensity;                       // maximum over directions [cd or W/sr]
        const Luminaire* luminaire = nullptr;  // null for patches
        PatchIndex patch{};
    };
    /// Cumulative intensities of the sources, divided by their squared distances from an eye.
    using Weights = std::vector<float>;
    struct Meeting {
        PatchIndex patch{};     // none if the ray escapes or passes a back
        bool is_back = false;   // whether the ray passes the back of a one-sided face
        float distance = 0;     // [m]
        V3f position{0, 0, 0};  // above the surface, where rays from it start
        V3f normal{0, 0, 0};
        bool escapes() const { return patch == none && !is_back; }
    };

    Weights weights_at(const V3f& eye) const;
    Meeting meet(const Ray& ray) const;
    bool passes_back(const Ray& ray, const Hit& hit) const;
    const Material& material(const Meeting& point) const;
    bool receives_light(const Meeting& point, const Weights& weights, std::uint64_t index) const;
    bool receives_light(const Meeting& point, const Source& source, float u, float v) const;
    bool is_unoccluded(const Meeting& point, const V3f& towards, float distance) const;
    Sight sight(const Ray& ray, const Weights& weights, std::uint64_t index) const;

    const Scene& scene_;
    const RayCaster& ray_caster_;
    SightLines lines_;
    bool has_panes_, has_one_sided_faces_, has_sky_ = false;
    float beyond_ = 0;  // length of a ray from within the scene to its outside [m]
    std::vector<const Luminaire*> suns_;
    std::vector<Source> sources_;
};

}  // namespace interflect::detail
