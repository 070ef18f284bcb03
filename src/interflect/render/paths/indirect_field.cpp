#include "interflect/render/paths/indirect_field.h"

#include <ImathBoxAlgo.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "interflect/base/numbers/random.h"
#include "interflect/base/threads/parallel.h"
#include "interflect/base/threads/shared_ranges.h"
#include "interflect/geometry/textures/tangent_frame.h"
#include "interflect/render/paths/path_integrator.h"
#include "interflect/render/reflections/known_light.h"

namespace interflect::detail {

namespace {

/// A record gathers least_groups() to max_groups groups of paths, which are 128 to 1,024 paths at full effort. The
/// difference between the two halves of a group estimates the error of the record.
constexpr std::size_t paths_per_group = 16, full_least_groups = 8, max_groups = 64;
/// Number of paths of a record for each ray to a bright place. Two take 0.89 to 0.97 of the time of one in five scenes,
/// with equal errors; four increase the error in blocks of 9 pixels to up to 1.05 times.
constexpr std::uint32_t record_paths_per_place = 2;
/// Number of groups of a record = groups_per_deviation x (sigma / E) x (reach / spacing). Here sigma is the standard
/// deviation of a group and E the irradiance at the record, at least min_share_of_mean times the mean E. This number
/// minimises the squared error of the picture per ray (Neyman allocation), because a record affects all pixels in its
/// reach. Bakes use the geometric mean of E, so that a sunlit ground does not hide the noise of rooms, and limit the
/// error of each record to baked_error().
///
/// groups_per_deviation is between 8 and 16, which has 0.64 to 0.82 of the squared error in blocks of 9 pixels for 1.01
/// to 1.29 times the processor time (four scenes, 3 M rays); 4 has 1.2 to 1.5 times that of 8.
constexpr float groups_per_deviation = 12, min_share_of_mean = 0.25f;
/// Pictures with fewer samples than this gather fewer groups, too, to balance the noise of pixels and of records.
constexpr float full_effort_samples = 8;
/// Standard error of a record of a bake, relative to E, for a reach of at least min_spacings; baked_error() is larger
/// for a shorter reach. A record gathers at most max_baked_groups. With 10%, bakes of two rooms take 0.63 and 0.97 of
/// the time, but walls that only lamps light are visibly blotchy.
constexpr float max_baked_error = 0.05f;
constexpr std::size_t max_baked_groups = 256;
/// Reach of a record, relative to the harmonic mean length of its rays, and its limits in spacings of the points. With
/// 0.35 in place of 0.15, errors are 1.1 to 1.8 times as large, even with 512 paths per record. With 8 in place of 4
/// spacings, the indirect light of a room of 160 x 90 pixels is another 0.3% too dark.
constexpr float reach_over_length = 0.15f, min_spacings = 4, max_spacings = 100;
/// A record and its neighbours halve their reach if the record differs from the fit of its neighbours by more than this
/// share of all irradiance. The halved reach is at least min_halved_spacings, in bakes min_baked_spacings.
constexpr float max_residual = 0.1f, min_halved_spacings = 2, min_baked_spacings = 1;
/// Texels may be as wide as the gap beside a ball on the floor, so records of bakes may reach less than min_spacings:
/// at least this share of the harmonic mean length of their rays. At 20 texels per metre, irradiance 5 to 10 cm from
/// the contact of a ball of radius 0.2 m is 1.07 times too high, compared with 1.17 for min_spacings; 1.15 and 1.21
/// times for 0.13 m in another room. With 1 or 0.25, it is 1.09 times in the first and 1.16 or 1.13 in the second.
constexpr float min_baked_reach_over_length = 0.5f;
/// Squared error of interpolation at a point, relative to the squared error at a record that is interpolated from its
/// neighbours. Errors fall at least in proportion to the distance, and a point is half as far from the next record as
/// that record is from its neighbours: (1/2)^2.
constexpr float bias_of_points = 0.25f;
/// Minimum sum of the weights of neighbours for a fit that predicts a record.
constexpr float min_neighbour_weight = 0.3f;
/// A point is covered if the weights of the records around it, at most 1 each, have at least this sum.
constexpr float covering_weight = 1.5f;
constexpr std::size_t points_of_first_round = 256;  // the total doubles with each round
constexpr std::size_t points_per_task = 1024, records_per_task = 64, groups_per_task = 128;
/// Groups that each rank gathers before it checks again for a stop; they take one thread some seconds.
constexpr std::size_t groups_of_rank = 1 << 16;

/// Returns the fraction of the full number of groups, at most 1. Bakes have full effort, and so do pictures with a
/// target of the error, because it includes the error of records.
float effort_of(const PathPlan& plan) {
    const bool is_full = !plan.start.camera || plan.options.until > 0;
    return is_full ? 1 : std::min(1.0f, static_cast<float>(plan.options.samples) / full_effort_samples);
}
/// Returns the minimum number of groups. With two samples a pixel, a quarter of the full number has 1.17 times the
/// squared error in 0.67 of the time.
std::size_t least_groups(const PathPlan& plan) {
    constexpr float fewest = 2;
    return static_cast<std::size_t>(std::max(fewest, effort_of(plan) * static_cast<float>(full_least_groups)));
}

/// Returns the least reach of a record. @param length  Harmonic mean length of its rays.
float least_reach(const PathPlan& plan, float length, float spacing) {
    if (plan.start.camera) return min_spacings * spacing;
    return std::clamp(min_baked_reach_over_length * length, min_baked_spacings * spacing, min_spacings * spacing);
}
/// Returns the standard error to which a record of a bake is gathered, relative to E: up to twice max_baked_error,
/// where records reach one texel, because a smaller reach averages the errors of more records over an area.
float baked_error(float reach, float spacing) {
    return max_baked_error * std::sqrt(std::max(1.0f, min_spacings * spacing / reach));
}

float square(float x) { return x * x; }

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

/// Light that a group of paths has gathered for a record.
struct GatheredGroup {
    std::uint32_t record = 0;
    bool is_done = false;
    float inverse_length = 0, hits = 0;  // sums of FirstHit::inverse_length and hits over the paths
    std::array<RgbD, 2> indirect{};      // sums over the paths of each half
    std::int64_t rays = 0;               // the first group of a task counts the rays of all its groups
};

/// Traces the batches in all ranks together. @param plan  Plan whose gauges are the records.
std::vector<GatheredGroup> gather_groups(const PathPlan& plan, std::span<SampleBatch> batches, const CommonStop& stop) {
    std::vector<GatheredGroup> groups(batches.size());
    PerThread<PathIntegrator> integrators([&] { return PathIntegrator(plan); });
    parallel_for_own_ranges(stop.ranks(), batches.size(), groups_per_task, [&](std::size_t begin, std::size_t end) {
        if (stop.within_process().is_due()) return;
        PathIntegrator& integrator = integrators.local();
        integrator.trace(batches.subspan(begin, end - begin));
        for (std::size_t i = begin; i < end; ++i) {
            const SampleBatch& b = batches[i];
            groups[i] = {b.pixel,
                         b.done,
                         static_cast<float>(b.first.inverse_length),
                         static_cast<float>(b.first.hits),
                         {b.halves[0].indirect, b.halves[1].indirect}};
        }
        groups[begin].rays = integrator.counts().rays;
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

IndirectField::IndirectField(const PathPlan& plan, std::span<const SurfacePoint> points, const Monitor& monitor)
    : contacts_(plan.scene.scene.contacts), contact_tree_(make_tree(contacts_)) {
    const CommonStop stop(monitor.stop, monitor.ranks);
    cover(plan, points, monitor, stop);
    refine_noisy_records(plan, stop);
    pool_variances();
    estimate_bias();
}

void IndirectField::cover(const PathPlan& plan, std::span<const SurfacePoint> points, const Monitor& monitor,
                          const CommonStop& stop) {
    const std::vector<std::uint32_t> order = shuffled(points.size(), plan.options.seed);
    for (std::size_t begin = 0, end = 0; begin < points.size(); begin = end) {
        end = std::min(points.size(), std::max(points_of_first_round, 2 * begin));
        std::vector<SurfacePoint> candidates;
        for (std::size_t i = begin; i < end; ++i) candidates.push_back(points[order[i]]);
        const std::size_t first_new = records_.size();
        if (stop.is_due() || add_records(plan, uncovered_among(candidates, stop.ranks()), stop)) return;
        shorten_reaches(plan, first_new);
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

bool IndirectField::gather(const PathPlan& plan, std::span<const std::uint32_t> chosen, std::size_t groups,
                           const CommonStop& stop, std::vector<float>* lengths) {
    std::vector<Gauge> gauges;
    for (const Record& r : records_) gauges.push_back({.position = r.position, .normal = r.normal});
    // Each group of a record is a batch, which continues the sequences of the earlier groups
    constexpr std::uint32_t half_size = paths_per_group / 2;
    std::vector<SampleBatch> batches;
    for (const std::uint32_t i : chosen)
        for (std::uint32_t group = 0; group < groups; ++group)
            batches.push_back(
                {.pixel = i, .first_index = (records_[i].gathered.groups + group) * half_size, .size = half_size});
    PathStart start;
    start.gauges = gauges;
    const PathPlan gathering{.scene = plan.scene,
                             .start = start,
                             .options = plan.options,
                             .has_direct = false,
                             .seen_sources = plan.seen_sources,
                             .known = plan.known,
                             .paths_per_place = record_paths_per_place};
    // Light of a path is irradiance in pictures of irradiance, else the radiance L of a white surface; irradiance = pi
    // L.
    const double per_path = (plan.shows_irradiance() ? 1 : std::numbers::pi) / paths_per_group;
    std::vector<float> inverse_length(records_.size()), hits(records_.size());
    const std::size_t at_once = stop.ranks() ? groups_of_rank * stop.ranks()->count() : batches.size();
    bool is_stopped = false;
    for (std::size_t first = 0; first < batches.size() && !is_stopped; first += at_once) {
        const std::span<SampleBatch> part =
            std::span(batches).subspan(first, std::min(at_once, batches.size() - first));
        for (const GatheredGroup& group : gather_groups(gathering, part, stop)) {
            rays_ += group.rays;
            if (!group.is_done) continue;
            Record& r = records_[group.record];
            r.gathered.add((group.indirect[0] + group.indirect[1]) * per_path);
            r.difference += mean_channel(group.indirect[0] - group.indirect[1]) * per_path;
            inverse_length[group.record] += group.inverse_length;
            hits[group.record] += group.hits;
        }
        is_stopped = stop.is_due();
    }
    if (lengths)
        for (const std::uint32_t i : chosen) lengths->push_back(hits[i] > 0 ? hits[i] / inverse_length[i] : 0);
    return is_stopped;
}

bool IndirectField::add_records(const PathPlan& plan, std::span<const SurfacePoint> points, const CommonStop& stop) {
    const std::size_t old_count = records_.size();
    for (const SurfacePoint& p : points)
        records_.push_back({.position = p.position, .normal = p.normal, .patch = p.patch, .spacing = p.spacing});
    std::vector<std::uint32_t> added(points.size());
    std::iota(added.begin(), added.end(), static_cast<std::uint32_t>(old_count));
    std::vector<float> lengths;  // harmonic means; 0: no ray hit a surface
    if (gather(plan, added, least_groups(plan), stop, &lengths)) {
        records_.resize(old_count);  // the new records have no reach yet
        return true;
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
        Record& r = records_[old_count + i];
        const float max_reach = max_spacings * r.spacing;
        r.reach = lengths[i] > 0
                      ? std::clamp(reach_over_length * lengths[i], least_reach(plan, lengths[i], r.spacing), max_reach)
                      : max_reach;
        r.reach_elsewhere = distance_to_contact(r.position, r.reach);
        r.irradiance = luminance(Rgb(r.gathered.mean));
        if (r.patch != none)
            r.irradiance =
                std::max(r.irradiance, luminance(plan.known->irradiance(plan.known->place(r.patch, r.position))));
    }
    arrange_tree();
    return false;
}

void IndirectField::arrange_tree() {
    tree_.resize(records_.size());
    for (std::uint32_t i = 0; i < records_.size(); ++i) {
        const Record& r = records_[i];
        tree_[i] = {{r.position - V3f(r.reach), r.position + V3f(r.reach)}, i};
    }
    arrange_box_tree(tree_);
    reaches_.resize(records_.size());
    for (std::uint32_t i = 0; i < records_.size(); ++i) {
        const Record& r = records_[tree_[i].index];
        reaches_[i] = {
            r.position,    r.normal, r.patch, 1 / (r.reach * r.reach), 1 / (r.reach_elsewhere * r.reach_elsewhere),
            tree_[i].index};
        tree_[i].index = i;
    }
}

void IndirectField::pool_variances() {
    // The variance of a record's mean is a quarter of the squared difference between its halves.
    const auto of_group = [](const Record& r) {
        const double groups = r.gathered.groups, difference = r.difference / groups;
        return difference * difference * groups;
    };
    std::vector<float> pooled(records_.size());
    parallel_for_ranges(records_.size(), records_per_task, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            double sum = 0, count = 0;
            visit_near(records_[i].position, records_[i].normal, records_[i].patch, [&](std::uint32_t k, float) {
                sum += of_group(records_[k]);
                ++count;
            });
            pooled[i] = static_cast<float>(count > 0 ? sum / count : of_group(records_[i]));
        }
    });
    for (std::size_t i = 0; i < records_.size(); ++i) records_[i].group_variance = pooled[i];
}

std::optional<IndirectField::Residual> IndirectField::residual(std::uint32_t i) const {
    const Record& r = records_[i];
    const Fit fit = fit_at(r.position, r.normal, r.patch, i);
    if (!(fit.values.weight() > min_neighbour_weight)) return {};
    const double difference = mean_channel(RgbD(fit.values.value()) - r.gathered.mean);
    return Residual{difference * difference, static_cast<double>(fit.values.variance() + r.variance())};
}

void IndirectField::shorten_reaches(const PathPlan& plan, std::size_t first_new) {
    const float least_spacings = plan.start.camera ? min_halved_spacings : min_baked_spacings;
    constexpr double certain = 4;  // in variances: squared residuals beyond two standard errors
    pool_variances();
    std::vector<std::uint8_t> fails(records_.size(), 0);
    parallel_for_ranges(records_.size() - first_new, records_per_task, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = first_new + begin; i < first_new + end; ++i) {
            const std::optional<Residual> found = residual(static_cast<std::uint32_t>(i));
            const double allowed = static_cast<double>(max_residual * records_[i].irradiance);
            fails[i] = found && found->square > allowed * allowed + certain * found->variance;
        }
    });
    // Halve the reach of records that fail, and of those around them
    std::vector<std::uint8_t> shortens = fails;
    for (std::size_t i = first_new; i < records_.size(); ++i)
        if (fails[i] != 0)
            visit_near(records_[i].position, records_[i].normal, records_[i].patch,
                       [&](std::uint32_t k, float) { shortens[k] = 1; });
    if (std::none_of(shortens.begin(), shortens.end(), [](std::uint8_t s) { return s != 0; })) return;
    for (std::size_t i = 0; i < records_.size(); ++i) {
        Record& r = records_[i];
        if (shortens[i] == 0) continue;
        r.reach = std::max(r.reach / 2, std::min(r.reach, least_spacings * r.spacing));
        r.reach_elsewhere = std::min(r.reach_elsewhere, r.reach);
    }
    arrange_tree();
}

void IndirectField::estimate_bias() {
    std::vector<float> excess(records_.size(), 0);
    parallel_for_ranges(records_.size(), records_per_task, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            if (const std::optional<Residual> found = residual(static_cast<std::uint32_t>(i)))
                excess[i] = static_cast<float>(found->square - found->variance);
    });
    parallel_for_ranges(records_.size(), records_per_task, [&](std::size_t begin, std::size_t end) {
        for (Record& r : std::span(records_).subspan(begin, end - begin)) {
            double sum = 0, count = 0;
            visit_near(r.position, r.normal, r.patch, [&](std::uint32_t k, float) {
                sum += static_cast<double>(excess[k]);
                ++count;
            });
            r.squared_bias = count > 0 ? bias_of_points * std::max(0.0f, static_cast<float>(sum / count)) : 0;
        }
    });
}

void IndirectField::refine_noisy_records(const PathPlan& plan, const CommonStop& stop) {
    if (records_.empty() || stop.is_due()) return;
    pool_variances();
    const bool is_bake = !plan.start.camera;
    const float min_irradiance = min_share_of_mean * (is_bake ? geometric_mean_irradiance() : mean_irradiance());
    std::vector<float> needed(records_.size());
    for (std::size_t i = 0; i < records_.size(); ++i) {
        const Record& r = records_[i];
        const float deviation = std::sqrt(r.group_variance) / std::max(min_irradiance, r.irradiance);
        needed[i] = groups_per_deviation * effort_of(plan) * deviation * r.reach / r.spacing;
        if (is_bake) needed[i] = std::max(needed[i], square(deviation / baked_error(r.reach, r.spacing)));
    }
    // Each round doubles the number of groups of the noisy records.
    const std::size_t most = is_bake ? max_baked_groups : max_groups;
    for (std::size_t groups = least_groups(plan); groups < most; groups *= 2) {
        std::vector<std::uint32_t> noisy;
        for (std::uint32_t i = 0; i < records_.size(); ++i)
            if (needed[i] > static_cast<float>(groups)) noisy.push_back(i);
        if (noisy.empty()) return;
        if (gather(plan, noisy, groups, stop)) return;
    }
}

float IndirectField::mean_irradiance() const {
    double sum = 0;
    for (const Record& r : records_) sum += static_cast<double>(r.irradiance);
    return static_cast<float>(sum / static_cast<double>(records_.size()));
}

float IndirectField::geometric_mean_irradiance() const {
    double sum = 0, lit = 0;
    for (const Record& r : records_)
        if (r.irradiance > 0) {
            sum += std::log(static_cast<double>(r.irradiance));
            ++lit;
        }
    return lit > 0 ? static_cast<float>(std::exp(sum / lit)) : 0;
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

float IndirectField::Reach::relative_distance2(const V3f& x, const V3f& n, std::uint32_t of_patch) const {
    constexpr float min_cosine = 0.97f;  // between the normals, 14 degrees at most
    constexpr float height_factor =
        10;  // weight of distances along the normal, because light differs on parallel surfaces
    const float cosine = normal.dot(n);
    if (cosine <= min_cosine) return 1;
    const V3f d = position - x;
    const float height = height_factor * d.dot(n);
    return (d.length2() + height * height) * (of_patch == patch ? inverse_square : inverse_square_elsewhere) +
           (1 - cosine) / (1 - min_cosine);
}

IndirectField::Fit IndirectField::fit_at(const V3f& x, const V3f& n, PatchIndex patch, std::uint32_t omitted) const {
    const TangentFrame frame(n);
    Fit fit;
    float least = 1;
    visit_near(x, n, patch, [&](std::uint32_t i, float distance2) {
        if (i == omitted) return;
        const Record& r = records_[i];
        const V3f d = r.position - x;
        fit.values.add((1 - distance2) * (1 - distance2), d.dot(frame.s), d.dot(frame.t), Rgb(r.gathered.mean),
                       r.variance());
        if (distance2 < least) {
            least = distance2;
            fit.nearest = i;
        }
    });
    return fit;
}

std::optional<IndirectField::Light> IndirectField::at(const V3f& x, const V3f& n, PatchIndex patch) const {
    constexpr float min_weight = 0.01f;  // smaller weights occur at the end of a single record's reach
    const Fit fit = fit_at(x, n, patch);
    if (!(fit.values.weight() > min_weight)) return std::nullopt;
    const float squared_error = std::max(0.0f, fit.values.variance()) + records_[fit.nearest].squared_bias;
    return Light{fit.values.value(), std::sqrt(squared_error), records_[fit.nearest].reach, fit.nearest};
}

}  // namespace interflect::detail
