// A damaged saved run is refused and never crashes the reader. Seen to fail when Solver::open() reads a file without
// comparing its checksums, and when it passes on other exceptions than InputError.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "interflect/core.h"
#include "interflect/exports/hdf5/checksums.h"
#include "interflect/exports/records/json_text.h"
#include "interflect/solver.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;
namespace fs = std::filesystem;
using testing::AllOf;
using testing::AnyOf;
using testing::HasSubstr;

/// In bytes.
struct Place {
    std::size_t begin, size;
};

class DamagedRun : public testing::Test {
  protected:
    DamagedRun() {
        Scene scene = closed_box({1, 2, 3}, 2, {{"wall", Rgb(0.5f), Rgb(1)}});
        SolveOptions options{.method = find_method("ihsrr")};
        options.views = {{{"inside", {0.5, 0.5, 0.5}, {1, 0.5, 0.5}, {0, 0, 1}, 60}}};
        options.limits.rays = 20'000;
        options.importance.camera_rays = 1000;
        Solver solver(std::move(scene), options);
        solver.advance({.rays = 10'000});
        solver.save(path_);
        std::ifstream file(path_, std::ios::binary);
        bytes_ = {std::istreambuf_iterator<char>(file), {}};
    }

    /// Returns the message of Solver::open(); empty if it opens. Does not catch other exceptions than InputError.
    std::string error() const {
        try {
            Solver::open(path_);
        } catch (const InputError& e) {
            return e.what();
        }
        return "";
    }

    void write(const std::string& bytes) const { std::ofstream(path_, std::ios::binary | std::ios::trunc) << bytes; }

    void write_flipped(std::size_t at, std::size_t bit) const {
        std::string damaged = bytes_;
        damaged[at] = static_cast<char>(damaged[at] ^ (1 << bit));
        write(damaged);
    }

    Place place_of(const char* array) const {
        write(bytes_);
        const hid_t file = H5Fopen(path_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT),
                    set = H5Dopen2(file, array, H5P_DEFAULT);
        const Place place{H5Dget_offset(set), H5Dget_storage_size(set)};
        H5Dclose(set);
        H5Fclose(file);
        return place;
    }

    const TemporaryFolder folder_;
    const fs::path path_ = folder_.path() / "run.h5";
    std::string bytes_;
};

TEST_F(DamagedRun, IsRefusedWithAnyByteFlipped) {
    EXPECT_EQ(error(), "") << "undamaged";
    for (const std::uint32_t seed : {1u, 2u, 3u}) {
        std::mt19937 random(seed);
        for (int trial = 0; trial < 100; ++trial) {
            const std::size_t at = random() % bytes_.size(), bit = random() % 8;
            write_flipped(at, bit);
            EXPECT_THAT(error(), AnyOf(HasSubstr("the file is damaged: "), HasSubstr("not a solution file")))
                << "byte " << at << ", bit " << bit;
        }
    }
}

TEST_F(DamagedRun, IsRefusedWithoutItsStateOrAPartOfIt) {
    for (const char* part : {"/state", "/state/index", "/state/bytes"}) {
        write(bytes_);
        const hid_t file = H5Fopen(path_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
        ASSERT_GE(H5Ldelete(file, part, H5P_DEFAULT), 0);
        H5Fclose(file);
        write_checksums(path_, {});
        EXPECT_THAT(error(), HasSubstr("a run that cannot go on: ")) << part;
    }
}

/// Place of each array of the state in the file, by name.
std::map<std::string, Place> arrays_of_state(const std::string& bytes, Place index, Place content) {
    std::map<std::string, Place> places;
    const Json json = parse_json_text(bytes.substr(index.begin, index.size));
    for (const Json& array : json.at("arrays")) {
        places[array.at(0).get<std::string>()] = {content.begin, array.at(1).get<std::size_t>()};
        content.begin += array.at(1).get<std::size_t>();
    }
    return places;
}

// Negative counts, numbers that are not finite, and truth values above 1. Fails when any of these arrays is read
// unchecked. The exceptions count without a sign, and choose points or keys only.
TEST_F(DamagedRun, IsRefusedWithNumbersOutOfRangeInAnyArray) {
    const std::set<std::string> any_number{"points/used", "points/used_by_parts", "points/allocations", "view/rounds"};
    const auto places = arrays_of_state(bytes_, place_of("/state/index"), place_of("/state/bytes"));
    EXPECT_GT(places.size(), 40u);
    for (const auto& [name, place] : places) {
        if (place.size == 0 || any_number.contains(name)) continue;
        std::string damaged = bytes_;
        std::fill_n(damaged.begin() + static_cast<std::ptrdiff_t>(place.begin), place.size, '\xff');
        write(damaged);
        write_checksums(path_, {});
        EXPECT_THAT(error(), HasSubstr("a run that cannot go on: ")) << name;
    }
}

// Without checks of the schedule, the run never ended.
TEST_F(DamagedRun, IsRefusedWithAnAbsurdSchedule) {
    const auto places = arrays_of_state(bytes_, place_of("/state/index"), place_of("/state/bytes"));
    const std::vector<std::pair<const char*, std::int64_t>> absurd{
        {"schedule/budget", 0},
        {"schedule/budget", std::numeric_limits<std::int64_t>::min()},
        {"schedule/first_rays", 0},
        {"schedule/first_rays", std::int64_t{1} << 40},
        {"schedule/smallest", 1},
        {"schedule/smallest", std::int64_t{1} << 60},
        {"schedule/rays", -1'000'000'000'000'000'000},
        {"schedule/rays", std::numeric_limits<std::int64_t>::max()},
        {"schedule/averaged_rays", std::int64_t{1} << 50},
        {"schedule/averaged_at_restart", std::int64_t{1} << 50},
        {"schedule/planned_after", std::int64_t{1} << 50},
    };
    for (const auto& [name, number] : absurd) {
        std::string damaged = bytes_;
        std::memcpy(&damaged[places.at(name).begin], &number, sizeof number);
        write(damaged);
        write_checksums(path_, {});
        EXPECT_THAT(error(), AllOf(HasSubstr("a run that cannot go on: "), HasSubstr(name))) << number;
    }
}

// Damage that the checksums include, so they do not detect it. Most such runs open, and are wrong.
TEST_F(DamagedRun, NeverCrashesWhateverItsStateSays) {
    std::mt19937 random(1);
    int refused = 0;
    for (const char* array : {"/state/index", "/state/bytes"}) {
        const Place place = place_of(array);
        for (int trial = 0; trial < 100; ++trial) {
            write_flipped(place.begin + random() % place.size, random() % 8);
            write_checksums(path_, {});
            refused += !error().empty();
        }
    }
    EXPECT_GT(refused, 50);
}

}  // namespace
}  // namespace interflect
