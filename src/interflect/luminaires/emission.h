#pragma once

#include <ImathBox.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <variant>
#include <vector>

#include "interflect/base/numbers/points.h"
#include "interflect/core.h"
#include "interflect/luminaires/opening.h"
#include "interflect/luminaires/skies/sky_radiance.h"
#include "interflect/luminaires/web_sampler.h"
#include "interflect/ray_caster.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Part of a sky's radiance: colour * amount(radiance). All rays of its emitter carry equal power.
struct SkyComponent {
    Rgb colour;
    float (*amount)(const Rgb& radiance);
};

bool line_crosses(const Imath::Box3f& box, const Ray& ray);

/// Samples rays of luminaires. A point, spot or measured light is one emitter. Outside light (directional lights and
/// skies) has emitters per box: the scene's, and targets of high importance. A line of outside light is sampled from
/// the last box that it crosses. Emitters have parts of equal power, by direction or, for outside light, by position.
/// Immutable, thread-safe.
class Emission {
  public:
    Emission() = default;  ///< No luminaires.
    explicit Emission(const Scene& scene, std::span<const Imath::Box3f> targets = {});

    std::size_t part_count() const { return emitters_.size() * parts_per_emitter; }
    /// Returns the power of a part [lm or W]; for outside light, the power through the part's box.
    RgbD power(std::size_t part) const { return emitters_[part / parts_per_emitter].part_power; }
    /// Returns the power of all luminaires, without targets [lm or W].
    RgbD total_power() const { return power_of_boxes(0, 1); }
    /// Returns the power of the targets [lm or W], part of total_power().
    RgbD repeated_power() const { return power_of_boxes(1, boxes_.size()); }
    /// Returns an index into Scene::luminaires.
    std::size_t luminaire(std::size_t part) const { return emitters_[part / parts_per_emitter].luminaire; }
    /// An emitter's parts are the cells of a grid over its (u, v), numbered row by row.
    static constexpr std::size_t cells_per_side = 8, parts_per_emitter = cells_per_side * cells_per_side;

    bool has_sky() const;
    std::size_t sun_count() const { return suns_.size(); }
    /// Samples the direction of sunlight. @param c, d  Uniform in (0, 1).
    V3f sun_direction(std::size_t sun, float c, float d) const;
    const Imath::Box3f& scene_box() const { return boxes_.front(); }
    /// Box 0 is the scene's; targets follow.
    std::size_t box_count() const { return boxes_.size(); }
    std::size_t box(std::size_t part) const { return emitters_[part / parts_per_emitter].box; }

    struct PartAlong {
        std::size_t part;
        double brightness;  ///< Sum of channels: sky radiance, or irradiance facing the sun.
    };
    /// Returns the parts of skies or of a sun that emit along a line.
    /// @param light  Any point of the line, and the direction in which light travels.
    /// @param sun    Index; `none` for skies.
    std::vector<PartAlong> parts_along(const Ray& light, std::uint32_t sun) const;

    /// Generates rays of equal power from the part's samples, beginning with `first_sample`. Rays of outside light
    /// start on or outside the scene's box, and miss it if another box samples their line.
    /// @param key     Key of the part's point sequence (fill_points).
    /// @param points  Working memory.
    void shoot(std::size_t part, PointSet set, std::uint64_t key, std::uint64_t first_sample, PointBlock& points,
               std::span<Ray> rays) const;

    /// Point source that stands for a part in the oracle, with about its irradiance at the end of a ray.
    struct Proxy {
        V3f position{0, 0, 0};  ///< [m]
        V3f normal{0, 0, 0};    ///< Emission is proportional to the cosine; zero: isotropic.
        /// Along the normal; irradiance at distance d is intensity / d^2 [lm/sr or W/sr].
        Rgb intensity{0, 0, 0};
    };
    /// @param distance  Length of the ray [m].
    Proxy proxy(std::size_t part, const Ray& ray, float distance) const;

  private:
    struct Beam {
        V3f position, axis, s, t;
        float inner, outer;  // cosines
        float inner_share;   // of power within `inner`
        Ray ray(float u, float v, float, float) const;
    };
    /// Emits at angles theta from `direction`, up to a maximum, with density proportional to cos(theta).
    struct Rectangle {
        V3f corner, edge_u, edge_v;
        V3f direction, s, t;
        float sine;       // of the maximum angle; 0: parallel, 1: diffuse
        float part_area;  // of the emitter for the scene's box
        bool is_sky() const { return sine == 1; }
        Ray ray(float u, float v, float c, float d) const;
    };
    /// Side of a box, which emits one component of a sky inwards.
    struct SkySide {
        V3f corner, edge_u, edge_v, normal;
        std::shared_ptr<const SkyRadiance> sky;
        std::shared_ptr<const DirectionTable> directions;
        SkyComponent component;
        float part_area;  // as in Rectangle
        Ray ray(float u, float v, float c, float d) const;
    };
    /// Rays start `offset` [m] above the opening, which may lie in a surface.
    struct Web {
        std::shared_ptr<const WebSampler> sampler;
        std::shared_ptr<const PhotometricWeb> light;
        LuminaireFrame frame;
        V3f position;
        float offset;
        Ray ray(float u, float v, float c, float d) const;
    };
    struct Emitter {
        std::variant<Beam, Rectangle, SkySide, Web> shape;
        Rgb rating;  // Beam: intensity; Rectangle: exitance; SkySide: colour; Web: factor
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
    void add_rectangle(Rectangle rectangle, const Rgb& exitance, std::size_t box);
    RgbD power_of_boxes(std::size_t begin, std::size_t end) const;
    Ray restrict_to_box(const Ray& ray, std::size_t box) const;

    std::vector<Imath::Box3f> boxes_;  // the scene's, then targets
    std::vector<std::size_t> suns_;    // emitters of directional lights, for box 0
    std::vector<std::vector<std::size_t>> emitters_of_boxes_;
    std::vector<Emitter> emitters_;
    std::map<const PhotometricWeb*, std::shared_ptr<const WebSampler>> samplers_;
};

}  // namespace interflect::detail
