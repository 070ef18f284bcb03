// A run in many calls, saved and opened between them, or stopped at any point, has the bits of an undisturbed run. Seen
// to fail when contributions of an interrupted step stay, and when the file is written after the state has changed.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>

#include "interflect/base/numbers/random.h"
#include "interflect/core.h"
#include "interflect/elements/forest.h"
#include "interflect/exports/saved_run.h"
#include "interflect/solution.h"
#include "interflect/solve.h"
#include "interflect/solver.h"
#include "tests/support/release_only.h"
#include "tests/support/rooms/room_with_window.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;
namespace fs = std::filesystem;

/// Sources of light: a lamp; the same with luminaires and light groups; with light from outside; a lamp and walls with
/// images.
enum class Sources { lamp, luminaires, outdoor, images };

struct Case {
    std::string name;
    SolveOptions options{.method = find_method("srr")};
    Sources sources = Sources::lamp;
};
std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.name; }

const View into_the_room = {"room", {0.2f, 0.2f, 2}, {3.5f, 2.5f, 0.5f}, {0, 0, 1}, 60};

/// A room without a quarter of its ceiling, with a lamp below it and a table.
Scene open_room() {
    Scene scene = closed_box({4.1f, 2.9f, 2.5f}, 2, {{"wall", {0.7f, 0.6f, 0.5f}, Rgb(0)}});
    scene.patches.pop_back();
    const std::uint32_t lamp = add_material(scene, Rgb(0.2f), {90, 100, 70}),
                        grey = add_material(scene, Rgb(0.3f), Rgb(0));
    add_rectangle(scene, {1.3f, 1.1f, 2.3f}, {0, 0.4f, 0}, {0.3f, 0, 0}, lamp, 1, 1, true);
    add_box(scene, {2.1f, 0.9f, 0}, {3.2f, 1.8f, 0.7f}, grey);
    return scene;
}

Scene open_room_with_lights() {
    Scene scene = open_room();
    scene.luminaires = {{"lamp", 0, PointLight{{3, 2, 1}, {20, 30, 20}}},
                        {"spot", 0, SpotLight{{1, 1, 2.2f}, {1, 1, -3}, {50, 50, 90}, 10, 40}},
                        {"sun", 0, DirectionalLight{{1, 1, -3}, {80, 70, 60}}},
                        {"sky", 0, UniformSky{{9, 10, 12}}}};
    auto web = std::make_shared<PhotometricWeb>();
    web->polar = {0, 70.3f, 100}, web->azimuth = {-30, 60, 150};
    web->intensities = {10, 20, 0, 30, 5.1f, 0, 8, 9, 1};
    web->opening = {LuminousOpening::Shape::cylinder, {0.3f, 0.2f, 0.1f}, 1};
    web->pole = PhotometricWeb::Pole::c90;
    for (const float x : {1.2f, 2.4f})
        scene.luminaires.push_back(
            {"measured", 0, MeasuredLight{web, {x, 2, 2.1f}, {0.1f, 0, -1}, {1, 1, 0}, x > 2, {1, 0.9f, 0.7f}}});
    scene.light_groups = {{"daylight", "s*"}};
    return scene;
}

/// A sky with its sun's disc, and surroundings of four colours.
Scene open_room_with_outdoor_light() {
    Scene scene = open_room();
    auto image = std::make_shared<Texture>(Texture{"surroundings", 4, 2, {}});
    for (std::uint64_t i = 0; i < 8; ++i)
        image->texels.emplace_back(Rgb(static_cast<float>(mix(i, 1) % 9), static_cast<float>(mix(i, 2) % 9), 4));
    scene.luminaires = {
        {"sun", 0, DirectionalLight{{1, 1, -3}, {80, 70, 60}, 5}},
        {"dome", 0, SkyDome{cie_standard_sky(12), {9, 10, 12}, {0, 0, 1}, {-1, -1, 3}, 0.2f}},
        {"surroundings", 0, EnvironmentMap{image, {0, 0, 1}, {0, 1, 0}, {1, 2, 1}}},
    };
    return scene;
}

