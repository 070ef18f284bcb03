#include "interflect/measure.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <span>
#include <tuple>
#include <utility>

#include "interflect/base/threads/parallel.h"
#include "interflect/core.h"
#include "interflect/geometry/textures/texture_mapping.h"
#include "interflect/luminaires/illumination.h"
#include "interflect/luminaires/opening.h"
#include "interflect/raycast/panes.h"
#include "interflect/render/rays/shadow_rays.h"

namespace interflect {

using namespace detail;

namespace {

constexpr double pi = std::numbers::pi;

/// Small part of a glare source, as seen from the observer.
struct SourceCell {
    V3f towards;
    float distance = 0;      // [m]
    PatchIndex patch;        // patch that the ray must hit; none: no hit up to `distance`
    Rgb radiance{0, 0, 0};   // [cd/m^2]
    double solid_angle = 0;  // [sr]
    double position_index = 1;
    std::size_t source = 0;
};

/// Sums over the visible cells of a glare source.
struct Sums {
    std::string name;
    bool is_rated = true;
    // Integrals of 1, L, L^2 and L^2 / p^2 over the solid angle.
    double solid_angle = 0, luminance = 0, squared = 0, glare = 0;

    void add(double l, double omega, double p) {
        solid_angle += omega;
        luminance += l * omega;
        squared += l * l * omega;
        glare += l * l * omega / (p * p);
    }
    GlareSource source() const {
        return {name, luminance / solid_angle, solid_angle, std::sqrt(squared / glare), glare, is_rated};
    }
};

class SourceCells {
  public:
    SourceCells(const Scene& scene, const Observer& observer)
        : scene_(scene), eye_(observer.eye - scene.origin), line_of_sight_(observer.line_of_sight.normalized()) {
        for (PatchIndex i{0}; i < scene.patches.size(); ++i)
            if (largest_channel(scene.materials[scene.patches[i].material].exitance) > 0) add_patch(i);
        for (const Luminaire& luminaire : scene.luminaires)
            if (const auto* light = std::get_if<MeasuredLight>(&luminaire.kind)) add_luminaire(luminaire, *light);
    }

    const V3f& eye() const { return eye_; }
    const std::vector<SourceCell>& cells() const { return cells_; }
    std::vector<Sums>& sums() { return sums_; }

  private:
    /// Divides an emitting patch into cells, each of which has a nearly constant direction.
    void add_patch(PatchIndex index) {
        constexpr float cells_per_distance = 8;
        constexpr int fewest = 2, most = 16;
        const Patch& patch = scene_.patches[index];
        const PatchGeometry geometry(scene_, patch);
        if (!((eye_ - geometry.centre()).dot(geometry.normal()) > 0)) return;
        const float width = std::sqrt(geometry.area()), distance = (eye_ - geometry.centre()).length();
        const int n = crosses_border_of_table(patch)
                          ? most
                          : static_cast<int>(std::clamp(std::ceil(cells_per_distance * width / distance),
                                                        static_cast<float>(fewest), static_cast<float>(most)));
        for (int i = 0; i < n * n; ++i) {
            const int row = i / n, column = i % n;
            const Parameters p =
                geometry.uniform_parameters((static_cast<float>(column) + 0.5f) / static_cast<float>(n),
                                            (static_cast<float>(row) + 0.5f) / static_cast<float>(n));
            const V3f d = geometry.point(p) - eye_;
            const float r = d.length();
            const double cosine = static_cast<double>(-geometry.normal().dot(d) / r);
            add({d / r, r, index, exitance_at(scene_, patch, p) / std::numbers::pi_v<float>,
                 cosine * static_cast<double>(geometry.area()) / (n * n) / (static_cast<double>(r) * r),
                 position_index(d, line_of_sight_), source_of(patch, is_rated(d))});
        }
    }

    bool is_rated(const V3f& towards) const { return has_position_index(towards, line_of_sight_); }

    bool crosses_border_of_table(const Patch& patch) const {
        const auto count = static_cast<std::size_t>(patch.vertex_count());
        const auto rated = std::count_if(patch.vertices.begin(), patch.vertices.begin() + count,
                                         [&](std::uint32_t v) { return is_rated(scene_.vertices[v] - eye_); });
        return rated > 0 && static_cast<std::size_t>(rated) < count;
    }

    /// Adds a luminaire. CIE 117 rates it by the direction of its centre: L = I / A_p and omega = A_p / r^2, with
    /// intensity I, projected area A_p and distance r, and a single position index p. Samples over the opening
    /// determine its visible part.
    void add_luminaire(const Luminaire& luminaire, const MeasuredLight& light) {
        constexpr int per_side = 8, count = per_side * per_side;
        if (light.web->opening.is_point()) return;
        const V3f to_centre = light.position - eye_, d = LuminaireFrame(light).to_luminaire(-to_centre.normalized());
        const float area = projected_area(light.web->opening, d);
        if (!(area > 0)) return;
        const Rgb radiance = light.factor * (light.web->intensity(d) / area);
        const double solid_angle = static_cast<double>(area) / to_centre.length2() / count;
        const double p = position_index(to_centre, line_of_sight_);
        sums_.push_back({luminaire.name, is_rated(to_centre)});
        for (int i = 0; i < count; ++i) {
            const int column = i % per_side, row = i / per_side;
            const Illumination seen = illumination(luminaire, eye_, (static_cast<float>(column) + 0.5f) / per_side,
                                                   (static_cast<float>(row) + 0.5f) / per_side);
            add({seen.towards, seen.distance, no_patch, radiance, solid_angle, p, sums_.size() - 1});
        }
    }

    void add(const SourceCell& cell) {
        if (std::isfinite(cell.position_index) && cell.solid_angle > 0) cells_.push_back(cell);
    }

