// History of a solution in its file: every iteration, and the source files.
//
// Seen to fail when the last iteration is left out and when checksums are those of other files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>

#include "interflect/core.h"
#include "interflect/exports/records/solve_report.h"
#include "interflect/solution.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;
using testing::HasSubstr;

std::string contents(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

class Provenance : public testing::Test {
  protected:
    Provenance() {
        solved.scene = closed_box({1, 2, 3}, 1, {{"wall", Rgb(0.5f), Rgb(1)}});
        SolveOptions options{.method = find_method("srr")};
        options.limits.rays = 10'000;
        options.experimental.rays_per_iteration = 2000;
        solved.solution = solve(solved.scene, RayCaster(solved.scene), options);
    }

    SolvedScene written_and_read() const {
        write_solution(path, solved.scene, solved.solution);
        return read_solution(path);
    }

    const TemporaryFolder folder;
    const std::filesystem::path path = folder.path() / "solution.h5";
    SolvedScene solved;
};

TEST_F(Provenance, HasEveryIteration) {
    const std::vector<IterationReport> read = written_and_read().solution.iterations;
    ASSERT_EQ(read.size(), 5u);
    for (std::size_t i = 0; i < read.size(); ++i)
        EXPECT_EQ(report_row(read[i]), report_row(solved.solution.iterations[i])) << i;
    EXPECT_TRUE(std::isinf(read[0].error_estimate)) << "not known after one iteration";
    EXPECT_EQ(read[4].rays, 10'000);
}

TEST_F(Provenance, HasTheChecksumsOfTheFilesThatWereRead) {
    solved.scene.files = {"room.mgf", "oak.png"};
    solved.scene.file_checksums = {0x1234abcd, 0x0000000f};
    const Scene read = written_and_read().scene;
    EXPECT_EQ(read.files, solved.scene.files);
    EXPECT_EQ(read.file_checksums, solved.scene.file_checksums);
}

TEST_F(Provenance, RefusesIterationsThatCannotBe) {
    std::vector<double> row = report_row(solved.solution.iterations[0]);
    EXPECT_NO_THROW(report_of_row(row));
    row[1] = -1;
    EXPECT_THROW(report_of_row(row), std::runtime_error);
    row[1] = std::nan("");
    EXPECT_THROW(report_of_row(row), std::runtime_error);
}

/// The table of checksums has one line for all numbered arrays of a group.
TEST_F(Provenance, HasRoomForAnyNumberOfTextures) {
    solved.scene.textures.resize(300, Texture{"grey.png", 1, 1, {Rgb(0.5f)}});
    EXPECT_EQ(written_and_read().scene.textures.size(), 300u);
    std::string damaged = contents(path);
    damaged[damaged.find(std::string("\0\0\0\x3f\0\0\0\x3f\0\0\0\x3f", 12))] ^= 1;
    const std::filesystem::path file = folder.write("damaged.h5", damaged);
    try {
        read_solution(file);
        FAIL() << "read";
    } catch (const InputError& e) {
        EXPECT_THAT(e.what(), HasSubstr("the checksum of /scene/textures differs"));
    }
}

}  // namespace
}  // namespace interflect
