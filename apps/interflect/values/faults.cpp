#include "apps/interflect/values/faults.h"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <mutex>
#include <new>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "interflect/base/files/escapes.h"
#include "interflect/base/memory/machine_memory.h"
#include "interflect/core.h"

namespace interflect::command {

namespace {

std::mutex mutex;
std::filesystem::path last_checkpoint;

/// Command line options by Fault::setting.
constexpr std::array<std::pair<std::string_view, const char*>, 3> allowing_options = {
    {{"max_patches", "--max-patches"},
     {"outside_files", "--outside-files"},
     {"texels_per_metre", "--texels-per-metre"}}};

std::string explanation(const InputError& error) {
    for (const auto& [setting, option] : allowing_options)
        if (error.fault().setting == setting) return fmt::format("{}; see {}", error.what(), option);
    return error.what();
}

}  // namespace

std::string explanation(const std::exception& error) {
    if (const auto* input = dynamic_cast<const InputError*>(&error)) return explanation(*input);
    // std::length_error: an array beyond the address space.
    if (!dynamic_cast<const std::bad_alloc*>(&error) && !dynamic_cast<const std::length_error*>(&error))
        return error.what();
    return fmt::format(
        "not enough memory: the limits of this process (its machine, ulimit -v, control groups) leave {} MiB. "
        "Less is needed by a smaller picture (--size), a coarser lightmap (--texels-per-metre), fewer elements "
        "(--memory, --mesh-size) and a scene of fewer faces (--curve-divisions, --max-patches)",
        detail::usable_memory() >> 20);
}

void set_last_checkpoint(const std::filesystem::path& file) {
    const std::lock_guard lock(mutex);
    last_checkpoint = file;
}

void report_fault(const std::string& fault) {
    const std::lock_guard lock(mutex);
    const std::string remedy =
        last_checkpoint.empty()
            ? "there is no checkpoint"
            : fmt::format("`interflect resume {}` goes on from the last checkpoint", last_checkpoint.string());
    fmt::print(stderr, "error: {}; all processes end; {}\n", detail::escaped(fault), detail::escaped(remedy));
    std::fflush(stderr);
}

std::string name_of_process(int rank) {
    std::array<char, 256> host{};
    ::gethostname(host.data(), host.size() - 1);
    return fmt::format("process {} on {}", rank, host.data());
}

}  // namespace interflect::command
