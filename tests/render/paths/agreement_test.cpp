// Shadings and bakes against path tracing in rooms drawn from seeds: their proportions, reflectances, furniture, lamps
// and occluders were not chosen for any shading.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "interflect/base/numbers/random.h"
#include "interflect/measure.h"
#include "interflect/prepare.h"
#include "interflect/ray_caster.h"
#include "interflect/render.h"
#include "interflect/render/gauges/gauge_light.h"
#include "interflect/render/pictures/path_picture.h"
#include "interflect/solve.h"
#include "tests/support/scenes/scenes.h"
#include "tests/support/shadings.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;

constexpr std::uint64_t rooms = 20;
constexpr std::array<std::uint64_t, 3> seeds{1, 2, 3};
constexpr double deviations = 3.3;  // of a normal value, passed with a probability of 1e-3

/// Numbers drawn from a seed, one after the other.
class Numbers {
  public:
    explicit Numbers(std::uint64_t seed) : seed_(seed) {}
    float between(float low, float high) { return low + (high - low) * unit_float(random_words(seed_, next_++)[0]); }

  private:
    std::uint64_t seed_, next_ = 0;
};

struct Room {
    Scene scene;
    View view;
};

/// A room with boxes, a plate or slats below a luminous panel or a lamp, and in every fourth the sun through an opening
/// of the ceiling.
Room room(std::uint64_t seed) {
    Numbers n(seed);
    Room room;
    Scene& scene = room.scene;
    scene.objects = {""};
    const V3f size(n.between(3, 7), n.between(2.5f, 5), n.between(2.3f, 3.2f));
    const auto grey = [&](float low, float high) {
        return add_material(scene, Rgb(n.between(low, high), n.between(low, high), n.between(low, high)), Rgb(0));
    };
    const std::uint32_t floor = grey(0.1f, 0.5f), walls = grey(0.3f, 0.8f), ceiling = grey(0.6f, 0.85f);
    add_rectangle(scene, {0, 0, 0}, {size.x, 0, 0}, {0, size.y, 0}, floor, 2, 2);
    for (const float y : {0.0f, size.y})
        add_rectangle(scene, {0, y, 0}, {size.x, 0, 0}, {0, 0, size.z}, walls, 2, 1, true);
    for (const float x : {0.0f, size.x})
        add_rectangle(scene, {x, 0, 0}, {0, size.y, 0}, {0, 0, size.z}, walls, 2, 1, true);
    const bool has_sun = seed % 4 == 0;
    const float opening = has_sun ? n.between(0.8f, 1.6f) : 0;
    add_rectangle(scene, {opening, 0, size.z}, {size.x - opening, 0, 0}, {0, size.y, 0}, ceiling, 2, 1, true);

    const float u = n.between(0.3f, 0.5f) * size.x, v = n.between(0.3f, 0.6f) * size.y, top = size.z - 0.05f;
    if (has_sun) {
        const V3f direction(n.between(0.2f, 0.8f), n.between(-0.3f, 0.3f), -1);
        scene.luminaires.push_back({"sun", 0, DirectionalLight{direction.normalized(), Rgb(20'000), 0.01f}});
    } else if (seed % 4 == 1) {
        scene.luminaires.push_back({"lamp", 0, PointLight{{u + 0.43f, v + 0.2f, top - 0.1f}, Rgb(400)}});
    } else {
        const std::uint32_t panel = add_material(scene, Rgb(0), Rgb(n.between(1000, 5000)));
        const V3f along(n.between(0.3f, 0.9f), 0, 0), across(0, n.between(0.3f, 0.9f), 0);
        add_rectangle(scene, {u, v, top}, across, along, panel);
        add_rectangle(scene, {u, v, top + 0.01f}, along, across, walls);  // its back
    }
    const int slats = seed % 3 == 0 ? 5 : 1;
    for (int i = 0; i < slats; ++i) {
        const float x = u + 0.2f * static_cast<float>(i), depth = slats > 1 ? 0.15f : 0.0f;
        add_rectangle(scene, {x, v, top - 0.4f}, {slats > 1 ? 0.05f : 0.4f, 0, depth}, {0, 0.5f, 0}, walls, 1, 1, true);
    }
    const int boxes = static_cast<int>(n.between(2, 6));
    for (int i = 0; i < boxes; ++i) {
        const V3f low(n.between(0.05f, 0.55f) * size.x, n.between(0.05f, 0.55f) * size.y, 0);
        add_box(scene, low, low + V3f(n.between(0.2f, 0.6f), n.between(0.2f, 0.6f), n.between(0.2f, 1.2f)),
                grey(0.2f, 0.8f));
    }
    scene = cut_at_contacts(std::move(scene));
    const Imath::V3d eye(size.x - 0.3, 0.3, 1.6);
    room.view = {"room", eye, {0.3 * size.x, 0.7 * size.y, 0.7}, {0, 0, 1}, 70};
    return room;
}

/// Relative deviation from path tracing, of the mean over seeds.
struct Deviation {
    double value = 0, squared_error = 0;
};

struct Means {
    double mean = 0, squared_error = 0;
    explicit Means(const std::vector<double>& values) {
        const auto count = static_cast<double>(values.size());
        for (const double v : values) mean += v / count;
        for (const double v : values) squared_error += (v - mean) * (v - mean) / (count - 1) / count;
    }
    Deviation from(const Means& path) const {
        return {mean / path.mean - 1, (squared_error + path.squared_error) / (path.mean * path.mean)};
    }
};

/// Each deviation within `of_one` and its errors, which all rooms tell together; their mean within `of_all`.
void expect_agreement(const std::vector<Deviation>& found, double of_one, double of_all, const std::string& what) {
    double mean = 0, variance = 0;
    const auto count = static_cast<double>(found.size());
    for (const Deviation& d : found) {
        mean += d.value / count;
        variance += d.squared_error / count;
    }
    for (std::size_t i = 0; i < found.size(); ++i)
        EXPECT_LT(std::abs(found[i].value), of_one + deviations * std::sqrt(std::max(found[i].squared_error, variance)))
            << what << ", room " << i + 1;
    EXPECT_LT(std::abs(mean), of_all + deviations * std::sqrt(variance / count)) << what;
}

Solution solution_of(const Room& room, const RayCaster& ray_caster) {
    SolveOptions options{.method = default_method(true), .limits = {.rays = 1'000'000}};
    options.views = {{room.view}};
    return solve(room.scene, ray_caster, options);
}

Means light_of(const Room& room, const Solution& solution, const RayCaster& ray_caster, Shading shading, int samples) {
    std::vector<double> values;
    for (const std::uint64_t seed : seeds) {
        PictureOptions options{.width = 48, .height = 27, .samples = samples, .quantity = PictureQuantity::irradiance};
        options.seed = seed;
        const Rendering r = render(room.scene, solution, ray_caster, room.view, by(shading, options));
        double sum = 0;
        for (const Rgb& p : r.image.pixels) sum += channel_sum(RgbD(p));
        values.push_back(sum);
    }
    return Means(values);
}

/// Mean irradiance of pictures: per-pixel shadings within 0.3%, one room within 1%; smooth and flat light within 2%
/// and 5%. Seen to fail when the indirect light of records is 3% too bright or 2% too dark.
TEST(Agreement, OfPictures) {
    std::vector<Deviation> hybrid, gather, instant, smooth, flat;
    for (std::uint64_t seed = 1; seed <= rooms; ++seed) {
        const Room r = room(seed);
        const RayCaster ray_caster(r.scene);
        const Solution solution = solution_of(r, ray_caster);
        const auto light = [&](Shading shading, int samples) {
            return light_of(r, solution, ray_caster, shading, samples);
        };
        const Means path = light(Shading::path, 128);
        hybrid.push_back(light(Shading::hybrid, 8).from(path));
        gather.push_back(light(Shading::gather, 16).from(path));
        instant.push_back(light(Shading::instant, 16).from(path));
        smooth.push_back(light(Shading::smooth, 4).from(path));
        flat.push_back(light(Shading::flat, 4).from(path));
    }
    expect_agreement(hybrid, 0.01, 0.003, "hybrid");
    expect_agreement(gather, 0.01, 0.003, "gather");
    expect_agreement(instant, 0.01, 0.003, "instant");
    expect_agreement(smooth, 0.05, 0.02, "smooth");
    expect_agreement(flat, 0.05, 0.02, "flat");
}

/// Mean irradiance at random points of faces, as lightmaps and vertices take it from records, within 0.5%; one room
/// within 1.5%. Seen to fail when it lacks 4% of the indirect light.
TEST(Agreement, OfBakes) {
    constexpr std::size_t points_per_room = 64;
    std::vector<Deviation> hybrid;
    for (std::uint64_t seed = 1; seed <= rooms; ++seed) {
        const Room r = room(seed);
        const RayCaster ray_caster(r.scene);
        const Solution solution = solve(r.scene, ray_caster, {.limits = {.rays = 1'000'000}});
        const TracedScene traced(r.scene, ray_caster);
        KnownIrradiance known = known_irradiance(r.scene, solution);
        known.is_interpolated = true;
        std::vector<Gauge> gauges;
        std::vector<MeasuringPoint> points;
        for (std::uint64_t i = 0; points.size() < points_per_room; ++i) {
            const auto words = random_words(seed, i);
            const auto patch = static_cast<std::uint32_t>(words[0] % r.scene.patches.size());
            const PatchGeometry& geometry = traced.geometry[patch];
            const V3f n = geometry.normal();
            const V3f x = geometry.point(geometry.uniform_parameters(unit_float(words[1]), unit_float(words[2])));
            const V3f above = x + 1e-4f * n;
            points.push_back({Imath::V3d(above), n});
            gauges.push_back({.position = above, .normal = n});
        }
        std::vector<double> found, expected;
        for (const std::uint64_t s : seeds) {
            PictureOptions options{.samples = 64, .quantity = PictureQuantity::irradiance};
            options.seed = s;
            const auto baked = hybrid_irradiance(traced, known, gauges, options, {});
            MeasuringOptions measuring{.shading = Shading::path, .samples = 512};
            measuring.seed = s;
            const auto measured = measure_irradiance(r.scene, nullptr, ray_caster, points, measuring);
            double of_baked = 0, of_measured = 0;
            for (std::size_t i = 0; i < points.size(); ++i) {
                of_baked += channel_sum(baked[i].irradiance());
                of_measured += channel_sum(measured[i].sum());
            }
            found.push_back(of_baked);
            expected.push_back(of_measured);
        }
        hybrid.push_back(Means(found).from(Means(expected)));
    }
    expect_agreement(hybrid, 0.015, 0.005, "bake");
}

}  // namespace
}  // namespace interflect
