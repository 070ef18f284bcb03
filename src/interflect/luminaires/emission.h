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
#include "interflect/colour.h"
#include "interflect/luminaires/opening.h"
#include "interflect/luminaires/sky_radiance.h"
#include "interflect/luminaires/web_sampler.h"
#include "interflect/ray_caster.h"
#include "interflect/scene.h"

namespace interflect::inline detail {

/// Part of a sky's radiance with a single colour, which gives all rays of a part the same power.
struct SkyComponent {
    Rgb colour;
    float (*amount)(const Rgb& radiance);  ///< Amount of that colour.
};

/// Whether the infinite line of a ray crosses a box.
bool line_crosses(const Imath::Box3f& box, const Ray& ray);

/// Generates rays from the luminaires of a scene. Their emission is divided into parts of equal power, by direction
/// (point, spot and measured lights) or by position (directional lights and skies). Importance sampling chooses the
/// number of rays per part. If light from outside is important only in small boxes, its lines are divided first: each
/// is shot from the sides of the last box that it crosses. Immutable, shared by all threads.
class Emission {
  public:
    Emission() = default;  ///< No luminaires.
    /// @param targets  Boxes inside the box around the scene.
    explicit Emission(const Scene& scene, std::span<const Imath::Box3f> targets = {});

    std::size_t part_count() const { return emitters_.size() * parts_per_emitter; }
    /// Returns the power of a part [lm or W]. For directional light and skies: the power through its box, which is the
    /// box around the scene or a target. Rays start on the scene's box; rays along lines of another box miss the scene.
    RgbD power(std::size_t part) const { return emitters_[part / parts_per_emitter].part_power; }
    /// Sum over all luminaires. Light from outside counts where it crosses the box around the scene.
    RgbD total_power() const { return power_of_boxes(0, 1); }
    /// Sum over the parts of all targets.
    RgbD repeated_power() const { return power_of_boxes(1, boxes_.size()); }
    /// Returns the index in Scene::luminaires.
    std::size_t luminaire(std::size_t part) const { return emitters_[part / parts_per_emitter].luminaire; }
    /// Parts with the same part / parts_per_emitter belong to one luminaire or one side of the sky; the benefit of
    /// their importance is similar.
    static constexpr std::size_t cells_per_side = 8, parts_per_emitter = cells_per_side * cells_per_side;

    bool has_sky() const;
    /// Number of directional lights.
    std::size_t sun_count() const { return suns_.size(); }
    /// Returns the direction of a sun's light for c and d uniform in (0, 1).
    V3f sun_direction(std::size_t sun, float c, float d) const;
    const Imath::Box3f& scene_box() const { return boxes_.front(); }
    /// Number of boxes: the scene's box is 0, targets follow.
    std::size_t box_count() const { return boxes_.size(); }
    std::size_t box(std::size_t part) const { return emitters_[part / parts_per_emitter].box; }

    /// Part of light from outside that emits along a line.
    struct PartAlong {
        std::size_t part;
        double brightness;  ///< Sum of the channels: radiance of a sky, or irradiance of a surface that faces the sun.
    };
    /// @param light  Any point of the line and the direction of the light. @param sun  Its index; none: parts of skies.
    std::vector<PartAlong> parts_along(const Ray& light, std::uint32_t sun) const;

    /// Generates the rays of samples first_sample, first_sample + 1, ... of a part. All carry the same power.
    /// @param key     Key of the part's point sequence (fill_points).
    /// @param points  Working memory.
    /// @param rays    Receives the rays; its size is their number.
    void shoot(std::size_t part, PointSet set, std::uint64_t key, std::uint64_t first_sample, PointBlock& points,
               std::span<Ray> rays) const;

    /// Point source that represents a part near one of its rays, for estimates of the power received from it.
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
    /// Emits from a parallelogram with a density proportional to cos(theta) about a direction, up to an angle.
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
    /// Emits in the directions of a photometric web from its opening. Rays start `offset` further, because the opening
    /// may lie in a surface.
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

    std::vector<Imath::Box3f> boxes_;                 // around the scene, then targets; empty without patches
    std::vector<std::size_t> suns_;                   // emitters of directional lights for the scene's box
    std::vector<std::vector<std::size_t>> of_boxes_;  // emitters of each box
    std::vector<Emitter> emitters_;
    std::map<const PhotometricWeb*, std::shared_ptr<const WebSampler>> samplers_;
};

}  // namespace interflect::inline detail
