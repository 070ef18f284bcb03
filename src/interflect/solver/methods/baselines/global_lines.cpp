#include <ImathBox.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <vector>

#include "interflect/base/files/state_archive.h"
#include "interflect/base/numbers/fixed_point.h"
#include "interflect/base/numbers/points.h"
#include "interflect/base/numbers/random.h"
#include "interflect/base/threads/parallel.h"
#include "interflect/elements/forest.h"
#include "interflect/geometry/textures/tangent_frame.h"
#include "interflect/raycast/panes.h"
#include "interflect/solver/methods/passes.h"

namespace interflect::detail {

namespace {

constexpr std::size_t lines_per_task = PointBlock::capacity;

/// Maximum mean number of deposits of a line on one patch that the fixed-point sums can hold. A line crosses a flat
/// patch once; each pane and each one-sided face behind it adds a deposit.
constexpr double most_deposits_per_line = 0x1p8;

/// Sphere around the scene; lines are uniform in it.
struct LineDomain {
    V3f centre;
    float radius;

    explicit LineDomain(const Scene& scene) {
        Imath::Box3f box;
        for (const V3f& v : scene.vertices) box.extendBy(v);
        centre = box.center();
        float square = 0;
        for (const V3f& v : scene.vertices) square = std::max(square, (v - centre).length2());
        constexpr float margin = 1.0001f;  // exceeds rounding errors
        radius = margin * std::sqrt(square);
    }
    /// Area of the disk of lines in each direction [m^2].
    double cross_section() const {
        return std::numbers::pi * static_cast<double>(radius) * static_cast<double>(radius);
    }
};

/// Part of a line between two patches.
struct LineSegment {
    PatchIndex from;  ///< Patch that the line hits. Its light travels back along the line.
    PatchIndex to;    ///< Patch that receives this light; `none` if the light escapes.
    bool is_mutual;   ///< Whether `to` also sees `from`; false if a one-sided face between them faces `from` only.
};

/// Lines that a thread traces together.
struct LineBundle {
    PointBlock points;
    std::vector<Ray> lines, reversed_lines;
    std::vector<PatchIndex> crossed;  ///< The patch that each line crossed last.
    std::vector<float> slack;         ///< Error of the distance to `crossed` [m]; infinite before the first crossing.
    std::vector<Hit> hits, reversed_hits;
    std::vector<float> mutual_limit;  ///< A reversed hit beyond this distance has passed a one-sided face [m].
    std::vector<LineSegment> segments;
    std::vector<Panes::HitBehind> behind;
};

void make_lines(const LineDomain& domain, PointSet set, std::uint64_t key, std::uint64_t first, LineBundle& bundle) {
    fill_points(set, key, first, bundle.lines.size(), bundle.points);
    bundle.slack.assign(bundle.lines.size(), std::numeric_limits<float>::infinity());
    bundle.crossed.assign(bundle.lines.size(), no_patch);
    const auto& [a, b, c, d] = bundle.points.coordinate;
    constexpr float turn = 2 * std::numbers::pi_v<float>;
    for (std::size_t i = 0; i < bundle.lines.size(); ++i) {
        const float z = 1 - 2 * a[i], across = std::sqrt(std::max(0.0f, 1 - z * z));
        const V3f direction(across * std::cos(turn * b[i]), across * std::sin(turn * b[i]), z);
        const TangentFrame frame(direction);
        const float r = std::sqrt(c[i]);
        const V3f offset = frame.s * (r * std::cos(turn * d[i])) + frame.t * (r * std::sin(turn * d[i]));
        bundle.lines[i] = {domain.centre + domain.radius * (offset - direction), direction};
    }
}

/// Advances lines to the next patch that faces them, and traces back. Drops lines that escape or hit the same patch by
/// rounding.
void find_segments(const ElementForest& forest, const RayCaster& ray_caster, const Panes& panes, LineBundle& bundle) {
    // Both directions of a line start a ray offset above their patches; the other factor 2 is a margin for rounding.
    constexpr float slack_in_offsets = 4;
    bundle.segments.clear();
    bundle.reversed_lines.clear();
    bundle.hits.resize(bundle.lines.size());
    bundle.mutual_limit.resize(bundle.lines.size());
    ray_caster.trace(bundle.lines, bundle.hits);
    for (std::size_t i = 0; i < bundle.lines.size(); ++i) {
        const auto [patch, distance] = bundle.hits[i];
        if (patch == none || patch == bundle.crossed[i]) continue;
        const V3f direction = bundle.lines[i].direction;
        const PatchGeometry& geometry = forest.geometry(patch);
        // The error of the hit may exceed the ray offset.
        const V3f x = geometry.point(geometry.parameters_of(bundle.lines[i].origin + distance * direction));
        const V3f offset = ray_caster.ray_offset(patch) * geometry.normal();
        const std::size_t kept = bundle.segments.size();
        bundle.reversed_lines.push_back({x + offset, -direction});
        bundle.lines[kept] = {x - offset, direction};
        bundle.mutual_limit[kept] = distance + bundle.slack[i];
        bundle.slack[kept] =
            slack_in_offsets * ray_caster.ray_offset(patch) / std::abs(geometry.normal().dot(direction));
        bundle.crossed[kept] = patch;
        bundle.segments.push_back({patch, no_patch, true});
    }
    bundle.lines.resize(bundle.segments.size());
    bundle.reversed_hits.resize(bundle.segments.size());
    ray_caster.trace(bundle.reversed_lines, bundle.reversed_hits);
    panes.trace(bundle.reversed_lines, bundle.reversed_hits, bundle.behind);
    for (std::size_t i = 0; i < bundle.segments.size(); ++i) {
        const auto [patch, distance] = bundle.reversed_hits[i];
        bundle.segments[i].to = patch;
        bundle.segments[i].is_mutual = patch != no_patch && distance <= bundle.mutual_limit[i];
    }
}

class LineSums {
  public:
    /// @param power_per_radiosity  Power along a segment per unit of radiosity [m^2].
    LineSums(const ElementForest& forest, const Radiosity& light, double power_per_radiosity, std::int64_t lines)
        : power_per_radiosity_(power_per_radiosity), power_(0), square_(0) {
        double brightest = 0;
        for (PatchIndex i{0}; i < forest.patch_count(); ++i) {
            radiosity_.push_back(light.of(forest, i));
            brightest = std::max(brightest, static_cast<double>(largest_channel(radiosity_[i])));
        }
        const double most = most_deposits_per_line * static_cast<double>(lines) * power_per_radiosity * brightest;
        power_ = FixedPoint(most);
        square_ = FixedPoint(most * power_per_radiosity * brightest);
        received_.resize(radiosity_.size());
        squares_.resize(radiosity_.size(), 0);
        started_.resize(radiosity_.size(), 0);
        escaped_.resize(radiosity_.size());
        escaped_rays_.resize(radiosity_.size(), 0);
    }

