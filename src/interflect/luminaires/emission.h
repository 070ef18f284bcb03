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

/// A share of a sky's radiance that is of one colour: all rays of a part carry the same power.
struct SkyComponent {
    Rgb colour;
    float (*amount)(const Rgb& radiance);  ///< Of that colour.
};

/// Whether the whole line of a ray crosses a box.
bool line_crosses(const Imath::Box3f& box, const Ray& ray);

/// Rays from the luminaires of a scene. What a luminaire emits is divided into parts of equal power, by direction
/// (point, spot and measured lights) or by place (a directional light, a sky): each part gets rays of its own, so that
/// importance can tell which of them matter. Where light from outside matters within small boxes alone, its lines are
/// divided first: each is shot from the sides of the last box that it crosses. Immutable, shared by all threads.
class Emission {
  public:
    Emission() = default;  ///< There are no luminaires.
    /// @param targets  Boxes within that around the scene.
    explicit Emission(const Scene& scene, std::span<const Imath::Box3f> targets = {});

    std::size_t part_count() const { return emitters_.size() * parts_per_emitter; }
    /// What a part emits [lm or W]. Of directional light and of a sky: what crosses the box around the scene, on which
    /// its rays start, or one of the targets; rays along the lines of another box miss the scene.
    RgbD power(std::size_t part) const { return emitters_[part / parts_per_emitter].part_power; }
    /// Sum over all luminaires; light from outside counts where it crosses the box around the scene.
    RgbD total_power() const { return power_of_boxes(0, 1); }
    /// Power of the parts along the lines of other boxes.
    RgbD repeated_power() const { return power_of_boxes(1, boxes_.size()); }
    /// Index in Scene::luminaires.
    std::size_t luminaire(std::size_t part) const { return emitters_[part / parts_per_emitter].luminaire; }
    /// Neighbouring parts, those of one luminaire or of one side of the sky, are alike in what their importance is
    /// worth: part / parts_per_emitter tells which belong together.
    static constexpr std::size_t cells_per_side = 8, parts_per_emitter = cells_per_side * cells_per_side;

    bool has_sky() const;
    /// Number of directional lights.
    std::size_t sun_count() const { return suns_.size(); }
    /// In which light of a sun goes, for c and d uniform in (0, 1).
    V3f sun_direction(std::size_t sun, float c, float d) const;
    const Imath::Box3f& scene_box() const { return boxes_.front(); }
    /// The scene's box is 0, targets follow.
    std::size_t box_count() const { return boxes_.size(); }
    std::size_t box(std::size_t part) const { return emitters_[part / parts_per_emitter].box; }

    /// A part of light from outside that shoots along a line.
    struct PartAlong {
        std::size_t part;
        double brightness;  ///< Sum of the channels: radiance of a sky, or irradiance of a surface that faces the sun.
    };
    /// @param light  Any point of the line, and the direction of the light. @param sun  Its number; none: parts of skies.
    std::vector<PartAlong> parts_along(const Ray& light, std::uint32_t sun) const;

    /// Makes the rays of samples first_sample, first_sample + 1, ... of a part; all carry the same power.
    /// @param key     Names the part's point sequence (fill_points).
    /// @param points  Working space.
    /// @param rays    Receives the rays; its size is their number.
    void shoot(std::size_t part, PointSet set, std::uint64_t key, std::uint64_t first_sample, PointBlock& points,
               std::span<Ray> rays) const;

    /// What stands for a part near one of its rays, for estimates of what others receive of it.
    struct Proxy {
        V3f position{0, 0, 0};  ///< [m]
        V3f normal{0, 0, 0};    ///< It emits in proportion to the cosine with that; 0: alike in all directions.
        Rgb intensity{0, 0,
                      0};  ///< Along the normal: what it causes at a distance d is intensity / d^2 [lm/sr or W/sr].
    };
    /// @param distance  That the ray has gone to where it arrives [m].
    Proxy proxy(std::size_t part, const Ray& ray, float distance) const;

  private:
    /// Into the cone around `axis` from cosine 1 to `outer`.
    struct Beam {
        V3f position, axis, s, t;
        float inner, outer;  // cosines
        float inner_share;   // of the power, within the inner angle
        Ray ray(float u, float v, float, float) const;
    };
    /// Starts on a parallelogram, with a density in proportion to cos(theta) about a direction, up to an angle.
    struct Window {
        V3f corner, edge_u, edge_v;
        V3f direction, s, t;
        float sine;       // of that angle; 0: parallel; 1: diffuse
        float part_area;  // on the scene's box, which the oracle sees also for targets
        bool is_sky() const { return sine == 1; }
        Ray ray(float u, float v, float c, float d) const;
    };
    /// Starts on a side of the scene's box, from the directions of a sky.
    struct SkySide {
        V3f corner, edge_u, edge_v, normal;
        std::shared_ptr<const SkyRadiance> sky;
        std::shared_ptr<const DirectionTable> places;
        SkyComponent component;
        float part_area;  // as a window's
        Ray ray(float u, float v, float c, float d) const;
    };
    /// In the directions of a photometric web, from its opening; from `offset` above it, where a surface is that it is
    /// set in.
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
    std::vector<std::size_t> suns_;                   // emitters, of the scene's box
    std::vector<std::vector<std::size_t>> of_boxes_;  // emitters of each box
    std::vector<Emitter> emitters_;
    std::map<const PhotometricWeb*, std::shared_ptr<const WebSampler>> samplers_;
};

}  // namespace interflect::inline detail
