#include "interflect/luminaires/emission.h"

#include <ImathBox.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "interflect/base/points.h"
#include "interflect/geometry/tangent_frame.h"

namespace interflect::inline detail {

namespace {

constexpr float pi = std::numbers::pi_v<float>;

/// The box around all patches, a little larger than it must be: rays that start on it are outside.
Imath::Box3f box_around(const Scene& scene) {
    constexpr float margin = 1e-3f;  // of its diagonal
    Imath::Box3f box;
    for (const Patch& patch : scene.patches)
        for (int k = 0; k < patch.vertex_count(); ++k)
            box.extendBy(scene.vertices[patch.vertices[static_cast<std::size_t>(k)]]);
    const V3f around(margin * box.size().length());
    box.min -= around, box.max += around;
    return box;
}

/// Cosine of the angle of a ray of a beam to its axis, for v in (0, 1]: the inner part is uniform in solid angle;
/// beyond it intensity is in proportion to (c - outer)^2.
float sample_cosine(float v, float inner, float outer, float inner_share) {
    if (v <= inner_share) return 1 - (1 - inner) * (v / inner_share);
    return outer + (inner - outer) * std::cbrt((1 - v) / (1 - inner_share));
}

/// A direction at an angle to an axis, turned about it by `turn` of a full turn.
V3f turned(const V3f& axis, const V3f& s, const V3f& t, float cosine, float sine, float turn) {
    const float angle = 2 * pi * turn;
    return s * (sine * std::cos(angle)) + t * (sine * std::sin(angle)) + axis * cosine;
}

/// A side of the scene's box.
struct BoxSide {
    V3f corner, edge_u, edge_v, normal;  // the normal points inwards
};

std::array<BoxSide, 6> sides_of(const V3f& low, const V3f& size) {
    std::array<BoxSide, 6> sides;
    for (int axis = 0; axis < 3; ++axis) {
        V3f edge_u(0), edge_v(0), normal(0), across(0);
        edge_u[(axis + 1) % 3] = size[(axis + 1) % 3];
        edge_v[(axis + 2) % 3] = size[(axis + 2) % 3];
        normal[axis] = 1, across[axis] = size[axis];
        const std::size_t first = 2 * static_cast<std::size_t>(axis);
        sides[first] = {low, edge_u, edge_v, normal};
        sides[first + 1] = {low + across, edge_u, edge_v, -normal};
    }
    return sides;
}

/// What all channels have, and what each has beyond that.
float least_channel(const Rgb& c) { return std::min({c.x, c.y, c.z}); }
constexpr std::array<SkyComponent, 4> map_components = {
    {{Rgb(1, 1, 1), least_channel},
     {Rgb(1, 0, 0), [](const Rgb& c) { return c.x - least_channel(c); }},
     {Rgb(0, 1, 0), [](const Rgb& c) { return c.y - least_channel(c); }},
     {Rgb(0, 0, 1), [](const Rgb& c) { return c.z - least_channel(c); }}}};

/// What is sampled of a sky on a side of the box: the amount of a component, times the cosine in the middle of cells.
DirectionTable table_for(const SkyGrid& grid, const SkyFrame& frame, std::span<const Rgb> integrals,
                         const SkyComponent& component, const V3f& normal) {
    std::vector<float> of_horizon(grid.columns);  // cosines there
    for (std::size_t column = 0; column < grid.columns; ++column)
        of_horizon[column] = -normal.dot(frame.direction({grid.middle(column, 0).s, 0}));
    const float of_zenith = -normal.dot(frame.zenith);
    std::vector<float> weights(grid.size());
    for (std::size_t row = 0; row < grid.rows; ++row) {
        const float up = grid.middle(0, row).cosine, aside = std::sqrt(1 - up * up);
        for (std::size_t column = 0; column < grid.columns; ++column) {
            const std::size_t cell = row * grid.columns + column;
            const float cosine = up * of_zenith + aside * of_horizon[column];
            weights[cell] = component.amount(integrals[cell]) * std::max(0.0f, cosine);
        }
    }
    return {grid, weights};
}

}  // namespace

Emission::Emission(const Scene& scene) {
    if (scene.luminaires.empty() || scene.patches.empty()) return;
    const Imath::Box3f box = box_around(scene);
    for (const float x : {box.min.x, box.max.x})
        for (const float y : {box.min.y, box.max.y})
            for (const float z : {box.min.z, box.max.z}) corners_.emplace_back(x, y, z);
    for (std::size_t i = 0; i < scene.luminaires.size(); ++i) {
        const std::size_t first = emitters_.size();
        std::visit([&](const auto& light) { add(light); }, scene.luminaires[i].kind);
        for (std::size_t e = first; e < emitters_.size(); ++e) emitters_[e].luminaire = i;
    }
}

RgbD Emission::total_power() const {
    RgbD sum(0, 0, 0);
    for (const Emitter& e : emitters_) sum += e.part_power * static_cast<double>(parts_per_emitter);
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

/// Starts on the rectangle that the scene's box fills as seen along the light, widened so that slanted rays from a disc
/// reach all of the box too.
void Emission::add(const DirectionalLight& light) {
    const V3f direction = light.direction.normalized();
    const TangentFrame frame(direction);
    V3f low(std::numeric_limits<float>::max()), high(-low);
    for (const V3f& corner : corners_) {
        const V3f p(corner.dot(frame.s), corner.dot(frame.t), corner.dot(direction));
        for (int k = 0; k < 3; ++k) low[k] = std::min(low[k], p[k]), high[k] = std::max(high[k], p[k]);
    }
    const float sine = light.disc_sine(), margin = (high.z - low.z) * sine / std::sqrt(1 - sine * sine);
    for (int k = 0; k < 2; ++k) low[k] -= margin, high[k] += margin;
    const V3f corner = frame.s * low.x + frame.t * low.y + direction * low.z;
    add_window({corner, frame.s * (high.x - low.x), frame.t * (high.y - low.y), direction, frame.s, frame.t, sine, 0},
               light.irradiance);
}

/// Within a convex surface that emits diffusely everywhere, radiance is the same in all directions: here the six sides
/// of the scene's box, which nothing is ever hit by.
void Emission::add(const UniformSky& sky) {
    for (const BoxSide& side : sides_of(corners_.front(), corners_.back() - corners_.front())) {
        const TangentFrame frame(side.normal);
        add_window({side.corner, side.edge_u, side.edge_v, side.normal, frame.s, frame.t, 1, 0}, sky.radiance * pi);
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

/// As for a uniform sky, but with directions in proportion to radiance times cosine.
void Emission::add_sky(const std::shared_ptr<const SkyRadiance>& sky, const SkyGrid& grid,
                       std::span<const SkyComponent> components) {
    const std::vector<Rgb> integrals = sky->cell_integrals(grid);
    for (const BoxSide& side : sides_of(corners_.front(), corners_.back() - corners_.front()))
        for (const SkyComponent& component : components) {
            auto places =
                std::make_shared<DirectionTable>(table_for(grid, sky->frame(), integrals, component, side.normal));
            if (!(places->sum() > 0)) continue;
            const float part_area = side.edge_u.length() * side.edge_v.length() / float{parts_per_emitter};
            const RgbD power = RgbD(component.colour) * (places->sum() * double{part_area});
            emitters_.push_back({SkySide{side.corner, side.edge_u, side.edge_v, side.normal, sky, std::move(places),
                                         component, part_area},
                                 component.colour, power});
        }
}

void Emission::add_window(Window window, const Rgb& exitance) {
    window.part_area = window.edge_u.length() * window.edge_v.length() / float{parts_per_emitter};
    emitters_.push_back({window, exitance, RgbD(exitance) * double{window.part_area}});
}

/// All rays of a web's sampler carry the same power, whatever the web.
void Emission::add(const MeasuredLight& light) {
    std::shared_ptr<const WebSampler>& sampler = samplers_[light.web.get()];
    if (!sampler) sampler = std::make_shared<WebSampler>(*light.web);
    float reach = 0;  // largest coordinate
    for (const V3f& corner : {corners_.front(), corners_.back()})
        for (int k = 0; k < 3; ++k) reach = std::max(reach, std::abs(corner[k]));
    constexpr float relative_offset = 0x1p-17f;  // as RayCaster::ray_offset()
    emitters_.push_back({Web{sampler, light.web, LuminaireFrame(light), light.position, relative_offset * reach},
                         light.factor, RgbD(light.factor) * (sampler->flux() / double{parts_per_emitter})});
}

Ray Emission::Beam::ray(float u, float v, float, float) const {
    const float cosine = sample_cosine(v, inner, outer, inner_share);
    return {position, turned(axis, s, t, cosine, std::sqrt(std::max(0.0f, 1 - cosine * cosine)), u)};
}

Ray Emission::Window::ray(float u, float v, float c, float d) const {
    const float squared = c * sine * sine;
    return {corner + edge_u * u + edge_v * v, turned(direction, s, t, std::sqrt(1 - squared), std::sqrt(squared), d)};
}

/// Cells that a side's plane divides reach behind it: what is sampled there is mirrored.
Ray Emission::SkySide::ray(float u, float v, float c, float d) const {
    V3f direction = -sky->frame().direction(places->sample(c, d));
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
    }
}

Emission::Proxy Emission::proxy(std::size_t part, const Ray& ray, float distance) const {
    const Emitter& emitter = emitters_[part / parts_per_emitter];
    const float squared = std::max(distance * distance, std::numeric_limits<float>::min());
    if (std::holds_alternative<Beam>(emitter.shape)) return {ray.origin, V3f(0), emitter.rating};
    if (const Web* web = std::get_if<Web>(&emitter.shape))
        return {ray.origin, V3f(0), emitter.rating * web->light->intensity(web->frame.to_luminaire(ray.direction))};
    const auto of_side = [&](const V3f& normal, float part_area, const Rgb& exitance) {
        const float form_factor = part_area / (part_area + pi * squared);  // of a disk of that area
        return Proxy{ray.origin, normal, exitance * (form_factor * squared)};
    };
    if (const SkySide* side = std::get_if<SkySide>(&emitter.shape))
        return of_side(side->normal, side->part_area,
                       emitter.rating * (pi * side->component.amount(side->sky->towards(-ray.direction))));
    const Window& window = std::get<Window>(emitter.shape);
    if (window.sine == 1) return of_side(window.direction, window.part_area, emitter.rating);
    // So far away that direction and distance are the same for the whole scene.
    const float far = 100 * (corners_.back() - corners_.front()).length();
    return {ray.origin - far * ray.direction, window.direction, emitter.rating * (far * far)};
}

}  // namespace interflect::inline detail
