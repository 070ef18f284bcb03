#include "interflect/render/lights/unoccluded_light.h"

#include <ImathBox.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <variant>

#include "interflect/luminaires/illumination.h"

namespace interflect::detail {

namespace {

/// With more sources of a kind, the sum over them would take longer than tracing the shadow rays. Patches take less
/// time than luminaires.
constexpr std::size_t max_patches = 256, max_luminaires = 64;

/// Returns acos(x) / sqrt(1 - x^2) for x in [0, 1], within 2e-8 of acos (Abramowitz and Stegun 1964, 4.4.46). Unlike
/// the quotient it is well conditioned for small angles.
float angle_over_sine(float x) {
    float p = -0.0012624911f;
    for (const float coefficient :
         {0.0066700901f, -0.0170881256f, 0.0308918810f, -0.0501743046f, 0.0889789874f, -0.2145988016f, 1.5707963050f})
        p = p * x + coefficient;
    return p / std::sqrt(1 + x);
}

/// Returns one edge's term of Lambert's formula: the angle between the unit vectors a and b, times the component along
/// n of the unit normal of their plane.
float edge_integral(const V3f& a, const V3f& b, const V3f& n) {
    const V3f normal = a.cross(b);
    const float cosine = a.dot(b);
    if (cosine >= 0) return n.dot(normal) * angle_over_sine(std::min(1.0f, cosine));
    const float sine = normal.length();
    return sine > 0 ? std::atan2(sine, cosine) * (n.dot(normal) / sine) : 0;
}

/// Returns the number of sampled points per axis of a luminaire; 1 if its centre gives the exact irradiance.
int strata(const Luminaire& luminaire, const V3f& n) {
    constexpr int strata_of_extended = 4;
    if (const auto* measured = std::get_if<MeasuredLight>(&luminaire.kind))
        return measured->web->opening.is_point() ? 1 : strata_of_extended;
    const auto* sun = std::get_if<DirectionalLight>(&luminaire.kind);
    if (!sun || sun->diameter == 0) return 1;
    const float height = -n.dot(sun->direction.normalized());
    return std::abs(height) > sun->disc_sine() ? 1 : strata_of_extended;
}

Rgb by_luminaire(const Luminaire& luminaire, const V3f& x, const V3f& n, float u, float v) {
    const int across = strata(luminaire, n);
    // The irradiance of a disc that is completely above the horizon is that of its centre.
    const auto* sun = std::get_if<DirectionalLight>(&luminaire.kind);
    if (sun && across == 1) return sun->irradiance * std::max(0.0f, -n.dot(sun->direction.normalized()));
    Rgb irradiance(0);
    for (int row = 0; row < across; ++row)
        for (int column = 0; column < across; ++column) {
            const float s = (static_cast<float>(column) + u) / static_cast<float>(across),
                        t = (static_cast<float>(row) + v) / static_cast<float>(across);
            const Illumination light = illumination(luminaire, x, s, t);
            irradiance += light.irradiance * std::max(0.0f, n.dot(light.towards));
        }
    return irradiance / static_cast<float>(across * across);
}

std::size_t index(SourceKind kind) { return static_cast<std::size_t>(kind); }

/// Returns the position of a lamp, or the unit direction towards a sun.
V3f place_of(const Luminaire& luminaire) {
    return std::visit(
        [](const auto& light) {
            if constexpr (requires { light.position; })
                return V3f(light.position);
            else if constexpr (requires { light.direction; })
                return V3f(-light.direction.normalized());
            else
                return V3f(0);  // skies
        },
        luminaire.kind);
}

/// Whether by_luminaire() has no noise.
bool has_exact_light(const Luminaire& luminaire) {
    const auto* sun = std::get_if<DirectionalLight>(&luminaire.kind);
    return sun ? sun->diameter == 0 : strata(luminaire, V3f(0, 0, 1)) == 1;
}

Imath::Box3f bounds_of_places(std::span<const UnoccludedLight::Source> sources) {
    Imath::Box3f box;
    for (const auto& source : sources) box.extendBy(source.place);
    return box;
}

float diagonal(std::span<const UnoccludedLight::Source> sources) { return bounds_of_places(sources).size().length(); }

/// Divides sources into at most `max_groups` groups, each of consecutive ones: repeatedly halves the group with the
/// longest diagonal.
std::vector<std::span<UnoccludedLight::Source>> near_groups(std::span<UnoccludedLight::Source> sources,
                                                            std::size_t max_groups) {
    using Source = UnoccludedLight::Source;
    if (sources.empty()) return {};
    std::vector<std::span<Source>> groups{sources};
    while (groups.size() < max_groups) {
        const auto largest = std::max_element(groups.begin(), groups.end(),
                                              [](const auto& a, const auto& b) { return diagonal(a) < diagonal(b); });
        const std::span<Source> group = *largest;
        const Imath::Box3f box = bounds_of_places(group);
        if (!(box.size().length() > 0)) break;
        const auto axis = static_cast<int>(box.majorAxis());
        const std::size_t half = group.size() / 2;
        std::nth_element(group.begin(), group.begin() + static_cast<std::ptrdiff_t>(half), group.end(),
                         [axis](const Source& a, const Source& b) {
                             return std::pair(a.place[axis], a.index) < std::pair(b.place[axis], b.index);
                         });
        *largest = group.first(half);
        groups.insert(largest + 1, group.subspan(half));
    }
    return groups;
}

}  // namespace

float polygon_irradiance(std::span<const V3f> vertices, const V3f& x, const V3f& n) {
    std::array<V3f, 5> above;  // clipping adds at most one corner
    std::size_t count = 0;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const V3f a = vertices[i] - x, b = vertices[(i + 1) % vertices.size()] - x;
        const float height = n.dot(a), next = n.dot(b);
        if (height > 0) above[count++] = a;
        if ((height > 0) != (next > 0)) above[count++] = a + (b - a) * (height / (height - next));
    }
    for (std::size_t i = 0; i < count; ++i) above[i].normalize();
    float sum = 0;
    for (std::size_t i = 0; i < count; ++i) sum += edge_integral(above[i], above[(i + 1) % count], n);
    return std::abs(sum) / 2;
}

