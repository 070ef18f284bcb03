#include "interflect/base/files/pending_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>

#include "interflect/core.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
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
        EXPECT_EQ(entries(folder.path()), 0);  // a process killed in a long solve leaves no file
        write(file.temporary_path(), "half");
        EXPECT_EQ(entries(folder.path()), 1);
    }
    EXPECT_EQ(entries(folder.path()), 0);
}

TEST(PendingFile, CreatesItsFileWithoutFollowingALink) {
    const TemporaryFolder folder;
    const fs::path victim = folder.write("victim", "old");
    PendingFile file(folder.path() / "out.csv");
    const fs::path predicted = file.temporary_path();
    fs::create_symlink(victim, predicted);
    file.write_by([&](const fs::path& path) {
        EXPECT_FALSE(fs::is_symlink(path));
        write(path, "new");
    });
    file.commit();
    EXPECT_EQ(contents(victim), "old");
    EXPECT_EQ(contents(folder.path() / "out.csv"), "new");
}

TEST(PendingFile, NamesTheFinalFileAndTheReason) {
    const TemporaryFolder folder;
    PendingFile file(folder.path() / "out.csv");
    const auto fault_of = [&](const std::string& inner) -> std::string {
        try {
            file.write_by([&](const fs::path& path) {
                throw std::runtime_error(inner.empty() ? "cannot write '" + path.string() + "': No space" : inner);
            });
        } catch (const std::runtime_error& e) {
            return e.what();
        }
        return "no error";
    };
    const std::string expected = "cannot write '" + (folder.path() / "out.csv").string() + "': ";
    EXPECT_EQ(fault_of(""), expected + "No space");
    EXPECT_EQ(fault_of("HDF5: too long"), expected + "HDF5: too long");
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

TEST(PendingFile, ReplacesWhatALinkLeadsToAndNotTheLink) {
    const TemporaryFolder folder;
    const fs::path target = folder.write("target.h5", "old"), link = folder.path() / "link.h5";
    fs::create_directory(folder.path() / "links");
    fs::create_symlink("target.h5", link);
    fs::create_symlink("../link.h5", folder.path() / "links/to-link.h5");
    PendingFile file(folder.path() / "links/to-link.h5");
    EXPECT_EQ(file.temporary_path().extension(), ".h5");
    write(file.temporary_path(), "new");
    file.commit();
    EXPECT_TRUE(fs::is_symlink(link));
    EXPECT_TRUE(fs::is_symlink(folder.path() / "links/to-link.h5"));
    EXPECT_EQ(contents(target), "new");
}

TEST(PendingFile, MakesTheFileThatALinkLeadsTo) {
    const TemporaryFolder folder;
    fs::create_symlink("made.h5", folder.path() / "link.h5");
    PendingFile file(folder.path() / "link.h5");
    write(file.temporary_path(), "new");
    file.commit();
    EXPECT_TRUE(fs::is_symlink(folder.path() / "link.h5"));
    EXPECT_EQ(contents(folder.path() / "made.h5"), "new");
}

TEST(PendingFile, RefusesALoopOfLinks) {
    const TemporaryFolder folder;
    fs::create_symlink("b.h5", folder.path() / "a.h5");
    fs::create_symlink("a.h5", folder.path() / "b.h5");
    EXPECT_THAT(error_for(folder.path() / "a.h5"), HasSubstr("loop"));
}

TEST(PendingFile, WritesDevicesInPlace) {
    ASSERT_TRUE(fs::is_character_file("/dev/null"));
    PendingFile file("/dev/null");
    write(file.temporary_path(), "new");
    file.commit();
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
    EXPECT_FALSE(fs::exists(file.temporary_path()));

    ASSERT_TRUE(fs::is_character_file("/dev/full"));
    PendingFile full("/dev/full");
    write(full.temporary_path(), "new");
    EXPECT_THROW(full.commit(), std::runtime_error);
    EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST(PendingFile, WritesIntoPipes) {
    const TemporaryFolder folder;
    const fs::path pipe = folder.path() / "pipe";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    const std::string sent(200'000, 'x');  // exceeds the capacity of a pipe
    std::string received;
    std::thread reader([&] { received = contents(pipe); });
    PendingFile file(pipe);
    write(file.temporary_path(), sent);
    file.commit();
    reader.join();
    EXPECT_EQ(received, sent);
    EXPECT_TRUE(fs::is_fifo(pipe));
}

TEST(PendingFile, MayBeTwoOfOneStem) {
    const TemporaryFolder folder;
    const PendingFile a(folder.path() / "out.h5"), b(folder.path() / "out.h5");
    EXPECT_NE(a.temporary_path(), b.temporary_path());
}

TEST(PendingFile, RemovesWhatKilledProcessesLeft) {
    const TemporaryFolder folder;
    const auto left_by = [&](pid_t process) {
        fs::path path = PendingFile(folder.path() / "out.h5").temporary_path();
        std::string name = path.filename().string();
        const std::string own = "-" + std::to_string(::getpid()) + "-";
        name.replace(name.find(own), own.size(), "-" + std::to_string(process) + "-");
        path.replace_filename(name);
        write(path, "half");
        return path;
    };
    const pid_t ended = ::fork();
    if (ended == 0) ::_exit(0);
    ASSERT_EQ(::waitpid(ended, nullptr, 0), ended);
    const fs::path of_ended = left_by(ended), of_parent = left_by(::getppid());
    const fs::path other = folder.write(".interflect-elsewhere-1-0.part.h5", "of another host"),
                   unlike = folder.write(".interflect-notes", "no temporary file");
    const PendingFile next(folder.path() / "other.png");
    EXPECT_FALSE(fs::exists(of_ended));
    for (const fs::path& kept : {of_parent, other, unlike}) EXPECT_TRUE(fs::exists(kept)) << kept;
}

TEST(PendingFile, IsRemovedFromASignalHandler) {
    const TemporaryFolder folder;
    PendingFile first(folder.path() / "out.h5");
    const PendingFile moved = std::move(first), second(folder.path() / "out.png");
    write(moved.temporary_path(), "half");
    write(second.temporary_path(), "half");
    remove_temporary_files();
    EXPECT_EQ(entries(folder.path()), 0);
}

TEST(PendingFile, TakesTheLongestNamesThereAre) {
    const TemporaryFolder folder;
    for (const std::string& name : {std::string(255, 'n'), std::string(200, 'n') + "." + std::string(54, 'e')}) {
        PendingFile file(folder.path() / name);
        write(file.temporary_path(), "new");
        file.commit();
        EXPECT_EQ(contents(folder.path() / name), "new");
    }
}

TEST(PendingFile, RefusesNamesThatAreTooLong) {
    const TemporaryFolder folder;
    EXPECT_THAT(error_for(folder.path() / std::string(300, 'n')), testing::EndsWith("': File name too long"));
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
    EXPECT_THAT(error_for("/proc/out.h5"), HasSubstr("cannot write '/proc/out.h5'"));  // even for root
}

}  // namespace
}  // namespace interflect
