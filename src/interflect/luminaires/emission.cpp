#include "interflect/luminaires/emission.h"

#include <ImathBox.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "interflect/base/numbers/points.h"
#include "interflect/geometry/textures/tangent_frame.h"

namespace interflect::detail {

namespace {

constexpr float pi = std::numbers::pi_v<float>;

/// Returns the scene's bounding box with a margin, which keeps origins of rays outside the scene.
Imath::Box3f box_around(const Scene& scene) {
    constexpr float margin = 1e-3f;  // relative to the diagonal
    Imath::Box3f box;
    for (const Patch& patch : scene.patches)
        for (int k = 0; k < patch.vertex_count(); ++k)
            box.extendBy(scene.vertices[patch.vertices[static_cast<std::size_t>(k)]]);
    const V3f around(margin * box.size().length());
    box.min -= around;
    box.max += around;
    return box;
}

/// Samples the cosine to a beam's axis, v in (0, 1]. Intensity is constant within `inner`, then proportional to (cosine
/// - outer)^2.
float sample_cosine(float v, float inner, float outer, float inner_share) {
    if (v <= inner_share) return 1 - (1 - inner) * (v / inner_share);
    return outer + (inner - outer) * std::cbrt((1 - v) / (1 - inner_share));
}

/// Returns a direction at an angle to an axis. @param turn  Azimuth from s towards t, in full turns.
V3f turned(const V3f& axis, const V3f& s, const V3f& t, float cosine, float sine, float turn) {
    const float angle = 2 * pi * turn;
    return s * (sine * std::cos(angle)) + t * (sine * std::sin(angle)) + axis * cosine;
}

struct BoxSide {
    V3f corner, edge_u, edge_v, normal;
};

std::array<BoxSide, 6> sides_of(const V3f& low, const V3f& size) {
    std::array<BoxSide, 6> sides;
    for (int axis = 0; axis < 3; ++axis) {
        V3f edge_u(0), edge_v(0), normal(0), across(0);
        edge_u[(axis + 1) % 3] = size[(axis + 1) % 3];
        edge_v[(axis + 2) % 3] = size[(axis + 2) % 3];
        normal[axis] = 1;
        across[axis] = size[axis];
        const std::size_t first = 2 * static_cast<std::size_t>(axis);
        sides[first] = {low, edge_u, edge_v, normal};
        sides[first + 1] = {low + across, edge_u, edge_v, -normal};
    }
    return sides;
}

float min_channel(const Rgb& c) { return std::min({c.x, c.y, c.z}); }
/// Grey part of a map (least channel), and the excess of each channel over it.
constexpr std::array<SkyComponent, 4> map_components = {
    {{Rgb(1, 1, 1), min_channel},
     {Rgb(1, 0, 0), [](const Rgb& c) { return c.x - min_channel(c); }},
     {Rgb(0, 1, 0), [](const Rgb& c) { return c.y - min_channel(c); }},
     {Rgb(0, 0, 1), [](const Rgb& c) { return c.z - min_channel(c); }}}};

/// Returns a table that samples directions by a component's amount times the cosine to a side's normal.
DirectionTable table_for(const SkyGrid& grid, const SkyFrame& frame, std::span<const Rgb> integrals,
                         const SkyComponent& component, const V3f& normal) {
    std::vector<float> cosine_at_horizon(grid.columns);
    for (std::size_t column = 0; column < grid.columns; ++column)
        cosine_at_horizon[column] = -normal.dot(frame.direction({grid.middle(column, 0).s, 0}));
    const float cosine_at_zenith = -normal.dot(frame.zenith);
    std::vector<float> weights(grid.size());
    for (std::size_t row = 0; row < grid.rows; ++row) {
        const float up = grid.middle(0, row).cosine, aside = std::sqrt(1 - up * up);
        for (std::size_t column = 0; column < grid.columns; ++column) {
            const std::size_t cell = row * grid.columns + column;
            const float cosine = up * cosine_at_zenith + aside * cosine_at_horizon[column];
            weights[cell] = component.amount(integrals[cell]) * std::max(0.0f, cosine);
        }
    }
    return {grid, weights};
}

/// Interval of a ray's line within a box, as distances from the ray's origin [m].
struct Crossing {
    float begin, end;  // begin > end: missed
};
Crossing crossing(const Imath::Box3f& box, const Ray& ray) {
    Crossing within{-std::numeric_limits<float>::infinity(), std::numeric_limits<float>::infinity()};
    for (int k = 0; k < 3; ++k) {
        if (ray.direction[k] == 0) {
            if (ray.origin[k] < box.min[k] || ray.origin[k] > box.max[k]) return {1, 0};
            continue;
        }
        const float a = (box.min[k] - ray.origin[k]) / ray.direction[k],
                    b = (box.max[k] - ray.origin[k]) / ray.direction[k];
        within.begin = std::max(within.begin, std::min(a, b));
        within.end = std::min(within.end, std::max(a, b));
    }
    return within;
}

}  // namespace

bool line_crosses(const Imath::Box3f& box, const Ray& ray) {
    const Crossing within = crossing(box, ray);
    return within.begin <= within.end;
}

Emission::Emission(const Scene& scene, std::span<const Imath::Box3f> targets) {
    if (scene.luminaires.empty() || scene.patches.empty()) return;
    boxes_.push_back(box_around(scene));
    boxes_.insert(boxes_.end(), targets.begin(), targets.end());
    for (std::size_t i = 0; i < scene.luminaires.size(); ++i) {
        const std::size_t first = emitters_.size();
        std::visit([&](const auto& light) { add(light); }, scene.luminaires[i].kind);
        for (std::size_t e = first; e < emitters_.size(); ++e) emitters_[e].luminaire = i;
    }
    emitters_of_boxes_.resize(boxes_.size());
    for (std::size_t e = 0; e < emitters_.size(); ++e) emitters_of_boxes_[emitters_[e].box].push_back(e);
}

RgbD Emission::power_of_boxes(std::size_t begin, std::size_t end) const {
    RgbD sum(0, 0, 0);
    for (const Emitter& e : emitters_)
        if (e.box >= begin && e.box < end) sum += e.part_power * static_cast<double>(parts_per_emitter);
    return sum;
}

void Emission::add(const PointLight& light) {
    add_beam({light.position, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, -1, -1, 1}, light.intensity);
}

void Emission::add(const SpotLight& light) {
    const V3f axis = light.direction.normalized();
    const TangentFrame frame(axis);
    const float inner = light.inner_cosine(), outer = light.outer_cosine();
    const float within = 1 - inner, beyond = (inner - outer) / 3;
    add_beam({light.position, axis, frame.s, frame.t, inner, outer, within / (within + beyond)}, light.intensity);
}

void Emission::add_beam(const Beam& beam, const Rgb& intensity) {
    const double solid_angle = 2 * std::numbers::pi * ((1.0 - beam.inner) + (double{beam.inner} - beam.outer) / 3);
    emitters_.push_back({beam, intensity, RgbD(intensity) * (solid_angle / double{parts_per_emitter})});
}

/// The emitter of a box is its bounding rectangle across the light, enlarged for the rays of a disc.
void Emission::add(const DirectionalLight& light) {
    const V3f direction = light.direction.normalized();
    const TangentFrame frame(direction);
    suns_.push_back(emitters_.size());
    for (std::size_t b = 0; b < boxes_.size(); ++b) {
        V3f low(std::numeric_limits<float>::max()), high(-low);
        for (const float x : {boxes_[b].min.x, boxes_[b].max.x})
            for (const float y : {boxes_[b].min.y, boxes_[b].max.y})
                for (const float z : {boxes_[b].min.z, boxes_[b].max.z}) {
                    const V3f corner(x, y, z), p(corner.dot(frame.s), corner.dot(frame.t), corner.dot(direction));
                    for (int k = 0; k < 3; ++k) {
                        low[k] = std::min(low[k], p[k]);
                        high[k] = std::max(high[k], p[k]);
                    }
                }
        const float sine = light.disc_sine(), margin = (high.z - low.z) * sine / std::sqrt(1 - sine * sine);
        for (int k = 0; k < 2; ++k) {
            low[k] -= margin;
            high[k] += margin;
        }
        const V3f corner = frame.s * low.x + frame.t * low.y + direction * low.z;
        add_rectangle(
            {corner, frame.s * (high.x - low.x), frame.t * (high.y - low.y), direction, frame.s, frame.t, sine, 0},
            light.irradiance, b);
    }
}

/// Diffuse emission by a convex surface, here a box, has equal radiance in all directions inside.
void Emission::add(const UniformSky& sky) {
    for (std::size_t b = 0; b < boxes_.size(); ++b)
        for (const BoxSide& side : sides_of(boxes_[b].min, boxes_[b].size())) {
            const TangentFrame frame(side.normal);
            add_rectangle({side.corner, side.edge_u, side.edge_v, side.normal, frame.s, frame.t, 1, 0},
                          sky.radiance * pi, b);
        }
}

void Emission::add(const SkyDome& dome) {
    const auto sky = std::make_shared<SkyRadiance>(dome);
    const float largest = largest_channel(dome.irradiance);
    if (!(largest > 0)) return;
    const SkyComponent all{dome.irradiance / largest, largest_channel};
    add_sky(sky, sky->grid(), {&all, 1});
}

void Emission::add(const EnvironmentMap& map) {
    constexpr SkyGrid finest{1024, 512};  // cells of 0.35 degrees
    add_sky(std::make_shared<SkyRadiance>(map), finest, map_components);
}

/// All boxes share one table of radiance times cosine per side and component.
void Emission::add_sky(const std::shared_ptr<const SkyRadiance>& sky, const SkyGrid& grid,
                       std::span<const SkyComponent> components) {
    const std::vector<Rgb> integrals = sky->cell_integrals(grid);
    for (std::size_t s = 0; s < 6; ++s)
        for (const SkyComponent& component : components) {
            const auto side_of = [&](const Imath::Box3f& box) { return sides_of(box.min, box.size())[s]; };
            const auto part_area = [](const BoxSide& side) {
                return side.edge_u.length() * side.edge_v.length() / float{parts_per_emitter};
            };
            const BoxSide outer = side_of(boxes_.front());
            const auto directions =
                std::make_shared<DirectionTable>(table_for(grid, sky->frame(), integrals, component, outer.normal));
            if (!(directions->sum() > 0)) continue;
            for (std::size_t b = 0; b < boxes_.size(); ++b) {
                const BoxSide side = side_of(boxes_[b]);
                const RgbD power = RgbD(component.colour) * (directions->sum() * double{part_area(side)});
                emitters_.push_back({SkySide{side.corner, side.edge_u, side.edge_v, side.normal, sky, directions,
                                             component, part_area(outer)},
                                     component.colour, power, b});
            }
        }
}

void Emission::add_rectangle(Rectangle rectangle, const Rgb& exitance, std::size_t box) {
    const float part_area = rectangle.edge_u.length() * rectangle.edge_v.length() / float{parts_per_emitter};
    const std::size_t outer = emitters_.size() - box * (rectangle.is_sky() ? 6 : 1);  // same side of the scene's box
    rectangle.part_area = box == 0 ? part_area : std::get<Rectangle>(emitters_[outer].shape).part_area;
    emitters_.push_back({rectangle, exitance, RgbD(exitance) * double{part_area}, box});
}

void Emission::add(const MeasuredLight& light) {
    std::shared_ptr<const WebSampler>& sampler = samplers_[light.web.get()];
    if (!sampler) sampler = std::make_shared<WebSampler>(*light.web);
    float reach = 0;
    for (const V3f& corner : {boxes_.front().min, boxes_.front().max})
        for (int k = 0; k < 3; ++k) reach = std::max(reach, std::abs(corner[k]));
    constexpr float relative_offset = 0x1p-17f;  // as RayCaster::ray_offset()
    emitters_.push_back({Web{sampler, light.web, LuminaireFrame(light), light.position, relative_offset * reach},
                         light.factor, RgbD(light.factor) * (sampler->flux() / double{parts_per_emitter})});
}

Ray Emission::Beam::ray(float u, float v, float, float) const {
    const float cosine = sample_cosine(v, inner, outer, inner_share);
    return {position, turned(axis, s, t, cosine, std::sqrt(std::max(0.0f, 1 - cosine * cosine)), u)};
}

Ray Emission::Rectangle::ray(float u, float v, float c, float d) const {
    const float squared = c * sine * sine;
    return {corner + edge_u * u + edge_v * v, turned(direction, s, t, std::sqrt(1 - squared), std::sqrt(squared), d)};
}

/// Directions of cells that extend behind the side's plane are mirrored to the front.
Ray Emission::SkySide::ray(float u, float v, float c, float d) const {
    V3f direction = -sky->frame().direction(directions->sample(c, d));
    const float cosine = direction.dot(normal);
    if (cosine < 0) direction -= normal * (2 * cosine);
    return {corner + edge_u * u + edge_v * v, direction};
}

Ray Emission::Web::ray(float u, float v, float c, float d) const {
    const V3f from_luminaire = sampler->direction(u, v), towards = frame.to_scene(from_luminaire).normalized();
    const V3f start = sample_opening(light->opening, from_luminaire, c, d).position;
    return {position + frame.to_scene(start) + towards * offset, towards};
}

void Emission::shoot(std::size_t part, PointSet set, std::uint64_t key, std::uint64_t first_sample, PointBlock& points,
                     std::span<Ray> rays) const {
    const Emitter& emitter = emitters_[part / parts_per_emitter];
    const std::size_t cell = part % parts_per_emitter, cell_row = cell / cells_per_side;
    const auto column = static_cast<float>(cell % cells_per_side), row = static_cast<float>(cell_row);
    for (std::size_t begin = 0; begin < rays.size(); begin += PointBlock::capacity) {
        const std::size_t count = std::min(PointBlock::capacity, rays.size() - begin);
        fill_points(set, key, first_sample + begin, count, points);
        const auto& a = points.coordinate[0];
        const auto& b = points.coordinate[1];
        const auto& c = points.coordinate[2];
        const auto& d = points.coordinate[3];
        const auto shoot_from = [&](const auto& shape) {
            for (std::size_t i = 0; i < count; ++i)
                rays[begin + i] =
                    shape.ray((column + a[i]) / cells_per_side, (row + b[i]) / cells_per_side, c[i], d[i]);
        };
        std::visit(shoot_from, emitter.shape);
        const bool is_from_outside =
            std::holds_alternative<Rectangle>(emitter.shape) || std::holds_alternative<SkySide>(emitter.shape);
        if (boxes_.size() == 1 || !is_from_outside) continue;
        for (Ray& ray : rays.subspan(begin, count)) ray = restrict_to_box(ray, emitter.box);
    }
}

/// Returns a ray that misses the scene if the line misses the target `box` or crosses a later one. Else moves the
/// origin back to the scene's box.
Ray Emission::restrict_to_box(const Ray& ray, std::size_t box) const {
    const auto crosses = [&](const Imath::Box3f& other) { return line_crosses(other, ray); };
    const auto own = boxes_.begin() + static_cast<std::ptrdiff_t>(box);
    const bool is_rejected = (box > 0 && !crosses(*own)) || std::any_of(own + 1, boxes_.end(), crosses);
    if (is_rejected) return {boxes_.front().max + boxes_.front().size(), V3f(1, 1, 1).normalized()};
    if (box == 0) return ray;
    return {ray.origin + std::min(0.0f, crossing(boxes_.front(), ray).begin) * ray.direction, ray.direction};
}

bool Emission::has_sky() const {
    return std::any_of(emitters_.begin(), emitters_.end(), [](const Emitter& e) {
        const Rectangle* rectangle = std::get_if<Rectangle>(&e.shape);
        return std::holds_alternative<SkySide>(e.shape) || (rectangle && rectangle->is_sky());
    });
}

V3f Emission::sun_direction(std::size_t sun, float c, float d) const {
    return std::get<Rectangle>(emitters_[suns_[sun]].shape).ray(0, 0, c, d).direction;
}

std::vector<Emission::PartAlong> Emission::parts_along(const Ray& light, std::uint32_t sun) const {
    // The last box that the line crosses samples it.
    std::size_t box = boxes_.size() - 1;
    while (box > 0 && !line_crosses(boxes_[box], light)) --box;
    std::vector<PartAlong> parts;
    const auto add_crossed_part = [&](std::size_t e, const V3f& corner, const V3f& edge_u, const V3f& edge_v,
                                      const V3f& normal, double brightness) {
        const float cosine = light.direction.dot(normal);
        if (!(cosine > 0)) return;
        const V3f start = light.origin + light.direction * ((corner - light.origin).dot(normal) / cosine) - corner;
        const float u = start.dot(edge_u) / edge_u.length2(), v = start.dot(edge_v) / edge_v.length2();
        if (!(u >= 0 && u < 1 && v >= 0 && v < 1)) return;
        const auto cell = [](float x) { return static_cast<std::size_t>(x * float{cells_per_side}); };
        parts.push_back({e * parts_per_emitter + cell(v) * cells_per_side + cell(u), brightness});
    };
    for (const std::size_t e : emitters_of_boxes_[box]) {
        const Emitter& emitter = emitters_[e];
        if (const SkySide* side = std::get_if<SkySide>(&emitter.shape); side && sun == none) {
            const float amount = side->component.amount(side->sky->towards(-light.direction));
            add_crossed_part(e, side->corner, side->edge_u, side->edge_v, side->normal,
                             channel_sum(RgbD(emitter.rating)) * double{amount});
        }
        const Rectangle* rectangle = std::get_if<Rectangle>(&emitter.shape);
        if (!rectangle || rectangle->is_sky() != (sun == none)) continue;
        if (sun != none && emitter.luminaire != emitters_[suns_[sun]].luminaire) continue;
        add_crossed_part(e, rectangle->corner, rectangle->edge_u, rectangle->edge_v, rectangle->direction,
                         channel_sum(RgbD(emitter.rating)) / (sun == none ? std::numbers::pi : 1));
    }
    return parts;
}

Emission::Proxy Emission::proxy(std::size_t part, const Ray& ray, float distance) const {
    const Emitter& emitter = emitters_[part / parts_per_emitter];
    const float squared = std::max(distance * distance, std::numeric_limits<float>::min());
    if (std::holds_alternative<Beam>(emitter.shape)) return {ray.origin, V3f(0), emitter.rating};
    if (const Web* web = std::get_if<Web>(&emitter.shape))
        return {ray.origin, V3f(0), emitter.rating * web->light->intensity(web->frame.to_luminaire(ray.direction))};
    const auto of_side = [&](const V3f& normal, float part_area, const Rgb& exitance) {
        // The form factor of a disk of this area, seen from a point on its axis.
        const float form_factor = part_area / (part_area + pi * squared);
        return Proxy{ray.origin, normal, exitance * (form_factor * squared)};
    };
    if (const SkySide* side = std::get_if<SkySide>(&emitter.shape))
        return of_side(side->normal, side->part_area,
                       emitter.rating * (pi * side->component.amount(side->sky->towards(-ray.direction))));
    const Rectangle& rectangle = std::get<Rectangle>(emitter.shape);
    if (rectangle.is_sky()) return of_side(rectangle.direction, rectangle.part_area, emitter.rating);
    // From a distant proxy, direction and irradiance are nearly constant over the scene.
    const float far = 100 * boxes_.front().size().length();
    return {ray.origin - far * ray.direction, rectangle.direction, emitter.rating * (far * far)};
}

}  // namespace interflect::detail
