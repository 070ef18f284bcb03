#include "interflect/solution.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>

#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <random>

#include "interflect/core.h"
#include "interflect/elements/forest.h"
#include "interflect/exports/hdf5/checksums.h"
#include "interflect/ray_caster.h"
#include "interflect/solve.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;
namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

/// A scene with all features of a solution file: triangles, two-sided faces, objects, views, names in UTF-8. Its
/// patches are undivided, and it was solved without a view.
SolvedScene example() {
    SolvedScene solved;
    Scene& scene = solved.scene;
    scene = closed_box({1, 2, 3}, 2, {{"wände", {0.5f, 0.25f, 0.125f}, {1, 2, 3}}});
    const std::uint32_t table = add_material(scene, Rgb(0.1f), Rgb(0));
    add_rectangle(scene, {0.2f, 0.2f, 1}, {0.5f, 0, 0}, {0, 0.5f, 0}, table, 1, 1, true);
    Patch triangle = scene.patches[0];
    triangle.vertices[3] = none;
    scene.patches[0] = triangle;
    scene.patches[0].surface = 7;
    scene.contacts = {{V3f(0.5f, 0, 1), V3f(1, 0.25f, 1)}, {V3f(0, 0, 0), V3f(0, 0, 1)}};
    scene.objects = {"", "room", "room.table"};
    scene.patches.back().object = 2;
    scene.views = {{"door", {0.1f, 0.2f, 0.3f}, {1, 2, 3}, {0, 1, 0}, 60},
                   {"corner", {1, 1, 1}, {0, 0, 0}, {0, 0, 1}, 45}};

    SolveOptions options{.method = find_method("srr")};
    options.limits.rays = 10'000;
    options.seed = 0xfedcba9876543210;
    solved.solution = solve(scene, RayCaster(scene), options);
    return solved;
}

/// The same with a view and refined: with importance and elements of several levels.
SolvedScene refined_example() {
    SolvedScene solved = example();
    SolveOptions options = solved.solution.options;
    options.method = find_method("ihsrr");
    options.views = {{solved.scene.views[0]}};
    options.experimental.epsilon = 1e-3;
    options.experimental.epsilon_decay = 0;
    solved.solution = solve(solved.scene, RayCaster(solved.scene), options);
    return solved;
}

void expect_equal(const ElementForest& a, const ElementForest& b) {
    ASSERT_EQ(a.size(), b.size());
    ASSERT_EQ(a.patch_count(), b.patch_count());
    for (ElementIndex e{0}; e < a.size(); ++e) {
        EXPECT_EQ(a.patch(e), b.patch(e)) << e;
        EXPECT_EQ(a.parent(e), b.parent(e)) << e;
        EXPECT_EQ(a.path(e), b.path(e)) << e;
        EXPECT_EQ(a.first_child(e), b.first_child(e)) << e;
        EXPECT_EQ(a.area(e), b.area(e)) << e;
    }
}