    /// Lines of both directions sample a mutual exchange. Lines of one direction sample other exchanges, which count
    /// twice.
    void add(const LineSegment& segment) {
        add_concurrently(started_[segment.from], 1);
        add_power(segment.from, segment.to, Rgb(segment.is_mutual ? 1.0f : 2.0f));
        if (!segment.is_mutual) return;
        add_concurrently(started_[segment.to], 1);
        add_power(segment.to, segment.from, Rgb(1));
    }
    /// Adds the light behind a pane in one direction, as the pane may be one-sided; so it counts twice.
    void add(const LineSegment& segment, const Panes::HitBehind& behind) {
        add_power(segment.from, behind.hit.patch, 2.0f * behind.transmittance);
    }

    Received received(const ElementForest& forest) const {
        Received r;
        for (PatchIndex i{0}; i < received_.size(); ++i) {
            const double area = forest.area(i);
            const RgbD arrived = power_.to_colour(received_[i]);
            const RgbD lost = power_.to_colour(escaped_[i]);
            r.irradiance.emplace_back(arrived / area);
            r.variance.push_back(static_cast<float>(square_.to_number(squares_[i]) / (area * area)));
            r.escaped_power += lost;
            r.shot_power += arrived + lost;
            if (channel_sum(radiosity_[i]) > 0) r.escaped_rays += escaped_rays_[i];  // rays of dark walls do not count
        }
        return r;
    }
    const std::vector<std::int64_t>& started() const { return started_; }

