#include "interflect/render/paths/indirect_field.h"

#include <ImathBoxAlgo.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "interflect/base/parallel.h"
#include "interflect/base/random.h"
#include "interflect/base/shared_ranges.h"
#include "interflect/geometry/tangent_frame.h"
#include "interflect/render/paths/path_wavefront.h"

namespace interflect::detail {

namespace {

/// Variance between groups estimates the error of a record. 128 to 1,024 paths.
constexpr std::size_t paths_per_group = 16, min_groups = 8, max_groups = 64;
/// Groups of a record: groups_per_deviation x sigma / E x reach / spacing, with the standard deviation sigma of a group
/// and all irradiance E at the record, but at least min_share_of_mean of the mean E. This minimises the squared error
/// of the picture per ray (Neyman allocation): a record affects all pixels in its reach. Bakes are seen from anywhere:
/// there the geometric mean keeps a sunlit ground from hiding the noise of rooms, and no error exceeds max_baked_error.
constexpr float groups_per_deviation = 7, min_share_of_mean = 0.25f;
constexpr float max_baked_error = 0.1f;  // standard error of a record
/// Reach of a record, relative to the harmonic mean length of its rays; limits in spacings of the points. With 0.35 and
/// 512 paths, errors are 1.1 to 1.8 times as large.
constexpr float reach_over_length = 0.15f, min_spacings = 4, max_spacings = 100;
/// Sum of record weights, at most 1 each, that covers a point.
constexpr float covering_weight = 1.5f;
constexpr std::size_t points_of_first_round = 256;  // the total doubles with each round
constexpr std::size_t points_per_task = 1024, records_per_task = 64, groups_per_task = 128;
/// Groups that each rank gathers between two questions whether to stop: some seconds of one thread.
constexpr std::size_t groups_of_rank = 1 << 16;

V3f nearest_on(const Contact& contact, const V3f& x) {
    const V3f along = contact.b - contact.a;
    const float length2 = along.length2();
    return length2 > 0 ? contact.a + along * std::clamp((x - contact.a).dot(along) / length2, 0.0f, 1.0f) : contact.a;
}

std::vector<Boxed> make_tree(const std::vector<Contact>& contacts) {
    std::vector<Boxed> tree;
    for (std::uint32_t i = 0; i < contacts.size(); ++i) {
        Imath::Box3f box(contacts[i].a);
        box.extendBy(contacts[i].b);
        tree.push_back({box, i});
    }
    arrange_box_tree(tree);
    return tree;
}

/// Light of a group of paths of a record.
struct GatheredGroup {
    std::uint32_t record = 0;
    bool is_done = false;
    float inverse_length = 0;  // as FirstHit::inverse_length, sum over the paths [1/m]
    RgbD indirect{0, 0, 0};    // sum over the paths
    std::int64_t rays = 0;     // of all groups of its task, in the first of them
};

/// Traces the batches, which all ranks share. @param scene  Gathers at the records.
std::vector<GatheredGroup> gather_groups(const PathScene& scene, std::span<BatchOfPaths> batches,
                                         const CommonStop& stop) {
    std::vector<GatheredGroup> groups(batches.size());
    parallel_for_own_ranges(stop.ranks(), batches.size(), groups_per_task, [&](std::size_t begin, std::size_t end) {
        if (stop.within_process().is_due()) return;
        PathWavefront wavefront(scene);
        wavefront.trace(batches.subspan(begin, end - begin));
        for (std::size_t i = begin; i < end; ++i) {
            const BatchOfPaths& b = batches[i];
            groups[i] = {b.pixel, b.done, static_cast<float>(b.first.inverse_length), b.indirect};
        }
        groups[begin].rays = wavefront.counts().rays;
    });
    collect_ranges(stop.ranks(), std::span(groups), groups_per_task, Destination::all_ranks);
    return groups;
}

/// Returns a random permutation.
std::vector<std::uint32_t> shuffled(std::size_t count, std::uint64_t seed) {
    std::vector<std::uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0u);
    const auto key = [seed](std::uint32_t i) { return mix(seed, i); };
    parallel_sort(order, [&](std::uint32_t a, std::uint32_t b) {
        const auto key_a = key(a), key_b = key(b);
        return key_a < key_b || (key_a == key_b && a < b);
    });
    return order;
}

}  // namespace

IndirectField::IndirectField(const PathScene& scene, std::span<const SurfacePoint> points, const Monitor& monitor)
    : contacts_(scene.scene.contacts), contact_tree_(make_tree(contacts_)) {
    const CommonStop stop(monitor.stop, monitor.ranks);
    cover(scene, points, monitor, stop);
    refine_noisy_records(scene, stop);
}