void expect_equal(const SolvedScene& a, const SolvedScene& b) {
    EXPECT_EQ(a.scene.name, b.scene.name);
    EXPECT_EQ(a.scene.origin, b.scene.origin);
    ASSERT_EQ(a.scene.contacts.size(), b.scene.contacts.size());
    for (std::size_t i = 0; i < a.scene.contacts.size(); ++i) {
        EXPECT_EQ(a.scene.contacts[i].a, b.scene.contacts[i].a);
        EXPECT_EQ(a.scene.contacts[i].b, b.scene.contacts[i].b);
    }
    EXPECT_EQ(a.scene.vertices, b.scene.vertices);
    EXPECT_EQ(a.scene.objects, b.scene.objects);
    ASSERT_EQ(a.scene.patches.size(), b.scene.patches.size());
    for (std::size_t i = 0; i < a.scene.patches.size(); ++i) {
        const Patch &p = a.scene.patches[i], &q = b.scene.patches[i];
        EXPECT_EQ(p.vertices, q.vertices);
        EXPECT_EQ(p.material, q.material);
        EXPECT_EQ(p.object, q.object);
        EXPECT_EQ(p.other_side, q.other_side);
        EXPECT_EQ(p.surface, q.surface);
    }
    ASSERT_EQ(a.scene.materials.size(), b.scene.materials.size());
    for (std::size_t i = 0; i < a.scene.materials.size(); ++i) {
        EXPECT_EQ(a.scene.materials[i].name, b.scene.materials[i].name);
        EXPECT_EQ(a.scene.materials[i].reflectance, b.scene.materials[i].reflectance);
        EXPECT_EQ(a.scene.materials[i].exitance, b.scene.materials[i].exitance);
    }
    ASSERT_EQ(a.scene.views.size(), b.scene.views.size());
    for (std::size_t i = 0; i < a.scene.views.size(); ++i) {
        EXPECT_EQ(a.scene.views[i].name, b.scene.views[i].name);
        EXPECT_EQ(a.scene.views[i].eye, b.scene.views[i].eye);
        EXPECT_EQ(a.scene.views[i].look_at, b.scene.views[i].look_at);
        EXPECT_EQ(a.scene.views[i].up, b.scene.views[i].up);
        EXPECT_EQ(a.scene.views[i].fov, b.scene.views[i].fov);
    }
    expect_equal(*a.solution.forest, *b.solution.forest);
    EXPECT_EQ(a.solution.irradiance, b.solution.irradiance);
    EXPECT_EQ(a.solution.unreduced_irradiance, b.solution.unreduced_irradiance);
    EXPECT_EQ(a.solution.direct, b.solution.direct);
    EXPECT_EQ(a.solution.standard_error, b.solution.standard_error);
    EXPECT_EQ(a.solution.discretisation_error, b.solution.discretisation_error);
    EXPECT_EQ(a.solution.rays, b.solution.rays);
    EXPECT_EQ(a.solution.view_importance, b.solution.view_importance);
    EXPECT_EQ(a.solution.indirect_importance, b.solution.indirect_importance);
    EXPECT_STREQ(a.solution.options.method.name, b.solution.options.method.name);
    EXPECT_EQ(a.solution.options.seed, b.solution.options.seed);
    EXPECT_EQ(a.solution.emitted_power, b.solution.emitted_power);
    EXPECT_EQ(a.solution.interrupted, b.solution.interrupted);
}