  private:
    /// Adds the power from one patch to another.
    /// @param to      May be `none`.
    /// @param factor  Transmittance, times 1 for a mutual exchange or 2 for an exchange in one direction.
    void add_power(PatchIndex from, PatchIndex to, const Rgb& factor) {
        const RgbD power = RgbD(radiosity_[from]) * RgbD(factor) * power_per_radiosity_;
        if (to == no_patch) {
            add_concurrently(escaped_[from], power_.from(power));
            add_concurrently(escaped_rays_[from], 1);
            return;
        }
        const double y = luminance(power);
        add_concurrently(received_[to], power_.from(power));
        add_concurrently(squares_[to], square_.from(y * y));
    }

    double power_per_radiosity_;
    std::vector<Rgb> radiosity_;
    FixedPoint power_, square_;
    std::vector<FixedPoint::Value> received_, escaped_;
    std::vector<std::int64_t> squares_, started_, escaped_rays_;
};

/// Passes with global lines (Sbert 1993, 1997; docs/method/method.md).
class GlobalLines final : public Passes {
  public:
    explicit GlobalLines(const SolverState& state)
        : domain_(state.inputs.scene), panes_(state.inputs.scene, state.inputs.ray_caster) {
        for (PatchIndex i{0}; i < state.light.forest->patch_count(); ++i)
            area_ += state.light.forest->area(i) * state.inputs.ray_caster.uncovered_share(i);
    }

  protected:
    Received trace_single_bounce(SolverState& state, TransportStep step) override {
        // In a sphere of cross section C, a line hits the front of surfaces of total area A on average A / (4 C) times.
        // Each of these hits takes two rays, and the escape a last one.
        const double rays_per_line = 1 + 2 * area_ / (4 * domain_.cross_section());
        const auto lines = std::max<std::int64_t>(1, std::llround(static_cast<double>(step.rays) / rays_per_line));
        const ElementForest& forest = *state.light.forest;
        // The share A / (2 C) of the lines crosses a patch of area A, from both sides; so each of these lines carries
        // 2 C / lines of its radiosity.
        LineSums sums(forest, step.light, 2 * domain_.cross_section() / static_cast<double>(lines), lines);
        // Each bounce has a new key, because products of dependent bounces would be biased.
        const std::uint64_t key =
            mix(mix(state.light.options().seed, line_purpose), state.sampling.streams.allocations);
        PerThread<LineBundle> bundles;
        std::atomic<bool> is_cut_short{false};
        const auto trace_some = [&](std::size_t begin, std::size_t end) {
            LineBundle& bundle = bundles.local();
            bundle.lines.resize(end - begin);
            make_lines(domain_, state.light.options().experimental.points, key, begin, bundle);
            // A line crosses each flat patch at most once; along curved ones it might never end.
            for (std::uint32_t crossings = 0; crossings < forest.patch_count() && !bundle.lines.empty(); ++crossings) {
                if (is_cut_short || state.work.stop.within_process().is_due()) {
                    is_cut_short = true;
                    return;
                }
                find_segments(forest, state.inputs.ray_caster, panes_, bundle);
                for (const LineSegment& segment : bundle.segments) sums.add(segment);
                for (const Panes::HitBehind& behind : bundle.behind) sums.add(bundle.segments[behind.ray], behind);
            }
        };
        parallel_for_ranges(static_cast<std::size_t>(lines), lines_per_task, state.work.stop.within_process(),
                            trace_some);
        if (is_cut_short) throw Interrupted();
        ++state.sampling.streams.allocations;
        Received received = sums.received(forest);
        state.rays.escaped += received.escaped_rays;
        state.sampling.streams.used.resize(forest.size());
        for (PatchIndex i{0}; i < forest.patch_count(); ++i)  // the method does not divide patches
            state.sampling.streams.used.add(i, static_cast<std::uint64_t>(sums.started()[i]));
        return received;
    }

  private:
    static constexpr std::uint64_t line_purpose = 0x6c696e6573;
    const LineDomain domain_;
    const Panes panes_;
    double area_ = 0;  // area that lines can hit [m^2]
};

}  // namespace

std::unique_ptr<IterationMethod> make_global_lines(SolverState& state) { return std::make_unique<GlobalLines>(state); }

}  // namespace interflect::detail