    std::size_t source_of(const Patch& patch, bool is_rated) {
        const std::string& object = patch.object < scene_.objects.size() ? scene_.objects[patch.object] : no_name_;
        const std::string& name = object.empty() ? scene_.materials[patch.material].name : object;
        const auto [entry, is_new] = by_name_.try_emplace({name, is_rated}, sums_.size());
        if (is_new) sums_.push_back({name, is_rated});
        return entry->second;
    }

    const Scene& scene_;
    const std::string no_name_;
    V3f eye_, line_of_sight_;
    std::vector<SourceCell> cells_;
    std::vector<Sums> sums_;
    std::map<std::pair<std::string, bool>, std::size_t> by_name_;  // keys: name, and whether the source is rated
};

void require_direction(const Observer& observer) {
    const float length = observer.line_of_sight.length();
    if (!(length > 0 && std::isfinite(length)) || !is_finite(V3f(observer.eye)))
        throw InputError("an observer needs an eye and a line of sight that are finite, and a direction");
}

struct SightFrame {
    Imath::V3d sight, above;  // unit length
};

SightFrame frame_of_sight(const V3f& line_of_sight, const V3f& up) {
    const Imath::V3d sight = Imath::V3d(line_of_sight).normalized();
    return {sight, (Imath::V3d(up) - sight * sight.dot(Imath::V3d(up))).normalized()};
}

}  // namespace

double position_index(const V3f& towards, const V3f& line_of_sight, const V3f& up) {
    constexpr double degrees = 180 / pi;
    const auto [sight, above] = frame_of_sight(line_of_sight, up);
    const Imath::V3d source = Imath::V3d(towards).normalized();
    const double cosine = source.dot(sight);
    if (!(cosine > 0)) return std::numeric_limits<double>::infinity();
    const Imath::V3d across = source - sight * cosine;
    const double sine = across.length();
    if (!(sine > 0)) return 1;
    const double sigma = std::atan2(sine, cosine) * degrees,
                 tau = std::acos(std::min(1.0, std::abs(across.dot(above)) / sine)) * degrees;
    return std::exp((35.2 - 0.31889 * tau - 1.22 * std::exp(-2 * tau / 9)) * 1e-3 * sigma +
                    (21 + 0.26667 * tau - 0.002963 * tau * tau) * 1e-5 * sigma * sigma);
}

bool has_position_index(const V3f& towards, const V3f& line_of_sight, const V3f& up) {
    constexpr double highest = 1.9, widest = 3;  // limits of the table of CIE 117, relative to the distance R
    const auto [sight, above] = frame_of_sight(line_of_sight, up);
    const Imath::V3d source(towards);
    const double r = source.dot(sight), h = std::abs(source.dot(above)), t = std::abs(source.dot(sight.cross(above)));
    return r > 0 && h <= highest * r && t <= widest * r;
}

double unified_glare_rating(double background_luminance, std::span<const GlareSource> sources) {
    double sum = 0;
    for (const GlareSource& source : sources)
        if (source.is_rated) sum += source.glare;
    if (!(sum > 0)) return -std::numeric_limits<double>::infinity();
    return 8 * std::log10(0.25 / background_luminance * sum);
}

std::vector<GlareSource> glare_sources(const Scene& scene, const RayCaster& ray_caster, const Observer& observer) {
    require_direction(observer);
    ray_caster.require_made_for(scene);
    SourceCells seen(scene, observer);
    const std::vector<SourceCell>& cells = seen.cells();
    ShadowRays rays;
    for (const SourceCell& cell : cells) rays.add({seen.eye(), cell.towards}, cell.patch, cell.distance);
    RayCounts counts;
    const std::span<const Rgb> transmittance = rays.trace(ray_caster, Panes(scene, ray_caster), counts);
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const double l = luminance(RgbD(cells[i].radiance * transmittance[i]));
        if (l > 0) seen.sums()[cells[i].source].add(l, cells[i].solid_angle, cells[i].position_index);
    }
    std::vector<GlareSource> sources;
    for (const Sums& sums : seen.sums())
        if (sums.glare > 0) sources.push_back(sums.source());
    std::stable_sort(sources.begin(), sources.end(), [](const GlareSource& a, const GlareSource& b) {
        return std::tuple(a.is_rated, a.glare) > std::tuple(b.is_rated, b.glare);
    });
    return sources;
}

std::vector<GlareRating> rate_glare(const Scene& scene, const Solution* solution, const RayCaster& ray_caster,
                                    std::span<const Observer> observers, const MeasuringOptions& options,
                                    const Monitor& monitor) {
    std::vector<MeasuringPoint> eyes;
    for (const Observer& observer : observers) {
        require_direction(observer);
        eyes.push_back({observer.eye, observer.line_of_sight});
    }
    const std::vector<MeasuredIrradiance> measured =
        measure_irradiance(scene, solution, ray_caster, eyes, options, monitor);
    std::vector<GlareRating> ratings(observers.size());
    parallel_for_ranges(observers.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            GlareRating& rating = ratings[i];
            rating.standard_error = static_cast<double>(luminance(measured[i].standard_error));
            if (!measured[i].is_measured()) continue;
            rating.sources = glare_sources(scene, ray_caster, observers[i]);
            rating.background_luminance = static_cast<double>(luminance(measured[i].indirect)) / pi;
            rating.ugr = unified_glare_rating(rating.background_luminance, rating.sources);
            const double error = static_cast<double>(measured[i].indirect_error) / pi;
            rating.standard_error = error > 0 ? 8 / std::numbers::ln10 * error / rating.background_luminance : 0;
        }
    });
    return ratings;
}

}  // namespace interflect
