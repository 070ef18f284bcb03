#include "interflect/render/paths/indirect_field.h"

#include <ImathBoxAlgo.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "interflect/base/numbers/points.h"
#include "interflect/base/numbers/random.h"
#include "interflect/base/threads/parallel.h"
#include "interflect/base/threads/shared_ranges.h"
#include "interflect/geometry/textures/tangent_frame.h"
#include "interflect/render/lights/path_samples.h"
#include "interflect/render/paths/path_integrator.h"
#include "interflect/render/reflections/known_light.h"

namespace interflect::detail {

namespace {

/// Number of paths of a group. The difference between the two halves of a group estimates the error of its record.
constexpr std::size_t paths_per_group = 16;
/// Limits of the number of groups of a record at full effort (effort_of()): 128 to 1,024 paths.
constexpr std::size_t full_least_groups = 8, max_groups = 64;
/// Number of paths of a record for each ray to an element that KnownLight::sample() chooses. The value 2 takes 0.89 to
/// 0.97 of the time of 1 in five scenes, with equal errors. With 4, the error in blocks of 9 pixels is up to 1.05 times
/// as large.
constexpr std::uint32_t record_paths_per_place = 2;

/// The number of groups of a record is groups_per_deviation x (sigma / E) x (reach / spacing). Here sigma is the
/// standard deviation of a group, and E the irradiance at the record. This number minimises the squared error of the
/// picture per ray (Neyman allocation), because a record affects all pixels in its reach.
///
/// Measured in four scenes with 3 M rays, relative to the value 8. The error is that of blocks of 9 pixels.
///
///     groups_per_deviation    4             8    16
///     squared error           1.2 to 1.5    1    0.64 to 0.82
///     processor time                        1    1.01 to 1.29
constexpr float groups_per_deviation = 12;
/// Lower limit of E in sigma / E, relative to the mean E of all records. Bakes use the geometric mean, so that a sunlit
/// ground does not hide the noise of rooms.
constexpr float min_share_of_mean = 0.25f;
/// Pictures with fewer samples than this gather fewer groups, too, to balance the noise of pixels and of records.
constexpr float full_effort_samples = 8;

/// Reach of a record, relative to the harmonic mean length of its rays. With 0.35, errors are 1.1 to 1.8 times as
/// large, even with 512 paths per record.
constexpr float reach_over_length = 0.15f;
/// Factor of distances along the normal, because light differs between parallel surfaces.
constexpr float height_factor = 10;
/// Minimum cosine of the angle between the normals of a point and a record in reach: 14 degrees.
constexpr float min_cosine = 0.97f;
/// Limits of the reach, in spacings of the points. With a minimum of 8, the indirect light of a room is 0.3% darker in
/// a picture of 160 x 90 pixels.
constexpr float min_spacings = 4, max_spacings = 100;
/// A record and its neighbours halve their reach if the record differs from the fit of its neighbours by more than this
/// share of all irradiance.
constexpr float max_residual = 0.1f;
/// Lower limits of a halved reach, in spacings: in pictures, and in bakes.
constexpr float min_halved_spacings = 2, min_baked_spacings = 1;
/// In bakes, the reach may be less than min_spacings, because texels may be as wide as the gap beside a ball on the
/// floor. It is at least this share of the harmonic mean length of the rays. Factor by which irradiance is too high 5
/// to 10 cm from the contact of a ball, at 20 texels per metre, in gauges that do not gather their own light:
///
///     min_baked_reach_over_length    1       0.5     0.25    reach >= min_spacings
///     ball of radius 0.2 m           1.09    1.07    1.09    1.17
///     0.13 m, in another room        1.16    1.15    1.13    1.21
constexpr float min_baked_reach_over_length = 0.5f;

/// A filtered gauge gathers its own light if the harmonic mean length of its rays is less than this [spacings]. Rays
/// that escape count as infinitely long. Errors of texels, 20 per metre, against Mitsuba 3 (experiments/run texels):
///
///     own_length                                 0       2
///     office.mgf, RMS without the worst 1%       11.6    5.2%
///     office.mgf, 99th percentile                118     38%
///     open crate of boards, RMS                  22      4.5%
constexpr float own_length = 2;
/// Reach of such a record [spacings]. Records within it share their variance and directions to the sky, and gauges
/// without a record of their own interpolate from it.
constexpr float own_reach = 2;
/// Standard error of such a record, relative to its irradiance. The noise is filtered later: with 0.1, the error of
/// texels of office.mgf is the same, in 1.4 times the time.
constexpr float max_own_error = 0.2f;
/// Standard error of a record of a bake, relative to its irradiance. Records of short reach may exceed it
/// (baked_error()). With 10%, bakes of two rooms take 0.63 and 0.97 of the time, but walls that only lamps light are
/// visibly blotchy.
constexpr float max_baked_error = 0.05f;
/// Maximum number of groups of a record of a bake.
constexpr std::size_t max_baked_groups = 256;

/// Squared error of interpolation at a point, relative to the squared error at a record that is interpolated from its
/// neighbours. Errors fall at least in proportion to the distance, and a point is half as far from the next record as
/// that record is from its neighbours: (1/2)^2.
constexpr float point_bias_over_record_bias = 0.25f;
/// Minimum sum of the weights of neighbours for a fit that predicts a record.
constexpr float min_neighbour_weight = 0.3f;
/// A point is covered if the weights of the records around it, at most 1 each, have at least this sum.
constexpr float covering_weight = 1.5f;

constexpr std::size_t points_of_first_round = 256;  // the total doubles with each round
constexpr std::size_t points_per_task = 1024, records_per_task = 64, groups_per_task = 128;
/// Number of groups that each rank gathers between two checks for a stop. One thread gathers them in some seconds.
constexpr std::size_t groups_of_rank = 1 << 16;

/// Returns the number of groups relative to full effort, at most 1. Bakes have full effort. Pictures with a target
/// error have full effort, too, because their error includes that of records.
float effort_of(const PathPlan& plan) {
    const bool is_full = !plan.start.camera || plan.options.until > 0;
    return is_full ? 1 : std::min(1.0f, static_cast<float>(plan.options.samples) / full_effort_samples);
}
/// Returns the minimum number of groups of a record. In pictures of two samples per pixel, a quarter of
/// full_least_groups has 1.17 times the squared error in 0.67 of the time.
std::size_t least_groups(const PathPlan& plan) {
    constexpr float fewest = 2;
    return static_cast<std::size_t>(std::max(fewest, effort_of(plan) * static_cast<float>(full_least_groups)));
}

/// Returns the reach of a new record [m]. @param length  Harmonic mean length of its rays; 0: no ray hit a surface.
float initial_reach(const PathPlan& plan, float length, float spacing) {
    const float max_reach = max_spacings * spacing;
    if (!(length > 0)) return max_reach;
    float min_reach = min_spacings * spacing;
    const bool is_bake = !plan.start.camera;
    if (is_bake) min_reach = std::clamp(min_baked_reach_over_length * length, min_baked_spacings * spacing, min_reach);
    return std::clamp(reach_over_length * length, min_reach, max_reach);
}
/// Returns the target for the standard error of a record of a bake, relative to its irradiance. For a reach of one
/// texel, the target is twice max_baked_error, because then an area averages the errors of more records.
float baked_error(float reach, float spacing) {
    return max_baked_error * std::sqrt(std::max(1.0f, min_spacings * spacing / reach));
}

float square(float x) { return x * x; }

/// Returns 1 for each point whose rays are so short that light may vary within its gauge.
std::vector<std::uint8_t> find_close_points(const PathPlan& plan, std::span<const SurfacePoint> points, Ranks* ranks) {
    constexpr std::size_t rays_per_point = 16;
    std::vector<std::uint8_t> is_close(points.size(), 0);
    parallel_for_own_ranges(ranks, points.size(), points_per_task, [&](std::size_t begin, std::size_t end) {
        std::vector<Ray> rays;
        PointBlock numbers;
        for (std::size_t i = begin; i < end; ++i) {
            fill_points(PointSet::sobol, mix(plan.options.seed, i), 0, rays_per_point, numbers);
            for (std::size_t k = 0; k < rays_per_point; ++k)
                rays.push_back({points[i].position, cosine_direction(points[i].normal, numbers.coordinate[0][k],
                                                                     numbers.coordinate[1][k])});
        }
        std::vector<Hit> hits(rays.size());
        plan.scene.ray_caster.trace(rays, hits);
        for (std::size_t i = begin; i < end; ++i) {
            float inverse_sum = 0;
            for (std::size_t k = 0; k < rays_per_point; ++k) {
                const Hit& hit = hits[(i - begin) * rays_per_point + k];
                if (hit.patch != none) inverse_sum += 1 / hit.distance;
            }
            is_close[i] =
                plan.start.gauges[i].is_filtered && inverse_sum * own_length * points[i].spacing > rays_per_point;
        }
    });
    collect_ranges(ranks, std::span(is_close), points_per_task, Destination::all_ranks);
    return is_close;
}

V3f nearest_on(const Contact& contact, const V3f& x) {
    const V3f along = contact.b - contact.a;
    const float length2 = along.length2();
    if (!(length2 > 0)) return contact.a;
    return contact.a + along * std::clamp((x - contact.a).dot(along) / length2, 0.0f, 1.0f);
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

/// Lengths of the rays of a record.
struct RayLengths {
    float inverse_sum = 0, hits = 0;  // sums of FirstHit::inverse_length [1/m] and FirstHit::hits over the paths

    /// Returns the harmonic mean length of the rays that hit a surface [m]; 0 without hits.
    float harmonic_mean() const { return hits > 0 ? hits / inverse_sum : 0; }
};

/// Light that a group of paths has gathered for a record.
struct GatheredGroup {
    std::uint32_t record = 0;
    bool is_done = false;  // false after a stop
    RayLengths lengths{};
    std::array<RgbD, 2> indirect{};  // sums over the paths of each half
    std::int64_t rays = 0;           // the first group of a task counts the rays of all its groups
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
            FirstHit first = b.first[0];
            first += b.first[1];
            groups[i] = {.record = b.pixel,
                         .is_done = b.done,
                         .lengths = {static_cast<float>(first.inverse_length), static_cast<float>(first.hits)},
                         .indirect = {b.halves[0].indirect, b.halves[1].indirect}};
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
    if (!plan.start.camera && add_own_records(plan, points, stop)) return;
    cover(plan, points, monitor, stop);
    refine_noisy_records(plan, stop);
    pool_variances();
    estimate_bias();
}

bool IndirectField::add_own_records(const PathPlan& plan, std::span<const SurfacePoint> points,
                                    const CommonStop& stop) {
    const std::vector<std::uint8_t> is_close = find_close_points(plan, points, stop.ranks());
    own_records_.assign(points.size(), none);
    std::vector<std::uint32_t> added;
    for (std::uint32_t i = 0; i < points.size(); ++i) {
        if (is_close[i] == 0) continue;
        const SurfacePoint& p = points[i];
        own_records_[i] = static_cast<std::uint32_t>(records_.size());
        added.push_back(own_records_[i]);
        records_.push_back({.position = p.position,
                            .normal = p.normal,
                            .patch = p.patch,
                            .gauge = i,
                            .spacing = p.spacing,
                            .reach = own_reach * p.spacing});
        records_.back().reach_elsewhere = distance_to_contact(p.position, records_.back().reach);
    }
    if (gather(plan, added, least_groups(plan), stop)) return true;
    for (Record& r : records_) set_irradiance(plan, r);
    arrange_tree();
    return false;
}

void IndirectField::cover(const PathPlan& plan, std::span<const SurfacePoint> all_points, const Monitor& monitor,
                          const CommonStop& stop) {
    std::vector<SurfacePoint> points;
    for (std::uint32_t i = 0; i < all_points.size(); ++i)
        if (own_record(i) == none) points.push_back(all_points[i]);
    const std::vector<std::uint32_t> order = shuffled(points.size(), plan.options.seed);
    for (std::size_t begin = 0, end = 0; begin < points.size(); begin = end) {
        end = std::min(points.size(), std::max(points_of_first_round, 2 * begin));
        std::vector<SurfacePoint> candidates;
        for (std::size_t i = begin; i < end; ++i) candidates.push_back(points[order[i]]);
        const std::size_t first_new = records_.size();
        if (stop.is_due() || add_records(plan, uncovered_among(candidates, stop.ranks()), stop)) return;
        shorten_reaches(plan, first_new);
        // Rough share of the time: later rounds add fewer records per point
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

std::vector<SampleBatch> IndirectField::next_groups(std::span<const std::uint32_t> chosen, std::size_t groups) const {
    // Each group is a batch, which continues the sequences of the record's earlier groups
    constexpr std::uint32_t half_size = paths_per_group / 2;
    std::vector<SampleBatch> batches;
    for (const std::uint32_t i : chosen)
        for (std::uint32_t group = 0; group < groups; ++group)
            batches.push_back(
                {.pixel = i, .first_index = (records_[i].gathered.groups + group) * half_size, .half_size = half_size});
    return batches;
}

bool IndirectField::gather(const PathPlan& plan, std::span<const std::uint32_t> chosen, std::size_t groups,
                           const CommonStop& stop, std::vector<float>* mean_lengths) {
    // Start paths at the records, which are gauges
    std::vector<Gauge> gauges;
    for (const Record& r : records_)
        gauges.push_back(r.gauge == none ? Gauge{.position = r.position, .normal = r.normal}
                                         : plan.start.gauges[r.gauge]);
    PathStart start;
    start.gauges = gauges;
    const PathPlan gathering{.scene = plan.scene,
                             .start = start,
                             .options = plan.options,
                             .has_direct = false,
                             .seen_sources = plan.seen_sources,
                             .known = plan.known,
                             .paths_per_place = record_paths_per_place};
    // For pictures of irradiance, paths return irradiance. Otherwise, they return the radiance L of a white gauge,
    // whose irradiance is pi L.
    const double irradiance_over_light = plan.shows_irradiance() ? 1 : std::numbers::pi;
    const double per_path = irradiance_over_light / paths_per_group;
    const std::size_t ranks = stop.ranks() ? stop.ranks()->count() : 1;
    const std::size_t at_once = std::max<std::size_t>(1, groups_of_rank * ranks / groups);
    std::vector<RayLengths> lengths(records_.size());
    bool is_stopped = false;
    for (std::size_t first = 0; first < chosen.size() && !is_stopped; first += at_once) {
        std::vector<SampleBatch> batches =
            next_groups(chosen.subspan(first, std::min(at_once, chosen.size() - first)), groups);
        for (const GatheredGroup& group : gather_groups(gathering, batches, stop)) {
            rays_ += group.rays;
            if (!group.is_done) continue;
            Record& r = records_[group.record];
            r.gathered.add((group.indirect[0] + group.indirect[1]) * per_path);
            r.half_difference += mean_channel(group.indirect[0] - group.indirect[1]) * per_path;
            lengths[group.record].inverse_sum += group.lengths.inverse_sum;
            lengths[group.record].hits += group.lengths.hits;
        }
        is_stopped = stop.is_due();
    }
    if (mean_lengths)
        for (const std::uint32_t i : chosen) mean_lengths->push_back(lengths[i].harmonic_mean());
    return is_stopped;
}

bool IndirectField::add_records(const PathPlan& plan, std::span<const SurfacePoint> points, const CommonStop& stop) {
    const std::size_t old_count = records_.size();
    for (const SurfacePoint& p : points)
        records_.push_back({.position = p.position, .normal = p.normal, .patch = p.patch, .spacing = p.spacing});
    std::vector<std::uint32_t> added(points.size());
    std::iota(added.begin(), added.end(), static_cast<std::uint32_t>(old_count));
    std::vector<float> mean_lengths;
    if (gather(plan, added, least_groups(plan), stop, &mean_lengths)) {
        records_.resize(old_count);  // the new records have no reach yet
        return true;
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
        Record& r = records_[old_count + i];
        r.reach = initial_reach(plan, mean_lengths[i], r.spacing);
        r.reach_elsewhere = distance_to_contact(r.position, r.reach);
        set_irradiance(plan, r);
    }
    arrange_tree();
    return false;
}

void IndirectField::set_irradiance(const PathPlan& plan, Record& r) {
    r.irradiance = luminance(Rgb(r.gathered.mean));
    if (r.patch == none) return;
    const Rgb& known_irradiance = plan.known->irradiance(plan.known->place(r.patch, r.position));
    r.irradiance = std::max(r.irradiance, luminance(known_irradiance));
}

void IndirectField::arrange_tree() {
    std::vector<Boxed> boxes(records_.size());
    for (std::uint32_t i = 0; i < records_.size(); ++i) boxes[i] = {box_of_reach(records_[i]), i};
    arrange_box_tree(boxes);  // near records become neighbours in memory
    reaches_.resize(records_.size());
    for (std::uint32_t i = 0; i < records_.size(); ++i) {
        const Record& r = records_[boxes[i].index];
        reaches_[i] = {.position = r.position,
                       .normal = r.normal,
                       .patch = r.patch,
                       .inverse_square = 1 / (r.reach * r.reach),
                       .inverse_square_elsewhere = 1 / (r.reach_elsewhere * r.reach_elsewhere),
                       .record = boxes[i].index};
        boxes[i] = {box_of_reach(r), i};
    }
    tree_ = WideBoxTree(std::move(boxes));
}

/// Outside of this box, Reach::relative_distance2() is at least 1.
Imath::Box3f IndirectField::box_of_reach(const Record& record) {
    // With d the distance and c the cosine between the normals, the height above the record's plane is at most
    // reach / height_factor + d sqrt(1 - c^2), and d at most reach sqrt(1 - (1 - c) / (1 - min_cosine)). So the second
    // term is at most reach sqrt((1 - min_cosine) / 2).
    const float height = 1 / height_factor + std::sqrt((1 - min_cosine) / 2);
    V3f half_size;
    for (int axis = 0; axis < 3; ++axis) {
        const float n = std::min(1.0f, std::abs(record.normal[axis]));
        half_size[axis] = record.reach * (std::sqrt(1 - n * n) + n * height);
    }
    return {record.position - half_size, record.position + half_size};
}

void IndirectField::pool_variances() {
    // The mean (a + b) / 2 of the halves a and b of a record has the variance ((a - b) / 2)^2. The variance of a group
    // is this times the number of groups.
    const auto variance_of_group = [](const Record& r) {
        const double groups = r.gathered.groups, half_difference = r.half_difference / groups;
        return half_difference * half_difference * groups;
    };
    std::vector<float> pooled(records_.size());
    parallel_for_ranges(records_.size(), records_per_task, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            double sum = 0, count = 0;
            visit_near(records_[i].position, records_[i].normal, records_[i].patch, [&](std::uint32_t k, float) {
                sum += variance_of_group(records_[k]);
                ++count;
            });
            pooled[i] = static_cast<float>(count > 0 ? sum / count : variance_of_group(records_[i]));
        }
    });
    for (std::size_t i = 0; i < records_.size(); ++i) records_[i].group_variance = pooled[i];
}

std::optional<IndirectField::Residual> IndirectField::residual(std::uint32_t i) const {
    const Record& r = records_[i];
    if (r.gauge != none) return {};
    const Fit fit = fit_at(r.position, r.normal, r.patch, i);
    if (!(fit.values.weight() > min_neighbour_weight)) return {};
    const double difference = mean_channel(RgbD(fit.values.value()) - r.gathered.mean);
    return Residual{difference * difference, static_cast<double>(fit.values.variance() + r.variance())};
}

std::vector<std::uint8_t> IndirectField::find_misfits(std::size_t first_new) const {
    constexpr double max_variances = 4;  // square of two standard errors
    std::vector<std::uint8_t> is_misfit(records_.size(), 0);
    parallel_for_ranges(records_.size() - first_new, records_per_task, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = first_new + begin; i < first_new + end; ++i) {
            const std::optional<Residual> found = residual(static_cast<std::uint32_t>(i));
            const double allowed = static_cast<double>(max_residual * records_[i].irradiance);
            is_misfit[i] = found && found->square > allowed * allowed + max_variances * found->variance;
        }
    });
    return is_misfit;
}

void IndirectField::shorten_reaches(const PathPlan& plan, std::size_t first_new) {
    pool_variances();
    const std::vector<std::uint8_t> is_misfit = find_misfits(first_new);
    if (std::none_of(is_misfit.begin(), is_misfit.end(), [](std::uint8_t misfit) { return misfit != 0; })) return;
    std::vector<std::uint8_t> is_shortened = is_misfit;
    for (std::size_t i = first_new; i < records_.size(); ++i)
        if (is_misfit[i] != 0)
            visit_near(records_[i].position, records_[i].normal, records_[i].patch,
                       [&](std::uint32_t k, float) { is_shortened[k] = 1; });
    const float least_spacings = plan.start.camera ? min_halved_spacings : min_baked_spacings;
    for (std::size_t i = 0; i < records_.size(); ++i) {
        if (is_shortened[i] == 0) continue;
        Record& r = records_[i];
        const float least_reach = std::min(r.reach, least_spacings * r.spacing);
        r.reach = std::max(r.reach / 2, least_reach);
        r.reach_elsewhere = std::min(r.reach_elsewhere, r.reach);
    }
    arrange_tree();
}

void IndirectField::estimate_bias() {
    std::vector<float> bias(records_.size(), 0);  // squared difference from the neighbours, without noise
    parallel_for_ranges(records_.size(), records_per_task, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            if (const std::optional<Residual> found = residual(static_cast<std::uint32_t>(i)))
                bias[i] = static_cast<float>(found->square - found->variance);
    });
    parallel_for_ranges(records_.size(), records_per_task, [&](std::size_t begin, std::size_t end) {
        for (Record& r : std::span(records_).subspan(begin, end - begin)) {
            double sum = 0, count = 0;
            visit_near(r.position, r.normal, r.patch, [&](std::uint32_t k, float) {
                sum += static_cast<double>(bias[k]);
                ++count;
            });
            const float record_bias = count > 0 ? std::max(0.0f, static_cast<float>(sum / count)) : 0;
            r.squared_bias = point_bias_over_record_bias * record_bias;
        }
    });
}

