// Processes that would not have the same bits. Seen to fail if only neighbours or only programs are compared.

#include "interflect/cluster/fingerprint.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/support/thread_ranks.h"

namespace interflect::detail {
namespace {

using testing::AllOf;
using testing::Each;
using testing::HasSubstr;

/// Returns the result in each of these processes.
std::vector<std::string> differences(const std::vector<Fingerprint>& of_ranks) {
    std::vector<std::string> found(of_ranks.size());
    testing_support::ThreadRanks(static_cast<int>(of_ranks.size())).run([&](Ranks& ranks) {
        const auto rank = static_cast<std::size_t>(ranks.rank());
        found[rank] = difference_among(ranks, of_ranks[rank]);
    });
    return found;
}

TEST(Fingerprint, IsTheSameForEqualProcesses) {
    const Fingerprint own = Fingerprint::of_this_process();
    EXPECT_THAT(differences({own, own, own}), Each(""));
}

TEST(Fingerprint, ShowsAnotherBuild) {
    EXPECT_THAT(differences({{1, 7, 5}, {1, 7, 5}, {2, 7, 5}}),
                Each(AllOf(HasSubstr("process 2"), HasSubstr("another build"))));
}

TEST(Fingerprint, ShowsAnotherProcessor) {
    EXPECT_THAT(differences({{1, 7, 5}, {1, 8, 5}, {1, 7, 5}}),
                Each(AllOf(HasSubstr("process 1"), HasSubstr("other instructions"))));
}

TEST(Fingerprint, ShowsOtherArguments) {
    EXPECT_THAT(differences({{1, 7, 5}, {1, 7, 5}, {1, 7, 6}}),
                Each(AllOf(HasSubstr("process 2"), HasSubstr("other arguments"), HasSubstr("mpirun -n 3"))));
}

}  // namespace
}  // namespace interflect::detail