std::string contents(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<std::uint32_t> subdivided_elements(const Solution& solution) {
    std::vector<std::uint32_t> parents;
    for (ElementIndex e(solution.forest->patch_count()); e < solution.forest->size(); e += 4)
        parents.push_back(solution.forest->parent(e));
    return parents;
}

template <class T>
std::string replaced(std::string bytes, const std::vector<T>& before, const std::vector<T>& after) {
    const auto raw = [](const std::vector<T>& values) {
        return std::string(reinterpret_cast<const char*>(values.data()), sizeof(T) * values.size());
    };
    const std::size_t at = bytes.find(raw(before));
    if (at == std::string::npos) throw std::logic_error("no such array in the file");
    return bytes.replace(at, raw(before).size(), raw(after));
}

std::string error_of(const fs::path& path) {
    try {
        read_solution(path);
    } catch (const InputError& e) {
        return e.what();
    }
    return "no InputError";
}

class SolutionFile : public testing::Test {
  protected:
    const TemporaryFolder folder_;
    const fs::path path_ = folder_.path() / "solution.h5";

    std::string bytes_of(const SolvedScene& solved) const {
        write_solution(path_, solved.scene, solved.solution);
        return contents(path_);
    }

    /// Writes a file of these bytes with valid checksums, which therefore cannot protect the reader.
    fs::path write_with_checksums(const std::string& bytes) const {
        const fs::path path = folder_.write("damaged.h5", bytes);
        write_checksums(path, {});
        return path;
    }

    /// Modified contents must be refused or give a valid scene; they must never crash the reader.
    void expect_harmless(const std::string& bytes, const std::string& what) const {
        const fs::path damaged = write_with_checksums(bytes);
        try {
            const SolvedScene solved = read_solution(damaged);
            EXPECT_TRUE(scene_faults(solved.scene).empty()) << what;
            EXPECT_EQ(solved.solution.forest->patch_count(), solved.scene.patches.size()) << what;
            EXPECT_EQ(solved.solution.irradiance.size(), solved.solution.forest->size()) << what;
            for (const Rgb& h : solved.solution.irradiance) EXPECT_TRUE(is_finite(h)) << what;
        } catch (const InputError& e) {
            EXPECT_THAT(e.what(), HasSubstr("damaged.h5")) << what;
        }
    }
};

TEST_F(SolutionFile, ReadsWhatWasWritten) {
    SolvedScene solved = example();
    for (const bool interrupted : {false, true}) {
        solved.solution.interrupted = interrupted;
        write_solution(path_, solved.scene, solved.solution);
        expect_equal(read_solution(path_), solved);
        EXPECT_EQ(read_solution(path_).solution.options.limits.rays, 10'000);
    }
}

TEST_F(SolutionFile, KeepsTheOriginAndViewsFarFromTheWorlds) {
    SolvedScene solved = example();
    solved.scene.origin = {1e8 + 0.125, -3e5, 7};
    solved.scene.views[0].eye = {1e8 + 0.3, -3e5 + 0.1, 7.7};
    write_solution(path_, solved.scene, solved.solution);
    expect_equal(read_solution(path_), solved);
}

/// Removes the surfaces from the patches, the last number of each, which version 2 did not have.
void drop_surfaces_of_patches(const std::filesystem::path& path) {
    const char* name = "/scene/patches";
    const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), old = H5Dopen2(file, name, H5P_DEFAULT);
    const hid_t old_space = H5Dget_space(old);
    std::array<hsize_t, 2> size{};
    H5Sget_simple_extent_dims(old_space, size.data(), nullptr);
    std::vector<std::uint32_t> numbers(size[0] * size[1]), fewer;
    H5Dread(old, H5T_NATIVE_UINT32, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data());
    for (std::size_t i = 0; i < numbers.size(); ++i)
        if (i % size[1] != size[1] - 1) fewer.push_back(numbers[i]);
    --size[1];
    H5Dclose(old);
    H5Sclose(old_space);
    H5Ldelete(file, name, H5P_DEFAULT);
    const hid_t space = H5Screate_simple(2, size.data(), nullptr);
    const hid_t set = H5Dcreate2(file, name, H5T_STD_U32LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    EXPECT_GE(H5Dwrite(set, H5T_NATIVE_UINT32, H5S_ALL, H5S_ALL, H5P_DEFAULT, fewer.data()), 0);
    H5Dclose(set);
    H5Sclose(space);
    H5Fclose(file);
}

/// Converts a file to version 3: no checksums, and less in the description.
std::string as_version_3(std::string bytes) {
    bytes.erase(0, checksum_block_size);
    for (const auto& [now, before] :
         {std::pair<std::string, std::string>{"\"format_version\": 8", "\"format_version\": 3"},
          {"\"version\": ", "\"nothing\": "},
          {"\"files\": ", "\"nothi\": "},
          {"\"options\": ", "\"nothing\": "},
          {"\"result\": ", "\"nothin\": "}}) {
        if (bytes.find(now) == std::string::npos) throw std::logic_error("no such text in the file: " + now);
        bytes.replace(bytes.find(now), now.size(), before);
    }
    return bytes;
}

TEST_F(SolutionFile, OpensVersion3) {
    const SolvedScene solved = example();
    const SolvedScene read = read_solution(folder_.write("old.h5", as_version_3(bytes_of(solved))));
    expect_equal(read, solved);
    EXPECT_EQ(read.format_version, 3);
    EXPECT_EQ(read.interflect_version, "");
    EXPECT_EQ(read.solution.options.limits.rays, 10'000) << "as many as were traced";
}

/// A room of six two-sided walls and a lamp that Interflect 0.1.0 solved when version 3 was the newest.
TEST_F(SolutionFile, OpensAFileOfItsTime) {
    const SolvedScene read = read_solution(repository() / "tests/exports/hdf5/version-3.h5");
    EXPECT_EQ(read.format_version, 3);
    EXPECT_EQ(read.scene.name, "room.mgf");
    EXPECT_EQ(read.scene.patches.size(), 13u);
    EXPECT_STREQ(read.solution.options.method.name, "isrr");
    EXPECT_EQ(read.solution.view_importance.size(), 13u);
    EXPECT_EQ(read.solution.iterations.back().elements, 13u);
}

/// The same room with a light group and a view, refined, solved by Interflect 0.1.0 when version 4 was the newest.
TEST_F(SolutionFile, OpensVersion4) {
    const SolvedScene read = read_solution(repository() / "tests/exports/hdf5/version-4.h5");
    EXPECT_EQ(read.format_version, 4);
    EXPECT_EQ(read.interflect_version, "0.1.0");
    EXPECT_THAT(read.scene.files, ElementsAre("room.mgf", "room.views.json"));
    EXPECT_TRUE(read.scene.file_checksums.empty());
    EXPECT_EQ(read.scene.patches.size(), 13u);
    EXPECT_TRUE(read.scene.lightmap_coordinates.empty());
    EXPECT_EQ(read.solution.forest->size(), 133u);
    EXPECT_EQ(read.solution.groups.size(), 1u);
    ASSERT_EQ(read.solution.iterations.size(), 1u) << "the last one alone";
    EXPECT_EQ(read.solution.iterations[0].rays, 20'000);
}

TEST_F(SolutionFile, OpensVersion2) {
    SolvedScene solved = example();
    std::string bytes = as_version_3(bytes_of(solved));
    for (const auto& [now, before] :
         {std::pair<std::string, std::string>{"version\": 3", "version\": 2"}, {"\"origin\": ", "\"nothing\":"}})
        bytes.replace(bytes.find(now), now.size(), before);
    const fs::path path = folder_.write("old.h5", bytes);
    drop_surfaces_of_patches(path);
    for (Patch& patch : solved.scene.patches) patch.surface = none;
    solved.scene.contacts.clear();
    solved.solution.discretisation_error.assign(solved.solution.forest->size(), 0.0f);
    expect_equal(read_solution(path), solved);
}

TEST_F(SolutionFile, ReadsARefinedForestWithImportance) {
    const SolvedScene solved = refined_example();
    ASSERT_GT(solved.solution.forest->size(), solved.scene.patches.size()) << "the solver has refined";
    ASSERT_GT(solved.solution.forest->level(ElementIndex(solved.solution.forest->size() - 1)), 1);
    write_solution(path_, solved.scene, solved.solution);
    expect_equal(read_solution(path_), solved);
}

TEST_F(SolutionFile, FindsFilesOfTheSceneBesideIt) {
    SolvedScene solved = example();
    solved.scene.files = {"scene.glb", "elsewhere/lamp.ies", "nowhere.glb"};
    write_solution(path_, solved.scene, solved.solution);
    const fs::path folder = folder_.path();
    std::ofstream(folder / "scene.glb") << "text";
    std::ofstream(folder / "lamp.ies") << "text";
    EXPECT_THAT(read_solution(path_).scene.files,
                ElementsAre((folder / "scene.glb").string(), (folder / "lamp.ies").string(), "nowhere.glb"));
}

TEST_F(SolutionFile, KeepsADarkSolution) {
    SolvedScene solved;
    solved.scene = closed_box({1, 1, 1}, 1, {{"wall", Rgb(0.5f), Rgb(0)}});
    solved.solution = solve(solved.scene, RayCaster(solved.scene), {});
    write_solution(path_, solved.scene, solved.solution);
    expect_equal(read_solution(path_), solved);
}

TEST_F(SolutionFile, HasTheSameBytesForTheSameInput) {
    const SolvedScene solved = example();
    const std::string bytes = bytes_of(solved);
    EXPECT_EQ(bytes_of(solved), bytes);
    EXPECT_GT(bytes.size(), 0u);
}

TEST_F(SolutionFile, ExplainsWhatIsWrongWithAPath) {
    EXPECT_THAT(error_of(folder_.path() / "missing.h5"), HasSubstr("no such file"));
    EXPECT_THAT(error_of(folder_.path()), HasSubstr("is a folder"));
}

TEST_F(SolutionFile, RefusesOtherFiles) {
    for (const std::string& text :
         {std::string(), std::string("m wall =\n"), std::string("\x89HDF\r\n\x1a\n"),
          std::string("\x89HDF\r\n\x1a\n") + std::string(5000, '\0'), std::string(100'000, '\xff')})
        EXPECT_THAT(error_of(folder_.write("other.h5", text)), HasSubstr("not a solution file")) << text.size();
}

TEST_F(SolutionFile, CannotBeWrittenIntoAMissingFolder) {
    const SolvedScene solved = example();
    EXPECT_THROW(write_solution(folder_.path() / "missing" / "a.h5", solved.scene, solved.solution),
                 std::runtime_error);
}

/// Returns the message of a refused write of `solved` to `path`, whose previous file (from bytes_of()) must stay
/// unchanged.
std::string refusal(const fs::path& path, const SolvedScene& solved) {
    const std::string before = contents(path);
    try {
        write_solution(path, solved.scene, solved.solution);
    } catch (const std::runtime_error& e) {
        EXPECT_TRUE(contents(path) == before) << "something was written: " << e.what();
        return e.what();
    }
    return "written";
}

TEST_F(SolutionFile, IsNotWrittenWhenItCouldNotBeRead) {
    const SolvedScene good = refined_example();
    bytes_of(good);
    const auto refused_with = [&](const auto& spoil) {
        SolvedScene solved = good;
        spoil(solved.scene, solved.solution);
        return refusal(path_, solved);
    };
    for (const float wrong : {std::nanf(""), std::numeric_limits<float>::infinity(), -1.0f})
        EXPECT_THAT(refused_with([&](Scene&, Solution& s) { s.irradiance[3].y = s.irradiance[5].z = wrong; }),
                    HasSubstr("irradiance of element 3 is negative or not finite (2 such numbers)"));
    for (const auto values : {&Solution::standard_error, &Solution::discretisation_error, &Solution::rays,
                              &Solution::view_importance, &Solution::indirect_importance}) {
        EXPECT_THAT(refused_with([&](Scene&, Solution& s) { (s.*values)[5] = -1; }), HasSubstr(" of element 5 is neg"));
        EXPECT_THAT(refused_with([&](Scene&, Solution& s) { (s.*values).pop_back(); }), HasSubstr("differ in number"));
    }
    EXPECT_THAT(refused_with([](Scene&, Solution& s) { s.irradiance.pop_back(); }),
                HasSubstr("irradiance and elements differ in number"));
    EXPECT_THAT(refused_with([](Scene&, Solution& s) { s.emitted_power.x = std::nan(""); }),
                HasSubstr("emitted power"));
    EXPECT_THAT(refused_with([](Scene& s, Solution&) { s.materials[0].reflectance.x = 1; }), HasSubstr("reflectance"));
    EXPECT_THAT(refused_with([](Scene& s, Solution&) { s.views[0].fov = std::nanf(""); }), HasSubstr("view 'door'"));
    EXPECT_THAT(refused_with([](Scene&, Solution& s) { s.options.experimental.epsilon = std::nan(""); }),
                HasSubstr("'epsilon'"));
    EXPECT_EQ(refusal(path_, good), "written");
}

TEST_F(SolutionFile, IsRefusedWithNumbersThatCannotBe) {
    const SolvedScene solved = refined_example();
    const std::string bytes = bytes_of(solved);
    for (const float wrong : {std::nanf(""), std::numeric_limits<float>::infinity(), -1.0f}) {
        std::vector<Rgb> damaged = solved.solution.irradiance;
        damaged[3].y = wrong;
        EXPECT_THAT(error_of(write_with_checksums(replaced(bytes, solved.solution.irradiance, damaged))),
                    HasSubstr("irradiance of element 3 is negative or not finite"));
    }
    std::vector<float> damaged = solved.solution.indirect_importance;
    damaged[5] = -1;
    EXPECT_THAT(error_of(write_with_checksums(replaced(bytes, solved.solution.indirect_importance, damaged))),
                HasSubstr("the indirect importance of element 5 is negative"));
}

/// An element with children can neither appear twice, nor after its children, nor below the deepest level.
TEST_F(SolutionFile, IsRefusedWithAForestThatCannotGrow) {
    const SolvedScene solved = refined_example();
    const std::vector<std::uint32_t> subdivided = subdivided_elements(solved.solution);
    const std::string bytes = bytes_of(solved);
    for (const std::uint32_t wrong : {subdivided[0], solved.solution.forest->size(), none}) {
        std::vector<std::uint32_t> damaged = subdivided;
        damaged[1] = wrong;
        EXPECT_THAT(error_of(write_with_checksums(replaced(bytes, subdivided, damaged))),
                    HasSubstr(std::to_string(wrong) + " cannot be subdivided"));
    }
    std::vector<std::uint32_t> deep = subdivided;
    for (std::uint32_t i = 1; i < deep.size(); ++i)
        deep[i] = solved.solution.forest->patch_count() + 4 * (i - 1);  // always the first child of the last
    ASSERT_GT(deep.size(), std::size_t{ElementForest::deepest_level});
    EXPECT_THAT(error_of(write_with_checksums(replaced(bytes, subdivided, deep))), HasSubstr("cannot be subdivided"));
}

TEST_F(SolutionFile, DoesNoHarmWithFlippedBitsAndRightChecksums) {
    const std::string bytes = bytes_of(refined_example());
    std::mt19937_64 random(1);
    for (int trial = 0; trial < 300; ++trial) {
        std::string damaged = bytes;
        const std::size_t at = random() % bytes.size();
        damaged[at] = static_cast<char>(damaged[at] ^ (1 << (random() % 8)));
        expect_harmless(damaged, "byte " + std::to_string(at));
    }
}

TEST_F(SolutionFile, DoesNoHarmWithOverwrittenStretchesAndRightChecksums) {
    const std::string bytes = bytes_of(refined_example());
    std::mt19937_64 random(2);
    for (int trial = 0; trial < 150; ++trial) {
        std::string damaged = bytes;
        const std::size_t at = random() % bytes.size();
        const char filling = static_cast<char>(random());
        for (std::size_t i = at; i < std::min(at + 1 + random() % 64, bytes.size()); ++i) damaged[i] = filling;
        expect_harmless(damaged, "from byte " + std::to_string(at));
    }
}

TEST_F(SolutionFile, IsRecognised) {
    bytes_of(example());
    EXPECT_TRUE(is_solution_file(path_));
    EXPECT_TRUE(is_solution_file(folder_.write("version3.h5", contents(path_).substr(checksum_block_size))));
    EXPECT_TRUE(is_solution_file(folder_.write("damaged.h5", "x" + contents(path_).substr(1))));
    EXPECT_FALSE(is_solution_file(folder_.write("scene.mgf", "m wall =\n")));
    EXPECT_FALSE(is_solution_file(folder_.write("empty.h5", "")));
    EXPECT_FALSE(is_solution_file(folder_.path()));
    EXPECT_FALSE(is_solution_file(folder_.path() / "missing.h5"));
}

}  // namespace
}  // namespace interflect