std::vector<float> IndirectField::needed_groups(const PathPlan& plan) const {
    const bool is_bake = !plan.start.camera;
    const float min_irradiance = min_share_of_mean * (is_bake ? geometric_mean_irradiance() : mean_irradiance());
    std::vector<float> needed;
    for (const Record& r : records_) {
        const float deviation = std::sqrt(r.group_variance) / std::max(min_irradiance, r.irradiance);
        if (r.gauge != none) {
            needed.push_back(square(deviation / max_own_error));
            continue;
        }
        const float for_picture = groups_per_deviation * effort_of(plan) * deviation * r.reach / r.spacing;
        const float for_error = is_bake ? square(deviation / baked_error(r.reach, r.spacing)) : 0;
        needed.push_back(std::max(for_picture, for_error));
    }
    return needed;
}

void IndirectField::refine_noisy_records(const PathPlan& plan, const CommonStop& stop) {
    if (records_.empty() || stop.is_due()) return;
    pool_variances();
    const std::vector<float> needed = needed_groups(plan);
    // Each round doubles the number of groups of the noisy records.
    const std::size_t most = plan.start.camera ? max_groups : max_baked_groups;
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
    const float cosine = normal.dot(n);
    if (cosine <= min_cosine) return 1;
    const V3f d = position - x;
    const float height = height_factor * d.dot(n);
    const float by_distance =
        (d.length2() + height * height) * (of_patch == patch ? inverse_square : inverse_square_elsewhere);
    const float by_normal = (1 - cosine) / (1 - min_cosine);
    return by_distance + by_normal;
}

