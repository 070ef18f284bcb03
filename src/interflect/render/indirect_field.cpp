#include "interflect/render/indirect_field.h"

#include <ImathBoxAlgo.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "interflect/base/parallel.h"
#include "interflect/base/random.h"
#include "interflect/geometry/tangent_frame.h"
#include "interflect/render/path_wavefront.h"

namespace interflect::detail {

namespace {

constexpr std::size_t paths_per_record = 512, records_per_tile = 4;
/// Reach of a record: relative to the harmonic mean length of its rays, and its limits in spacings of the points.
constexpr float reach_share = 0.35f, least_spacings = 4, most_spacings = 100;
constexpr float least_cosine = 0.97f;  // of the angle between normals at the end of the reach: 14 degrees
/// Distances along the normal count more: parallel surfaces differ.
constexpr float height_factor = 10;
/// Sum of weights, at most 1 each, at a covered point.
constexpr float covering_weight = 1;
constexpr std::size_t points_of_first_round = 256;  // each round doubles them
constexpr std::size_t points_at_once = 1024;
/// Ridge of the linear fit, relative to the records' spread. Bounds the slope of few or nearly collinear records.
constexpr float relative_ridge = 0.1f;

V3f nearest_on(const Contact& contact, const V3f& x) {
    const V3f along = contact.b - contact.a;
    const float length2 = along.length2();
    return length2 > 0 ? contact.a + along * std::clamp((x - contact.a).dot(along) / length2, 0.0f, 1.0f) : contact.a;
}

std::vector<Boxed> tree_of(const std::vector<Contact>& contacts) {
    std::vector<Boxed> tree;
    for (std::uint32_t i = 0; i < contacts.size(); ++i) {
        Imath::Box3f box(contacts[i].a);
        box.extendBy(contacts[i].b);
        tree.push_back({box, i});
    }
    arrange_box_tree(tree);
    return tree;
}

/// Random order, the same for the same seed.
std::vector<std::uint32_t> shuffled(std::size_t count, std::uint64_t seed) {
    std::vector<std::uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0u);
    const auto key = [seed](std::uint32_t i) { return mix(seed, i); };
    parallel_sort(order, [&](std::uint32_t a, std::uint32_t b) {
        const auto of_a = key(a), of_b = key(b);
        return of_a < of_b || (of_a == of_b && a < b);
    });
    return order;
}

}  // namespace

/// Weighted least squares fit of a linear function in the tangent plane at a point.
struct IndirectField::Fit {
    float weight = 0, s = 0, t = 0, ss = 0, st = 0, tt = 0;  // weighted sums
    Rgb value{0, 0, 0}, value_s{0, 0, 0}, value_t{0, 0, 0};
    Rgb least{0, 0, 0}, most{0, 0, 0};

    void add(float w, float at_s, float at_t, const Rgb& irradiance) {
        for (int c = 0; c < 3; ++c) {
            least[c] = weight > 0 ? std::min(least[c], irradiance[c]) : irradiance[c];
            most[c] = weight > 0 ? std::max(most[c], irradiance[c]) : irradiance[c];
        }
        weight += w, s += w * at_s, t += w * at_t;
        ss += w * at_s * at_s, st += w * at_s * at_t, tt += w * at_t * at_t;
        value += w * irradiance, value_s += w * at_s * irradiance, value_t += w * at_t * irradiance;
    }

    Rgb result() const {
        const float ridge = relative_ridge * (ss + tt), a = ss + ridge, d = tt + ridge;
        const float determinant = a * d - st * st;
        if (!(determinant > 0)) return value / weight;
        const float by_s = (s * d - t * st) / determinant, by_t = (t * a - s * st) / determinant;
        const float own = weight - s * by_s - t * by_t;
        if (!(own > 0)) return value / weight;
        Rgb fitted = (value - value_s * by_s - value_t * by_t) / own;
        for (int c = 0; c < 3; ++c) fitted[c] = std::clamp(fitted[c], least[c], most[c]);
        return fitted;
    }
};

