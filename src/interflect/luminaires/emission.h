#pragma once

#include <ImathBox.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <variant>
#include <vector>

#include "interflect/base/points.h"
#include "interflect/core.h"
#include "interflect/luminaires/opening.h"
#include "interflect/luminaires/sky_radiance.h"
#include "interflect/luminaires/web_sampler.h"
#include "interflect/ray_caster.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Part of a sky's radiance with a single colour: all rays of a part carry the same power.
struct SkyComponent {
    Rgb colour;
    float (*amount)(const Rgb& radiance);  ///< Amount of that colour.
};

/// Whether the infinite line of a ray crosses a box.
bool line_crosses(const Imath::Box3f& box, const Ray& ray);

/// Generates rays from a scene's luminaires. Emission is divided into parts of equal power, by direction (point, spot
/// and measured lights) or position (directional lights and skies). Importance decides the rays per part. Outside light
/// that is important only in small boxes is divided first: each line is shot from the sides of the last box that it
/// crosses. Immutable, shared by all threads.
class Emission {
  public:
    Emission() = default;  ///< No luminaires.
    /// @param targets  Boxes inside the box around the scene.
    explicit Emission(const Scene& scene, std::span<const Imath::Box3f> targets = {});

    std::size_t part_count() const { return emitters_.size() * parts_per_emitter; }
    /// Returns the power of a part [lm or W]; for directional light and skies the power through its box (the scene's
    /// box or a target). Rays start on the scene's box; rays along lines of another box miss the scene.
    RgbD power(std::size_t part) const { return emitters_[part / parts_per_emitter].part_power; }
    /// Sum over all luminaires; outside light counts where it crosses the scene's box.
    RgbD total_power() const { return power_of_boxes(0, 1); }
    /// Sum over the parts of all targets.
    RgbD repeated_power() const { return power_of_boxes(1, boxes_.size()); }
    /// Index in Scene::luminaires.
    std::size_t luminaire(std::size_t part) const { return emitters_[part / parts_per_emitter].luminaire; }
    /// part / parts_per_emitter groups the parts of one luminaire or side of the sky, whose importance is comparable.
    static constexpr std::size_t cells_per_side = 8, parts_per_emitter = cells_per_side * cells_per_side;

    bool has_sky() const;
    /// Number of directional lights.
    std::size_t sun_count() const { return suns_.size(); }
    /// Returns a direction of a sun's light for c and d uniform in (0, 1).
    V3f sun_direction(std::size_t sun, float c, float d) const;
    const Imath::Box3f& scene_box() const { return boxes_.front(); }
    /// Box 0 is the scene's box, targets follow.
    std::size_t box_count() const { return boxes_.size(); }
    std::size_t box(std::size_t part) const { return emitters_[part / parts_per_emitter].box; }

    /// Part of outside light that emits along a line.
    struct PartAlong {
        std::size_t part;
        double brightness;  ///< Sum of the channels: radiance of a sky, or irradiance of a surface that faces the sun.
    };
    /// @param light  Any point of the line and the direction of the light. @param sun  Index; `none`: parts of skies.
    std::vector<PartAlong> parts_along(const Ray& light, std::uint32_t sun) const;

    /// Fills `rays` with samples first_sample, first_sample + 1, ... of a part. All rays carry the same power.
    /// @param key     Key of the part's point sequence (fill_points).
    /// @param points  Working memory.
    void shoot(std::size_t part, PointSet set, std::uint64_t key, std::uint64_t first_sample, PointBlock& points,
               std::span<Ray> rays) const;

    /// Point source in place of a part near one of its rays, to estimate the power received from it.
    struct Proxy {
        V3f position{0, 0, 0};  ///< [m]
        V3f normal{0, 0, 0};    ///< Emission is proportional to the cosine with it; 0: isotropic.
        /// Along the normal; the irradiance at a distance d is intensity / d^2 [lm/sr or W/sr].
        Rgb intensity{0, 0, 0};
    };
    /// @param distance  Length of the ray [m].
    Proxy proxy(std::size_t part, const Ray& ray, float distance) const;

  private:
    /// Emits into the cone around `axis` from cosine 1 to `outer`.
    struct Beam {
        V3f position, axis, s, t;
        float inner, outer;  // cosines
        float inner_share;   // share of the power within the inner angle
        Ray ray(float u, float v, float, float) const;
    };
    /// Emits from a parallelogram by cos(theta) about a direction, up to an angle.
    struct Window {
        V3f corner, edge_u, edge_v;
        V3f direction, s, t;
        float sine;       // of that angle; 0: parallel; 1: diffuse
        float part_area;  // on the scene's box, which the oracle also uses for targets
        bool is_sky() const { return sine == 1; }
        Ray ray(float u, float v, float c, float d) const;
    };
    /// Emits from a side of the scene's box in the directions of a sky.
    struct SkySide {
        V3f corner, edge_u, edge_v, normal;
        std::shared_ptr<const SkyRadiance> sky;
        std::shared_ptr<const DirectionTable> places;
        SkyComponent component;
        float part_area;  // as in Window
        Ray ray(float u, float v, float c, float d) const;
    };
    /// Emits in the directions of a photometric web from its opening, `offset` further since it may lie in a surface.
    struct Web {
        std::shared_ptr<const WebSampler> sampler;
        std::shared_ptr<const PhotometricWeb> light;
        LuminaireFrame frame;
        V3f position;
        float offset;
        Ray ray(float u, float v, float c, float d) const;
    };
    struct Emitter {
        std::variant<Beam, Window, SkySide, Web> shape;
        Rgb rating;
        RgbD part_power;
        std::size_t box = 0;
        std::size_t luminaire = 0;
    };

    void add(const PointLight& light);
    void add(const SpotLight& light);
    void add(const DirectionalLight& light);
    void add(const UniformSky& sky);
    void add(const MeasuredLight& light);
    void add(const SkyDome& dome);
    void add(const EnvironmentMap& map);
    void add_sky(const std::shared_ptr<const SkyRadiance>& sky, const SkyGrid& grid,
                 std::span<const SkyComponent> components);
    void add_beam(const Beam& beam, const Rgb& intensity);
    void add_window(Window window, const Rgb& exitance, std::size_t box);
    RgbD power_of_boxes(std::size_t begin, std::size_t end) const;
    Ray of_box(const Ray& ray, std::size_t box) const;

    std::vector<Imath::Box3f> boxes_;                 // of the scene, then targets; empty without patches
    std::vector<std::size_t> suns_;                   // emitters of directional lights for box 0
    std::vector<std::vector<std::size_t>> of_boxes_;  // emitters of each box
    std::vector<Emitter> emitters_;
    std::map<const PhotometricWeb*, std::shared_ptr<const WebSampler>> samplers_;
};

}  // namespace interflect::detail