IndirectField::Fit IndirectField::fit_at(const V3f& x, const V3f& n, PatchIndex patch, std::uint32_t omitted) const {
    const TangentFrame frame(n);
    Fit fit;
    float least_distance2 = 1;
    visit_near(x, n, patch, [&](std::uint32_t i, float distance2) {
        const Record& r = records_[i];
        if (i == omitted) return;
        const V3f d = r.position - x;
        const float weight = (1 - distance2) * (1 - distance2);  // falls smoothly to 0 at the end of the reach
        fit.values.add(weight, d.dot(frame.s), d.dot(frame.t), Rgb(r.gathered.mean), r.variance());
        if (distance2 < least_distance2) {
            least_distance2 = distance2;
            fit.nearest = i;
        }
    });
    return fit;
}

IndirectField::OwnLight IndirectField::own_light(std::uint32_t record) const {
    const Record& r = records_[record];
    const double difference = r.half_difference / std::max(1u, r.gathered.groups), mean = mean_channel(r.gathered.mean);
    const double relative = mean > 0 ? difference / mean : 0;
    return {.irradiance = Rgb(r.gathered.mean),
            .halves = {Rgb(r.gathered.mean * (1 + relative)), Rgb(r.gathered.mean * (1 - relative))},
            .squared_error = r.variance()};
}

std::optional<IndirectField::Light> IndirectField::at(const V3f& x, const V3f& n, PatchIndex patch) const {
    constexpr float min_weight = 0.01f;  // smaller weights occur at the end of a single record's reach
    const Fit fit = fit_at(x, n, patch);
    if (!(fit.values.weight() > min_weight)) return std::nullopt;
    const float squared_error = std::max(0.0f, fit.values.variance()) + records_[fit.nearest].squared_bias;
    return Light{.irradiance = fit.values.value(),
                 .error = std::sqrt(squared_error),
                 .reach = records_[fit.nearest].reach,
                 .record = fit.nearest};
}

}  // namespace interflect::detail