IndirectField::IndirectField(const PathScene& scene, std::span<const SurfacePoint> points,
                             const std::atomic<bool>* stop)
    : contacts_(scene.scene.contacts), contact_tree_(tree_of(contacts_)) {
    const std::vector<std::uint32_t> order = shuffled(points.size(), scene.options.seed);
    std::vector<std::uint8_t> is_covered;
    std::vector<SurfacePoint> uncovered;
    for (std::size_t begin = 0, end = 0; begin < points.size() && !(stop && *stop); begin = end) {
        end = std::min(points.size(), std::max(points_of_first_round, 2 * begin));
        is_covered.assign(end - begin, 0);
        parallel_for_ranges(end - begin, points_at_once, [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i) {
                const SurfacePoint& p = points[order[begin + i]];
                is_covered[i] = fit_at(p.position, p.normal, p.patch).weight >= covering_weight;
            }
        });
        uncovered.clear();
        for (std::size_t i = 0; i < is_covered.size(); ++i)
            if (is_covered[i] == 0) uncovered.push_back(points[order[begin + i]]);
        add_records(scene, uncovered, stop);
    }
}

void IndirectField::add_records(const PathScene& scene, std::span<const SurfacePoint> points,
                                const std::atomic<bool>* stop) {
    std::vector<Gauge> gauges;
    std::vector<BatchOfPaths> batches;
    for (const SurfacePoint& p : points) {
        gauges.push_back({.position = p.position, .normal = p.normal});
        batches.push_back({.pixel = static_cast<std::uint32_t>(batches.size()),
                           .batch = static_cast<std::uint32_t>(records_.size())});
    }
    PathStart start;
    start.gauges = gauges;
    PathScene gathering = scene;
    gathering.start = &start;
    gathering.batch_size = paths_per_record;
    gathering.is_indirect_only = true;
    // A batch is in the unit of the picture.
    const double per_path =
        (scene.options.quantity == PathQuantity::irradiance ? 1 : std::numbers::pi) / paths_per_record;
    std::vector<std::int64_t> rays((batches.size() + records_per_tile - 1) / records_per_tile);
    parallel_for_ranges(batches.size(), records_per_tile, [&](std::size_t begin, std::size_t end) {
        if (stop && *stop) return;
        PathWavefront wavefront(gathering);
        wavefront.trace(std::span(batches).subspan(begin, end - begin));
        rays[begin / records_per_tile] = wavefront.counts().rays;
    });
    if (stop && *stop) return;
    rays_ = std::accumulate(rays.begin(), rays.end(), rays_);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const SurfacePoint& p = points[i];
        const auto nearness = static_cast<float>(batches[i].first.nearness / paths_per_record);
        const float reach = std::clamp(nearness > 0 ? reach_share / nearness : most_spacings * p.spacing,
                                       least_spacings * p.spacing, most_spacings * p.spacing);
        const Rgb irradiance = Rgb(batches[i].indirect * per_path);
        tree_.push_back({{}, static_cast<std::uint32_t>(records_.size())});
        records_.push_back({p.position, p.normal, p.patch, reach, distance_to_contact(p.position, reach), irradiance});
    }
    for (std::uint32_t i = 0; i < records_.size(); ++i) {
        const Record& r = records_[i];
        tree_[i] = {{r.position - V3f(r.reach), r.position + V3f(r.reach)}, i};
    }
    arrange_box_tree(tree_);
}

float IndirectField::distance_to_contact(const V3f& x, float most) const {
    const auto is_near = [&](const Imath::Box3f& box) {
        return (Imath::closestPointInBox(x, box) - x).length() < most;
    };
    visit_box_tree(std::span<const Boxed>(contact_tree_), is_near,
                   [&](std::uint32_t i) { most = std::min(most, (nearest_on(contacts_[i], x) - x).length()); });
    return most;
}

IndirectField::Fit IndirectField::fit_at(const V3f& x, const V3f& n, std::uint32_t patch) const {
    const TangentFrame frame(n);
    Fit fit;
    const auto reaches = [&](const Imath::Box3f& box) { return box.intersects(x); };
    visit_box_tree(std::span<const Boxed>(tree_), reaches, [&](std::uint32_t i) {
        const Record& r = records_[i];
        const float cosine = r.normal.dot(n);
        if (cosine <= least_cosine) return;
        const V3f d = r.position - x;
        const float reach = r.patch == patch ? r.reach : r.reach_elsewhere, height = height_factor * d.dot(n);
        const float distance = (d.length2() + height * height) / (reach * reach) + (1 - cosine) / (1 - least_cosine);
        if (!(distance < 1)) return;
        fit.add((1 - distance) * (1 - distance), d.dot(frame.s), d.dot(frame.t), r.irradiance);
    });
    return fit;
}

std::optional<Rgb> IndirectField::at(const V3f& x, const V3f& n, std::uint32_t patch) const {
    constexpr float least_weight = 0.1f;
    const Fit fit = fit_at(x, n, patch);
    if (!(fit.weight > least_weight)) return std::nullopt;
    return fit.result();
}

}  // namespace interflect::detail