/// The wall and the lamp have different images, laid askew, so the elements of a patch differ.
Scene open_room_with_images() {
    Scene scene = open_room();
    constexpr std::uint32_t side = 16;
    for (std::uint64_t image = 0; image < 2; ++image) {
        scene.textures.push_back({"image", side, side, {}});
        for (std::uint64_t i = 0; i < side * side; ++i)
            scene.textures.back().texels.emplace_back(static_cast<float>(mix(i, image) % 1'000) / 1'000);
    }
    scene.materials[0].reflectance_texture = 0;
    scene.materials[1].exitance_texture = 1;
    for (const V3f& x : scene.vertices)
        scene.texture_coordinates.emplace_back(0.3f * x.x + 2.5f * x.y - 0.1f * x.z,
                                               0.6f * x.z - 2.2f * x.x + 0.1f * x.y);
    return scene;
}

Scene room_with(Sources sources) {
    switch (sources) {
        case Sources::lamp:
            return open_room();
        case Sources::luminaires:
            return open_room_with_lights();
        case Sources::outdoor:
            return open_room_with_outdoor_light();
        case Sources::images:
            return open_room_with_images();
    }
    return {};
}

bool is_one_of(std::string_view name, std::initializer_list<std::string_view> names) {
    return std::find(names.begin(), names.end(), name) != names.end();
}
/// One case for each class of iterations.
bool keeps_light_its_own_way(std::string_view name) {
    return is_one_of(name, {"srr", "hsrr", "ihsrr", "ihsrr_one_bounce", "ihwdrs", "random_walk",
                            "random_walk_with_importance", "photon_mesh", "pr"});
}
/// Few cases, because each opening of such a run makes the tables of its sky anew.
bool has_outdoor_light(std::string_view name) {
    return is_one_of(name, {"ihsrr", "random_walk_with_importance", "photon_mesh"});
}

std::vector<Case> cases() {
    std::vector<Case> all;
    const auto add = [&](const std::string& name, const std::string& method, const auto& change) {
        SolveOptions options{.method = find_method(method)};
        if (options.method.importance != ImportanceUse::off) options.views = {{into_the_room}};
        options.limits.rays = 30'000;
        options.importance.camera_rays = 2000;
        change(options);
        all.push_back({name, options});
    };
    const auto as_it_is = [](SolveOptions&) {};
    for (const Method& method : methods) {
        std::string name = method.name;
        std::replace(name.begin(), name.end(), '-', '_');
        add(name, method.name, as_it_is);
    }
    add("hr_with_importance", "hr", [](SolveOptions& o) {
        o.method.importance = ImportanceUse::full;
        o.views = {{into_the_room}};
        o.experimental.epsilon = 1e-4;
    });
    add("random_walk_with_importance", "random-walk", [](SolveOptions& o) {
        o.method.importance = ImportanceUse::full;
        o.views = {{into_the_room}};
    });
    add("ihsrr_si", "ihsrr", [](SolveOptions& o) { o.experimental.separate_iterations = true; });
    add("ihsrr_perceptual", "ihsrr", [](SolveOptions& o) { o.refinement.criterion = RefinementCriterion::perceptual; });
    add("ihsrr_by_power", "ihsrr", [](SolveOptions& o) { o.refinement.criterion = RefinementCriterion::power; });
    add("ihsrr_one_bounce", "ihsrr", [](SolveOptions& o) {
        o.experimental.one_bounce = true;
        o.experimental.warm_up = 1;
        o.experimental.rays_per_iteration = 10'000;
    });
    add("ihsrr_direct", "ihsrr", [](SolveOptions& o) { o.keep_direct = true; });
    add("ihsrr_one_bounce_si", "ihsrr", [](SolveOptions& o) {
        o.experimental.one_bounce = true;
        o.experimental.separate_iterations = true;
    });
    add("hwdrs_one_bounce", "hwdrs", [](SolveOptions& o) { o.experimental.one_bounce = true; });
    const std::size_t with_a_lamp = all.size();
    for (std::size_t i = 0; i < with_a_lamp; ++i) {
        const Case c = all[i];
        const Method method = c.options.method;
        if (!keeps_light_its_own_way(c.name)) continue;
        all.push_back({c.name + "_images", c.options, Sources::images});
        if (!method.takes_luminaires) continue;
        if (has_outdoor_light(c.name)) all.push_back({c.name + "_outdoors", c.options, Sources::outdoor});
        if (method.separates_groups) all.push_back({c.name + "_lights", c.options, Sources::luminaires});
    }
    return all;
}

class SavedRun : public testing::TestWithParam<Case> {
  protected:
    // Under sanitizers: each class of iterations with one lamp, and hsrr with all sources.
    void SetUp() override {
        const std::string_view name = GetParam().name;
        RELEASE_ONLY_IF(!keeps_light_its_own_way(name) && !name.starts_with("hsrr"));
    }

    /// Returns the solution of a run that is left alone. The tests of a case have it in common.
    const Solution& undisturbed() const {
        static std::map<std::string, Solution> solutions;
        auto found = solutions.find(GetParam().name);
        if (found == solutions.end())
            found = solutions.emplace(GetParam().name, solve(scene, RayCaster(scene), GetParam().options)).first;
        return found->second;
    }

    const TemporaryFolder folder;
    const fs::path file = folder.path() / "run.h5";
    const Scene scene = room_with(GetParam().sources);
};
INSTANTIATE_TEST_SUITE_P(Methods, SavedRun, testing::ValuesIn(cases()),
                         [](const auto& test) { return test.param.name; });

void expect_same(const Solution& s, const Solution& expected) {
    EXPECT_EQ(s.emitted_power, expected.emitted_power);
    ASSERT_EQ(s.iterations.size(), expected.iterations.size());
    for (std::size_t i = 0; i < s.iterations.size(); ++i) {
        EXPECT_EQ(s.iterations[i].rays, expected.iterations[i].rays);
        EXPECT_EQ(s.iterations[i].escaped_rays, expected.iterations[i].escaped_rays);
        EXPECT_EQ(s.iterations[i].elements, expected.iterations[i].elements);
        EXPECT_EQ(s.iterations[i].total_power, expected.iterations[i].total_power);
        EXPECT_EQ(s.iterations[i].escaped_power, expected.iterations[i].escaped_power);
        EXPECT_EQ(s.iterations[i].error_estimate, expected.iterations[i].error_estimate);
        EXPECT_EQ(s.iterations[i].high_payload, expected.iterations[i].high_payload);
        EXPECT_EQ(s.iterations[i].discarded_hits, expected.iterations[i].discarded_hits);
    }
    ASSERT_EQ(s.forest->subdivided(), expected.forest->subdivided());
    EXPECT_EQ(s.irradiance, expected.irradiance);
    EXPECT_EQ(s.groups, expected.groups);
    EXPECT_EQ(s.view_importance, expected.view_importance);
    EXPECT_EQ(s.indirect_importance, expected.indirect_importance);
    EXPECT_EQ(s.standard_error, expected.standard_error);
    EXPECT_EQ(s.discretisation_error, expected.discretisation_error);
    EXPECT_EQ(s.rays, expected.rays);
    EXPECT_EQ(s.non_finite, expected.non_finite);
}

TEST_P(SavedRun, HasTheSameBitsInManyCalls) {
    const Solution& expected = undisturbed();
    for (const Limits& limits : {Limits{.rays = 1}, Limits{.time = 0}}) {
        Solver solver(scene, GetParam().options);
        int calls = 1;
        while (!solver.advance(limits).is_finished) {
            solver.solution();  // reading changes no state
            ASSERT_LT(++calls, 1000);
        }
        EXPECT_GT(calls, 2);
        expect_same(std::move(solver).take_solution(), expected);
    }
}

TEST_P(SavedRun, HasTheSameBitsIfSavedOften) {
    const Solution& expected = undisturbed();
    // Each opening makes the tables of a sky anew, so a run with light from outside is saved every fourth iteration.
    const int period = GetParam().sources == Sources::outdoor ? 4 : 1;
    Solver solver(scene, GetParam().options);
    int iteration = 0;
    do {
        if (iteration++ % period == 0) {
            solver.save(file);
            solver = Solver::open(file);
        }
    } while (!solver.advance({.time = 0}).is_finished);
    EXPECT_GT(iteration, period) << "saved again after the first iterations";
    expect_same(solver.solution(), expected);
}

TEST_P(SavedRun, HasTheSameBitsAfterATransferInMemory) {
    const Solution& expected = undisturbed();
    Solver solver(scene, GetParam().options);
    solver.advance({.time = 0});
    Solver copy = Solver::open_image(solver.image());
    EXPECT_EQ(copy.solution().rays, solver.solution().rays);  // a new start would have the same bits at the end
    copy.advance({});
    expect_same(copy.solution(), expected);
}

/// Some rays of a sky are aimed at boxes around the window. Seen to fail when the file does not contain these.
TEST(SavedTargets, OfTheSkyAreRestored) {
    Scene scene = room_with_window(Rgb(1000));
    for (Material& material : scene.materials) material.reflectance = Rgb(0.5f);
    SolveOptions options{.method = find_method("ihsrr")};
    options.views = {{View{"floor", {4.5, 0.5, 1.6}, {1, 3, 0}}}};
    options.limits.rays = 400'000;
    Solver once(scene, options), saved(scene, options);
    once.advance({});
    saved.advance({.rays = 100'000});
    Solver opened = Solver::open_image(saved.image());
    opened.advance({});
    expect_same(opened.solution(), once.solution());
}

TEST(Solver, OpensNoDamagedImage) {
    SolveOptions options{.method = find_method("srr")};
    options.limits.rays = 1000;
    const std::string image = Solver(open_room(), options).image();
    EXPECT_THROW(Solver::open_image(image.substr(0, image.size() / 2)), std::runtime_error);
    EXPECT_THROW(Solver::open_image(""), std::runtime_error);
}

TEST(Solver, OpensNoStateOfAnOlderBuild) {
    SolveOptions options{.method = find_method("srr")};
    options.limits.rays = 1000;
    std::string image = Solver(open_room(), options).image();
    constexpr std::string_view name = "\"state_version\":";
    const std::size_t at = image.find_first_of("0123456789", image.find(name));
    ASSERT_EQ(image[at], '6');
    image[at] = '5';
    try {
        Solver::open_image(image);
        ADD_FAILURE() << "expected an error";
    } catch (const std::runtime_error& e) {
        EXPECT_THAT(e.what(), testing::HasSubstr("with version 5 of the state"));
        EXPECT_THAT(e.what(), testing::HasSubstr("reads version 6"));
        EXPECT_THAT(e.what(), testing::HasSubstr("solve the scene again"));
    }
}

TEST_P(SavedRun, HasTheSameBitsWhereverItIsStopped) {
    const Solution& expected = undisturbed();
    Solver solver(scene, GetParam().options);
    std::uint64_t random = 7;
    // An iteration that is stopped is undone. The times grow, so the run ends on any machine. Under sanitizers,
    // iterations are about ten times slower.
    double longer = is_sanitized ? 10 : 1;
    for (bool is_finished = false; !is_finished; longer *= 1.05) {
        std::atomic<bool> stop = false;
        random = mix(random, 1);
        const std::chrono::duration<double, std::milli> until_stop(longer * (1 + static_cast<double>(random % 20)));
        std::thread stopper([&] {
            std::this_thread::sleep_for(until_stop);
            stop = true;
        });
        is_finished = solver.advance({}, {{}, &stop}).is_finished;
        stopper.join();
    }
    expect_same(solver.solution(), expected);
}

TEST_P(SavedRun, WritesTheSameFileAsOneLeftAlone) {
    const auto bytes_of = [&](const Solution& solution) {
        write_solution(file, scene, solution);
        std::ifstream in(file, std::ios::binary);
        return std::string(std::istreambuf_iterator<char>(in), {});
    };
    Solver solver(scene, GetParam().options);
    solver.advance({.rays = 20'000});
    solver.save(file);
    Solver opened = Solver::open(file);
    opened.advance({});
    EXPECT_EQ(opened.scene().patches.size(), scene.patches.size());
    const std::string expected = bytes_of(undisturbed());
    EXPECT_TRUE(bytes_of(opened.solution()) == expected);
}

View turned(double degrees) {
    View view = into_the_room;
    const double a = degrees * 3.14159265358979 / 180;
    const Imath::V3d d = view.look_at - view.eye;
    view.look_at =
        view.eye + Imath::V3d(d.x * std::cos(a) - d.y * std::sin(a), d.x * std::sin(a) + d.y * std::cos(a), d.z);
    return view;
}

Solver solver_of_a_view(const std::string& method = "ihsrr", std::uint64_t seed = 1) {
    SolveOptions options{.method = find_method(method)};
    options.views = {{into_the_room}};
    options.limits.rays = is_sanitized ? 50'000 : 200'000;
    options.importance.camera_rays = 2000;
    options.seed = seed;
    Solver solver(open_room(), options);
    solver.advance({});
    return solver;
}

TEST(ChangeOfViews, KeepsTheLightAndFindsImportanceAnew) {
    Solver solver = solver_of_a_view();
    const Solution before = solver.solution();
    solver.set_views({{turned(25)}});
    const Solution& after = solver.solution();
    EXPECT_EQ(after.forest->subdivided(), before.forest->subdivided());
    double difference = 0, sum = 0;
    for (PatchIndex i{0}; i < after.forest->patch_count(); ++i) {
        // Clusters keep the means of the visible patches, which are others now.
        EXPECT_NEAR(after.irradiance[i].x / before.irradiance[i].x, 1, 1e-3) << i;
        EXPECT_EQ(after.indirect_importance[i], 0);
        sum += before.view_importance[i];
        difference += std::abs(after.view_importance[i] - before.view_importance[i]);
    }
    EXPECT_GT(difference, 0.1 * sum);
    solver.advance({.rays = 1});
    const Solution& found = solver.solution();
    EXPECT_GT(*std::max_element(found.indirect_importance.begin(), found.indirect_importance.end()), 0);
}

// After a turn, a tenth of the rays suffices. The median of nine runs is used, because estimates from few rays vary;
// measured: 0.8. Seen to fail when the averages before the change are discarded.
TEST(ChangeOfViews, NeedsFewRaysAfterATurn) {
    RELEASE_ONLY();
    std::vector<double> ratios;
    for (std::uint64_t seed = 1; seed <= 9; ++seed) {
        Solver solver = solver_of_a_view("ihsrr", seed);
        const double before = solver.advance({.rays = 0}).error;
        solver.set_views({{turned(15)}});
        ratios.push_back(solver.advance({.rays = 20'000}).error / before);
    }
    std::nth_element(ratios.begin(), ratios.begin() + 4, ratios.end());
    EXPECT_LT(ratios[4], 1.1);
}

// In a closed box of grey walls that all emit, H = M / (1 - rho) everywhere, for all previous views. The mean over the
// walls of 24 runs has a standard error below 0.3%, so an error of 1.8% is detected; false alarm 1e-9.
class UnbiasedChangeOfViews : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Methods, UnbiasedChangeOfViews, testing::Values("ihsrr", "ihwdrs"),
                         [](const auto& test) { return std::string(test.param); });
TEST_P(UnbiasedChangeOfViews, InAFurnace) {
    RELEASE_ONLY();
    SolveOptions options{.method = find_method(GetParam())};
    options.limits.rays = 20'000;
    const View views[] = {{"a", {0.3f, 0.4f, 0.5f}, {0.9f, 1.9f, 2.9f}}, {"b", {0.3f, 1.4f, 2.5f}, {0.9f, 0.1f, 0.1f}}};
    const Scene scene = closed_box({1, 2, 3}, 3, {{"wall", Rgb(0.6f), Rgb(2)}});
    double sum = 0, squares = 0;
    constexpr int runs = 24;
    for (int run = 0; run < runs; ++run) {
        options.seed = static_cast<std::uint64_t>(run + 1);
        options.views = {{views[0]}};
        Solver solver(scene, options);
        solver.advance({});
        for (const int v : {1, 0, 1}) {
            solver.set_views({{views[v]}});
            solver.advance({.rays = 10'000});
        }
        const double power = solver.solution().iterations.back().total_power.x;
        sum += power;
        squares += power * power;
    }
    const double mean = sum / runs, exact = 22 * 2 / (1 - 0.6);
    const double standard_error = std::sqrt((squares / runs - mean * mean) / (runs - 1));
    EXPECT_NEAR(mean, exact, 6 * standard_error);
    EXPECT_LT(standard_error, 0.003 * exact) << "else the test would notice nothing";
}

TEST(ChangeOfViews, HasTheSameBitsWhenSavedAndOpenedOnTheWay) {
    const TemporaryFolder folder;
    for (const char* method : {"ihsrr", "isrr", "srr", "ihwdrs"}) {
        Solver once = solver_of_a_view(method), often = solver_of_a_view(method);
        for (Solver* solver : {&once, &often}) {
            solver->set_views({{turned(25)}});
            solver->set_plan({.rays = solver->options().limits.rays + 100'000});
        }
        once.advance({});
        while (!often.advance({.time = 0}).is_finished) {
            often.save(folder.path() / "run.h5");
            often = Solver::open(folder.path() / "run.h5");
        }
        expect_same(often.solution(), once.solution());
    }
}

/// Goes on to the end of the run. With a file, saves and opens the run after every iteration.
void finish(Solver& solver, const fs::path& file) {
    for (bool is_finished = false; !is_finished; is_finished = solver.advance({.time = 0}).is_finished) {
        if (file.empty()) continue;
        solver.save(file);
        solver = Solver::open(file);
    }
}

/// A run with few rays whose views change after some iterations. With a file, it is saved and opened after each later
/// iteration.
Solution changed_after(int iterations, RefinementCriterion criterion, const fs::path& file) {
    SolveOptions options{.method = find_method("ihsrr")};
    options.views = {{into_the_room}};
    options.refinement.criterion = criterion;
    options.limits.rays = 50'000;
    options.importance.camera_rays = 1000;
    Solver solver(open_room(), options);
    for (int i = 0; i < iterations; ++i) solver.advance({.time = 0});
    solver.set_views({{turned(25)}});
    finish(solver, file);
    return solver.solution();
}

// Seen to fail when Passes does not archive the ray distribution before the change.
TEST(ChangeOfViews, HasTheSameBitsWhenSavedAfterwards) {
    const TemporaryFolder folder;
    for (const RefinementCriterion criterion :
         {RefinementCriterion::variance, RefinementCriterion::perceptual, RefinementCriterion::power})
        for (int iterations = 0; iterations < 4; iterations += is_sanitized ? 3 : 1)
            expect_same(changed_after(iterations, criterion, folder.path() / "run.h5"),
                        changed_after(iterations, criterion, {}));
}

/// Links of clusters, before and after a change of the view. With a file, the run is saved and opened after every
/// iteration.
Solution linked_by_clusters(const fs::path& file) {
    Scene scene = closed_box({4.1f, 2.9f, 2.5f}, 8, {{"wall", {0.7f, 0.6f, 0.5f}, Rgb(0)}});
    add_rectangle(scene, {1, 1, 2.4f}, {0, 1, 0}, {1, 0, 0}, add_material(scene, Rgb(0), Rgb(50)));
    SolveOptions options{.method = find_method("hr")};
    options.method.importance = ImportanceUse::full;
    options.views = {{into_the_room}};
    options.experimental.epsilon = 1e-3;
    options.limits.rays = is_sanitized ? 50'000 : 200'000;
    Solver solver(scene, options);
    finish(solver, file);
    solver.set_views({{turned(25)}});
    solver.set_plan({.rays = options.limits.rays * 3 / 2});
    finish(solver, file);
    return solver.solution();
}

// Seen to fail when LinkedElements does not archive its links.
TEST(ClusterLinks, HaveTheSameBitsWhenSavedAndAfterAChangeOfViews) {
    const TemporaryFolder folder;
    const Solution expected = linked_by_clusters({});
    EXPECT_GT(expected.iterations.size(), 10u);
    EXPECT_GT(expected.forest->size(), expected.forest->patch_count());
    expect_same(linked_by_clusters(folder.path() / "run.h5"), expected);
}

TEST(ChangeOfViews, RefusesWhatIsNoView) {
    Solver solver = solver_of_a_view("srr");
    View view = into_the_room;
    view.look_at = view.eye;
    EXPECT_THROW(solver.set_views({{view}}), InputError);
    EXPECT_EQ(solver.options().views.front().view.look_at, into_the_room.look_at);
}

/// A run saved with a dimmed group shows its current light, and continues like an unsaved run.
TEST(DimmedRun, IsDimmedOnceHoweverItIsWritten) {
    const TemporaryFolder folder;
    const fs::path run = folder.path() / "run.h5", result = folder.path() / "result.h5";
    SolveOptions options{.method = find_method("hsrr")};
    options.limits.rays = 60'000;
    Solver solver(open_room_with_lights(), options);
    solver.advance({.rays = 20'000});
    solver.set_dimming("daylight", 0.25f);
    solver.set_dimming("other", 0);
    solver.save(run);
    write_solution(result, solver.scene(), solver.solution());
    for (const fs::path& file : {run, result}) {
        const SolvedScene read = read_solution(file);
        EXPECT_EQ(read.solution.irradiance, solver.solution().irradiance);
        EXPECT_EQ(read.solution.dimming, (std::vector<float>{1, 1}));
        EXPECT_EQ(std::get<UniformSky>(read.scene.luminaires[3].kind).radiance, 0.25f * Rgb(9, 10, 12));
        EXPECT_EQ(rating(read.scene.luminaires[0]), Rgb(0));
        EXPECT_EQ(rating(read.scene.luminaires[4]), Rgb(0));
    }
    Solver opened = Solver::open(run);
    for (Solver* s : {&solver, &opened}) {
        s->set_dimming("other", 0.5f);
        s->advance({});
    }
    expect_same(opened.solution(), solver.solution());
}

TEST(Solver, GoesOnBeyondItsPlanWhenAskedTo) {
    SolveOptions options{.method = find_method("hsrr")};
    options.limits.rays = 50'000;
    Solver solver(open_room(), options);
    EXPECT_TRUE(solver.advance({}).is_finished);
    const AdvanceReport report = solver.advance({.rays = 200'000});
    EXPECT_GE(report.rays, 240'000);
    EXPECT_LE(report.rays, 260'000);
}

TEST(Solver, EndsAtTheErrorThatIsAskedFor) {
    SolveOptions options{.method = find_method("hsrr")};
    options.limits.rays = 10'000'000;
    Solver solver(open_room(), options);
    const AdvanceReport report = solver.advance({.until = 0.3});
    EXPECT_LE(report.error, 0.3);
    EXPECT_LT(report.rays, 10'000'000);
    EXPECT_FALSE(report.is_finished);
}

TEST(Solver, IsDarkAndFinishedWithoutLight) {
    Scene scene = closed_box({1, 2, 3}, 2, {{"grey", Rgb(0.5f), Rgb(0)}});
    Solver solver(scene, {});
    const AdvanceReport report = solver.advance({.rays = 1000});
    EXPECT_TRUE(report.is_finished);
    EXPECT_EQ(report.error, 0);
    EXPECT_EQ(solver.solution().irradiance, std::vector<Rgb>(scene.patches.size(), Rgb(0)));
}

TEST(Solver, OpensOnlyFilesWithTheStateOfARun) {
    const TemporaryFolder folder;
    const fs::path file = folder.path() / "result.h5";
    const Scene scene = open_room();
    SolveOptions options{.method = find_method("srr")};
    options.limits.rays = 1000;
    write_solution(file, scene, solve(scene, RayCaster(scene), options));
    try {
        Solver::open(file);
        ADD_FAILURE() << "expected an error";
    } catch (const InputError& e) {
        EXPECT_THAT(e.what(), testing::HasSubstr("not its state"));
    }
    EXPECT_THROW(Solver::open(folder.path() / "missing.h5"), InputError);
}

}  // namespace
}  // namespace interflect
