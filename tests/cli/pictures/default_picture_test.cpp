#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "interflect/image.h"
#include "interflect/render.h"
#include "interflect/solve.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {
namespace {

using namespace testing_support;

/// A lamp above a floor, far from the camera: most pixels of the default size are empty, which saves time.
SolvedScene solved_floor() {
    SolvedScene solved;
    Scene& scene = solved.scene;
    add_rectangle(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, add_material(scene, Rgb(0.5f), Rgb(0)), 2, 2);
    add_rectangle(scene, {0.2f, 0.2f, 1}, {0, 0.6f, 0}, {0.6f, 0, 0}, add_material(scene, Rgb(0.5f), Rgb(100)));
    scene.views.push_back({"far", {20, -10, 8}, {0.5, 0.5, 0.5}, {0, 0, 1}, 45});
    solved.solution = solve(scene, RayCaster(scene), {.limits = {.rays = 10'000}});
    return solved;
}

/// render() without options draws the picture of `interflect render` without options.
/// tests/python/programs/command_test.py compares the command with Python.
TEST(DefaultPicture, IsThatOfTheCommand) {
    const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "interflect-default-picture";
    std::filesystem::create_directories(folder);
    const SolvedScene solved = solved_floor();
    write_solution(folder / "floor.h5", solved.scene, solved.solution);
    std::string command(INTERFLECT_COMMAND " render");
    command.append(" '").append(folder / "floor.h5").append("' -o '").append(folder / "floor.exr").append("'");
    ASSERT_EQ(std::system(command.c_str()), 0) << command;
    const Image expected = read_image(folder / "floor.exr");
    std::filesystem::remove_all(folder);
    const Image found =
        render(solved.scene, solved.solution, RayCaster(solved.scene), solved.scene.views.front()).image;
    EXPECT_EQ(found.width, 1280);
    EXPECT_EQ(found.height, 720);
    EXPECT_EQ(found.pixels, expected.pixels);
}

}  // namespace
}  // namespace interflect
