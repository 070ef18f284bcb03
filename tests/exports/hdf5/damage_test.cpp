// A solution file in which any byte has changed is refused.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <random>

#include "interflect/core.h"
#include "interflect/exports/hdf5/checksums.h"
#include "interflect/ray_caster.h"
#include "interflect/solution.h"
#include "interflect/solve.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;
namespace fs = std::filesystem;
using testing::AnyOf;
using testing::HasSubstr;

std::string contents(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// Writes the smallest solution with all features: a cube of undivided patches, seen from inside.
void write_small_solution(const fs::path& path) {
    Scene scene = closed_box({1, 1, 1}, 1, {{"wall", Rgb(0.5f), Rgb(1)}});
    scene.views = {{"inside", {0.5, 0.5, 0.5}, {1, 0.5, 0.5}, {0, 0, 1}, 60}};
    SolveOptions options{.method = find_method("isrr")};
    options.limits.rays = 1000;
    options.views = {{scene.views[0]}};
    write_solution(path, scene, solve(scene, RayCaster(scene), options));
}

class DamagedFile : public testing::Test {
  protected:
    DamagedFile() { write_small_solution(path_); }

    const TemporaryFolder folder_;
    const fs::path path_ = folder_.path() / "solution.h5";

    std::string error_with(const std::string& bytes) const {
        std::ofstream(path_, std::ios::binary | std::ios::trunc) << bytes;
        return error();
    }

    /// Returns the error with one byte of the file changed, which must be `byte`; restores the file.
    std::string error_with_flipped(std::size_t at, char byte, int mask) const {
        std::fstream file(path_, std::ios::binary | std::ios::in | std::ios::out);
        const auto write = [&](char c) { file.seekp(static_cast<std::streamoff>(at)).put(c).flush(); };
        write(static_cast<char>(byte ^ mask));
        const std::string message = error();
        write(byte);
        return message;
    }

    std::string error() const {
        try {
            read_solution(path_);
        } catch (const InputError& e) {
            return e.what();
        }
        return "no InputError";
    }
};

const auto is_refused = AnyOf(HasSubstr("the file is damaged: "), HasSubstr("not a solution file"));

TEST_F(DamagedFile, IsRefusedWithAnyByteFlipped) {
    const std::string bytes = contents(path_);
    constexpr std::size_t all_bits_every = 16;
    std::mt19937 random(1);
    const auto expect_refused = [&](std::size_t at, int mask) {
        EXPECT_THAT(error_with_flipped(at, bytes[at], mask), is_refused) << "byte " << at << ", mask " << mask;
    };
    for (std::size_t at = 0; at < bytes.size(); ++at)
        if (at % all_bits_every == 0)
            for (int bit = 0; bit < 8; ++bit) expect_refused(at, 1 << bit);
        else
            expect_refused(at, 1 << random() % 8);
    EXPECT_EQ(error(), "no InputError") << "undamaged";
}

TEST_F(DamagedFile, IsRefusedWithAnyStretchZeroed) {
    const std::string bytes = contents(path_);
    std::mt19937 random(2);
    int changed = 0;
    for (int trial = 0; trial < 1000; ++trial) {
        std::string damaged = bytes;
        const std::size_t at = random() % bytes.size();
        const std::size_t length = std::min<std::size_t>(bytes.size() - at, 1 + random() % 5000);
        damaged.replace(at, length, length, '\0');
        if (damaged == bytes) continue;
        ++changed;
        EXPECT_THAT(error_with(damaged), is_refused) << "from byte " << at;
    }
    EXPECT_GT(changed, 500);
}

TEST_F(DamagedFile, IsRefusedCutOffAnywhere) {
    for (std::uintmax_t length = fs::file_size(path_); length-- > 0;) {
        fs::resize_file(path_, length);
        EXPECT_THAT(error(), is_refused) << length;
    }
}

TEST_F(DamagedFile, IsRefusedWithBytesAtItsEnd) {
    const std::string bytes = contents(path_);
    for (const std::string& more : {std::string(1, '\0'), std::string("x"), std::string(5000, '\0'), bytes})
        EXPECT_THAT(error_with(bytes + more), HasSubstr("the file is damaged: it has")) << more.size();
}

TEST_F(DamagedFile, NamesTheDamagedPart) {
    const std::string bytes = contents(path_);
    const auto flipped = [&](std::size_t at) { return error_with_flipped(at, bytes[at], 1); };
    EXPECT_THAT(flipped(bytes.find("interflect solution")), HasSubstr("the checksum of /description differs"));
    EXPECT_THAT(flipped(checksum_block_size), HasSubstr("the checksum of structure differs"));
    EXPECT_THAT(flipped(checksum_block_size - 1), HasSubstr("the checksum of its table of checksums differs"));
    EXPECT_THAT(error_with(bytes.substr(0, bytes.size() - 1)), HasSubstr("it ends early"));
}

/// A file of the newest version must not pass for an old file without checksums.
TEST_F(DamagedFile, IsRefusedWithoutItsChecksums) {
    EXPECT_THAT(error_with(contents(path_).substr(checksum_block_size)), HasSubstr("its checksums are missing"));
}

}  // namespace
}  // namespace interflect