void UnoccludedLight::PatchPack::add(const Scene& scene, PatchIndex patch) {
    const Patch& p = scene.patches[patch];
    for (std::size_t c = 0; c < x.size(); ++c) {
        const std::size_t last = static_cast<std::size_t>(p.vertex_count()) - 1;
        const V3f& vertex = scene.vertices[p.vertices[std::min(c, last)]];
        x[c][count] = vertex.x;
        y[c][count] = vertex.y;
        z[c][count] = vertex.z;
    }
    patches[count++] = patch;
}

/// Evaluates Lambert's formula as polygon_irradiance() does, for eight patches at once and without clipping.
UnoccludedLight::PatchPack::Irradiance UnoccludedLight::PatchPack::at(const V3f& p, const V3f& n) const {
    constexpr float least_cosine = -0.9f;     // between corners; rounding dominates beyond this angle
    std::array<Numbers, 4> to_x, to_y, to_z;  // unit vectors to the corners
    Irradiance found;
    found.is_exact.fill(1);
    for (std::size_t c = 0; c < x.size(); ++c)
        for (std::size_t i = 0; i < size; ++i) {
            const float dx = x[c][i] - p.x, dy = y[c][i] - p.y, dz = z[c][i] - p.z;
            found.is_exact[i] &= n.x * dx + n.y * dy + n.z * dz > 0;
            const float scale = 1 / std::sqrt(dx * dx + dy * dy + dz * dz);
            to_x[c][i] = dx * scale;
            to_y[c][i] = dy * scale;
            to_z[c][i] = dz * scale;
        }
    Numbers sum{};
    for (std::size_t c = 0; c < x.size(); ++c) {
        const Numbers &ax = to_x[c], &ay = to_y[c], &az = to_z[c];
        const std::size_t next = (c + 1) % x.size();
        const Numbers &bx = to_x[next], &by = to_y[next], &bz = to_z[next];
        for (std::size_t i = 0; i < size; ++i) {
            const float cosine = ax[i] * bx[i] + ay[i] * by[i] + az[i] * bz[i], a = std::min(1.0f, std::abs(cosine));
            const float height = n.x * (ay[i] * bz[i] - az[i] * by[i]) + n.y * (az[i] * bx[i] - ax[i] * bz[i]) +
                                 n.z * (ax[i] * by[i] - ay[i] * bx[i]);
            const float acute = angle_over_sine(a),
                        obtuse = std::numbers::pi_v<float> / std::sqrt((1 - a) * (1 + a)) - acute;
            found.is_exact[i] &= cosine > least_cosine;
            sum[i] += height * (cosine >= 0 ? acute : obtuse);
        }
    }
    for (std::size_t i = 0; i < size; ++i) found.of_unit_radiance[i] = std::abs(sum[i]) / 2;
    return found;
}