void IndirectField::cover(const PathScene& scene, std::span<const SurfacePoint> points, const Monitor& monitor,
                          const CommonStop& stop) {
    const std::vector<std::uint32_t> order = shuffled(points.size(), scene.options.seed);
    for (std::size_t begin = 0, end = 0; begin < points.size(); begin = end) {
        end = std::min(points.size(), std::max(points_of_first_round, 2 * begin));
        std::vector<SurfacePoint> candidates;
        for (std::size_t i = begin; i < end; ++i) candidates.push_back(points[order[i]]);
        if (stop.is_due() || add_records(scene, uncovered_among(candidates, stop.ranks()), stop)) return;
        const double done = std::sqrt(static_cast<double>(end) / static_cast<double>(points.size()));
        if (monitor.on_progress) monitor.on_progress({rays_, done});
    }
}

std::vector<SurfacePoint> IndirectField::uncovered_among(std::span<const SurfacePoint> points, Ranks* ranks) const {
    std::vector<std::uint8_t> is_covered(points.size(), 0);
    parallel_for_own_ranges(ranks, points.size(), points_per_task, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i)
            is_covered[i] =
                fit_at(points[i].position, points[i].normal, points[i].patch).values.weight() >= covering_weight;
    });
    collect_ranges(ranks, std::span(is_covered), points_per_task, Destination::all_ranks);
    std::vector<SurfacePoint> uncovered;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (is_covered[i] == 0) uncovered.push_back(points[i]);
    return uncovered;
}

bool IndirectField::gather(const PathScene& scene, std::span<const std::uint32_t> chosen, std::size_t groups,
                           const CommonStop& stop) {
    std::vector<Gauge> gauges;
    for (const Record& r : records_) gauges.push_back({.position = r.position, .normal = r.normal});
    std::vector<BatchOfPaths> batches;
    for (const std::uint32_t i : chosen)
        for (std::size_t group = 0; group < groups; ++group) {
            const std::size_t first_point = (records_[i].gathered.batches + group) * paths_per_group;
            batches.push_back({.pixel = i, .first_point = static_cast<std::uint32_t>(first_point)});
        }
    PathStart start;
    start.gauges = gauges;
    PathScene gathering = scene;
    gathering.start = &start;
    gathering.batch_size = paths_per_group;
    gathering.is_indirect_only = true;
    // Irradiance in pictures of irradiance, else radiance of a white surface.
    const double per_path =
        (scene.options.quantity == PictureQuantity::irradiance ? 1 : std::numbers::pi) / paths_per_group;
    const std::size_t at_once = stop.ranks() ? groups_of_rank * stop.ranks()->count() : batches.size();
    for (std::size_t first = 0; first < batches.size(); first += at_once) {
        const std::span<BatchOfPaths> some =
            std::span(batches).subspan(first, std::min(at_once, batches.size() - first));
        for (const GatheredGroup& group : gather_groups(gathering, some, stop)) {
            rays_ += group.rays;
            if (!group.is_done) continue;
            Record& r = records_[group.record];
            r.gathered.add(group.indirect * per_path);
            r.inverse_length += group.inverse_length;
        }
        if (stop.is_due()) return true;
    }
    return false;
}

bool IndirectField::add_records(const PathScene& scene, std::span<const SurfacePoint> points, const CommonStop& stop) {
    const std::size_t old_count = records_.size();
    for (const SurfacePoint& p : points)
        records_.push_back({.position = p.position, .normal = p.normal, .patch = p.patch});
    std::vector<std::uint32_t> added(points.size());
    std::iota(added.begin(), added.end(), static_cast<std::uint32_t>(old_count));
    if (gather(scene, added, min_groups, stop)) {
        records_.resize(old_count);  // without a reach yet
        return true;
    }
    constexpr float paths_per_record = paths_per_group * min_groups;
    for (std::size_t i = 0; i < points.size(); ++i) {
        Record& r = records_[old_count + i];
        const float max_reach = max_spacings * points[i].spacing;
        r.reach = r.inverse_length > 0 ? reach_over_length * paths_per_record / r.inverse_length : max_reach;
        r.reach = std::clamp(r.reach, min_spacings * points[i].spacing, max_reach);
        r.reach_in_spacings = r.reach / points[i].spacing;
        r.reach_elsewhere = distance_to_contact(r.position, r.reach);
        r.irradiance = luminance(Rgb(r.gathered.mean));
        if (r.patch != none)
            r.irradiance =
                std::max(r.irradiance, luminance(scene.known->irradiance(scene.known->place(r.patch, r.position))));
    }
    tree_.resize(records_.size());
    for (std::uint32_t i = 0; i < records_.size(); ++i) {
        const Record& r = records_[i];
        tree_[i] = {{r.position - V3f(r.reach), r.position + V3f(r.reach)}, i};
    }
    arrange_box_tree(tree_);
    return false;
}

