#include "interflect/cluster/fingerprint.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <vector>

#include "interflect/base/files/crc32.h"
#include "interflect/base/sums/rank_sums.h"

namespace interflect::detail {

namespace {

std::string content_of(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

Fingerprint Fingerprint::of_this_process() {
    const std::string program = content_of("/proc/self/exe"), processor = content_of("/proc/cpuinfo");
    const std::size_t flags = processor.find("flags");
    const std::string instructions =
        flags == std::string::npos ? "" : processor.substr(flags, processor.find('\n', flags) - flags);
    const std::string command_line = content_of("/proc/self/cmdline");  // each argument ends in a zero
    const std::string arguments = command_line.substr(std::min(command_line.find('\0'), command_line.size()));
    return {crc32(program), crc32(instructions), crc32(arguments)};
}

std::string difference_among(Ranks& ranks, const Fingerprint& own) {
    const std::vector<Fingerprint> all = gather_over_ranks<Fingerprint>(ranks, std::span(&own, 1));
    for (std::size_t r = 1; r < all.size(); ++r) {
        if (all[r].program != all[0].program)
            return fmt::format(
                "process {} runs another build of Interflect than process 0: start the same file everywhere", r);
        if (all[r].instructions != all[0].instructions)
            return fmt::format(
                "process {} has a processor with other instructions than process 0, so results would differ: use "
                "machines of one type",
                r);
        if (all[r].arguments != all[0].arguments)
            return fmt::format(
                "process {} has other arguments than process 0: start all processes with one command line, as in "
                "`mpirun -n {} interflect solve ...`",
                r, all.size());
    }
    return {};
}

}  // namespace interflect::detail