UnoccludedLight::UnoccludedLight(const Scene& scene, std::span<const PatchGeometry> geometry)
    : scene_(scene),
      geometry_(geometry),
      group_of_patch_(scene.patches.size(), none),
      group_of_luminaire_(scene.luminaires.size(), none) {
    std::array<std::vector<Source>, source_kinds.size()> sources;
    bool has_texture = false;
    for (PatchIndex i{0}; i < scene.patches.size(); ++i) {
        const Material& material = scene.materials[scene.patches[i].material];
        if (!(channel_sum(material.exitance) > 0)) continue;
        sources[index(SourceKind::patches)].push_back({i, geometry[i].centre()});
        has_texture = has_texture || material.exitance_texture != none;
    }
    for (std::uint32_t i = 0; i < scene.luminaires.size(); ++i) {
        if (is_sky(scene.luminaires[i])) continue;
        const bool is_sun = std::holds_alternative<DirectionalLight>(scene.luminaires[i].kind);
        sources[index(is_sun ? SourceKind::suns : SourceKind::lamps)].push_back({i, place_of(scene.luminaires[i])});
    }
    for (const SourceKind kind : source_kinds) {
        const std::size_t k = index(kind);
        const bool is_patches = kind == SourceKind::patches;
        is_available_[k] =
            sources[k].size() <= (is_patches ? max_patches : max_luminaires) && !(is_patches && has_texture);
        groups_by_kind_[k].first = group_count();
        if (is_available_[k]) add_groups(kind, sources[k]);
        groups_by_kind_[k].second = group_count();
    }
}

void UnoccludedLight::add_groups(SourceKind kind, std::span<Source> sources) {
    for (const std::span<Source> group : near_groups(sources, max_groups_of_kind)) {
        const auto number = static_cast<std::uint32_t>(group_count());
        is_exact_.push_back(1);
        for (const Source& source : group)
            if (kind == SourceKind::patches) {
                group_of_patch_[source.index] = number;
                if (patch_packs_.empty() || patch_packs_.back().count == PatchPack::size) patch_packs_.emplace_back();
                patch_packs_.back().add(scene_, PatchIndex(source.index));
            } else {
                group_of_luminaire_[source.index] = number;
                luminaires_.push_back(source.index);
                is_exact_.back() &= has_exact_light(scene_.luminaires[source.index]);
            }
    }
}

void UnoccludedLight::add(const V3f& x, const V3f& n, float u, float v, std::span<const std::uint8_t> is_needed,
                          std::span<Rgb> by_group) const {
    for (const PatchPack& pack : patch_packs_) {
        const auto patches = std::span(pack.patches).first(pack.count);
        const auto is_used = [&](PatchIndex patch) { return is_needed[group_of_patch_[patch]] != 0; };
        if (std::none_of(patches.begin(), patches.end(), is_used)) continue;
        const PatchPack::Irradiance found = pack.at(x, n);
        for (std::size_t i = 0; i < pack.count; ++i) {
            const PatchIndex patch = pack.patches[i];
            const PatchGeometry& geometry = geometry_[patch];
            if (geometry.normal().dot(x - geometry.shape().origin) <= 0) continue;
            const float of_unit_radiance = found.is_exact[i] ? found.of_unit_radiance[i] : by_patch(patch, x, n);
            by_group[group_of_patch_[patch]] += scene_.materials[scene_.patches[patch].material].exitance *
                                                (of_unit_radiance / std::numbers::pi_v<float>);
        }
    }
    for (const std::uint32_t i : luminaires_)
        if (const std::uint32_t group = group_of_luminaire_[i]; is_needed[group] != 0)
            by_group[group] += by_luminaire(scene_.luminaires[i], x, n, u, v);
}

float UnoccludedLight::by_patch(PatchIndex patch, const V3f& x, const V3f& n) const {
    std::array<V3f, 4> vertices;
    const auto count = static_cast<std::size_t>(scene_.patches[patch].vertex_count());
    for (std::size_t k = 0; k < count; ++k) vertices[k] = scene_.vertices[scene_.patches[patch].vertices[k]];
    return polygon_irradiance(std::span(vertices).first(count), x, n);
}

}  // namespace interflect::detail