void IndirectField::refine_noisy_records(const PathScene& scene, const CommonStop& stop) {
    if (records_.empty() || stop.is_due()) return;
    const bool is_bake = !scene.start->camera;
    const float min_irradiance = min_share_of_mean * (is_bake ? log_mean_irradiance() : mean_irradiance());
    std::vector<float> needed(records_.size());
    parallel_for_ranges(records_.size(), records_per_task, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Record& r = records_[i];
            const float deviation = std::sqrt(pooled_variance(r)) / std::max(min_irradiance, r.irradiance);
            needed[i] = groups_per_deviation * deviation * r.reach_in_spacings;
            if (is_bake) needed[i] = std::max(needed[i], (deviation * deviation) / (max_baked_error * max_baked_error));
        }
    });
    // Each round doubles the groups of noisy records.
    for (std::size_t groups = min_groups; groups < max_groups; groups *= 2) {
        std::vector<std::uint32_t> noisy;
        for (std::uint32_t i = 0; i < records_.size(); ++i)
            if (needed[i] > static_cast<float>(groups)) noisy.push_back(i);
        if (noisy.empty()) return;
        if (gather(scene, noisy, groups, stop)) return;
    }
}

float IndirectField::mean_irradiance() const {
    double sum = 0;
    for (const Record& r : records_) sum += static_cast<double>(r.irradiance);
    return static_cast<float>(sum / static_cast<double>(records_.size()));
}

float IndirectField::log_mean_irradiance() const {
    double sum = 0, lit = 0;
    for (const Record& r : records_)
        if (r.irradiance > 0) sum += std::log(static_cast<double>(r.irradiance)), ++lit;
    return lit > 0 ? static_cast<float>(std::exp(sum / lit)) : 0;
}

float IndirectField::pooled_variance(const Record& record) const {
    double squares = 0, degrees_of_freedom = 0;
    visit_near(record.position, record.normal, record.patch, [&](std::uint32_t i, float) {
        squares += records_[i].gathered.squares, degrees_of_freedom += records_[i].gathered.batches - 1.0;
    });
    return static_cast<float>(squares / degrees_of_freedom);
}

float IndirectField::distance_to_contact(const V3f& x, float max_distance) const {
    float nearest = max_distance;
    const auto is_near = [&](const Imath::Box3f& box) {
        return (Imath::closestPointInBox(x, box) - x).length() < nearest;
    };
    visit_box_tree(std::span<const Boxed>(contact_tree_), is_near,
                   [&](std::uint32_t i) { nearest = std::min(nearest, (nearest_on(contacts_[i], x) - x).length()); });
    return nearest;
}

float IndirectField::Record::relative_distance2(const V3f& x, const V3f& n, std::uint32_t of_patch) const {
    constexpr float min_cosine = 0.97f;  // between normals at the record itself: 14 degrees
    constexpr float height_factor = 10;  // distances along the normal count more: parallel surfaces differ
    const float cosine = normal.dot(n);
    if (cosine <= min_cosine) return 1;
    const V3f d = position - x;
    const float max_distance = of_patch == patch ? reach : reach_elsewhere, height = height_factor * d.dot(n);
    return (d.length2() + height * height) / (max_distance * max_distance) + (1 - cosine) / (1 - min_cosine);
}

IndirectField::Fit IndirectField::fit_at(const V3f& x, const V3f& n, std::uint32_t patch) const {
    const TangentFrame frame(n);
    Fit fit;
    float least = 1;
    visit_near(x, n, patch, [&](std::uint32_t i, float distance2) {
        const Record& r = records_[i];
        const V3f d = r.position - x;
        fit.values.add((1 - distance2) * (1 - distance2), d.dot(frame.s), d.dot(frame.t), Rgb(r.gathered.mean));
        if (distance2 < least) least = distance2, fit.nearest = i;
    });
    return fit;
}

std::optional<IndirectField::Light> IndirectField::at(const V3f& x, const V3f& n, std::uint32_t patch) const {
    constexpr float min_weight = 0.1f;  // less: at the end of a single record's reach
    const Fit fit = fit_at(x, n, patch);
    if (!(fit.values.weight() > min_weight)) return std::nullopt;
    return Light{fit.values.value(), fit.nearest};
}

}  // namespace interflect::detail
