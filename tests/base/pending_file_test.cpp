#include "interflect/base/pending_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <optional>
#include <utility>

#include "interflect/base/error.h"
#include "tests/support/scenes.h"

namespace interflect {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing_support::TemporaryFolder;

void write(const fs::path& path, const std::string& text) { std::ofstream(path) << text; }

std::string contents(const fs::path& path) {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), {}};
}

std::ptrdiff_t entries(const fs::path& folder) {
    return std::distance(fs::directory_iterator(folder), fs::directory_iterator());
}

std::string error_for(const fs::path& path) {
    try {
        const PendingFile file(path);
    } catch (const InputError& e) {
        return e.what();
    }
    return "no InputError";
}

TEST(PendingFile, AppearsOnlyOnceItIsCommitted) {
    const TemporaryFolder folder;
    const fs::path path = folder.path() / "out.h5";
    PendingFile file(path);
    write(file.temporary_path(), "new");
    EXPECT_FALSE(fs::exists(path));
    EXPECT_EQ(file.temporary_path().extension(), ".h5");
    EXPECT_EQ(file.temporary_path().parent_path(), folder.path());
    file.commit();
    EXPECT_EQ(contents(path), "new");
    EXPECT_EQ(entries(folder.path()), 1);
}

TEST(PendingFile, LeavesNothingWhenAbandoned) {
    const TemporaryFolder folder;
    {
        const PendingFile file(folder.path() / "out.h5");
        EXPECT_EQ(entries(folder.path()), 0);  // so that nothing is left by a process that is killed in a long solve
        write(file.temporary_path(), "half");
        EXPECT_EQ(entries(folder.path()), 1);
    }
    EXPECT_EQ(entries(folder.path()), 0);
}

TEST(PendingFile, KeepsTheOldFileUntilCommitted) {
    const TemporaryFolder folder;
    const fs::path path = folder.write("out.h5", "old");
    {
        const PendingFile abandoned(path);
        write(abandoned.temporary_path(), "half");
    }
    EXPECT_EQ(contents(path), "old");
    PendingFile file(path);
    write(file.temporary_path(), "new");
    file.commit();
    EXPECT_EQ(contents(path), "new");
}

TEST(PendingFile, MayBeMoved) {
    const TemporaryFolder folder;
    std::optional<PendingFile> file(std::in_place, folder.path() / "out.h5");
    write(file->temporary_path(), "new");
    PendingFile moved = std::move(*file);
    file.reset();
    EXPECT_EQ(entries(folder.path()), 1);
    moved.commit();
    EXPECT_TRUE(fs::exists(folder.path() / "out.h5"));
}

TEST(PendingFile, RefusesAFolder) {
    const TemporaryFolder folder;
    EXPECT_THAT(error_for(folder.path()), HasSubstr("names a folder"));
    EXPECT_THAT(error_for(folder.path() / "new" / ""), HasSubstr("names a folder"));
    EXPECT_THAT(error_for(""), HasSubstr("cannot write"));
}

TEST(PendingFile, RefusesAMissingFolder) {
    const TemporaryFolder folder;
    const std::string message = error_for(folder.path() / "missing" / "out.h5");
    EXPECT_THAT(message, HasSubstr("there is no folder '" + (folder.path() / "missing").string() + "'"));
}

TEST(PendingFile, RefusesAFolderInWhichItCannotWrite) {
    EXPECT_THAT(error_for("/proc/out.h5"), HasSubstr("cannot write '/proc/out.h5'"));  // not even root can
}

}  // namespace
}  // namespace interflect
