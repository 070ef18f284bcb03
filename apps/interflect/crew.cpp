#include "apps/interflect/crew.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "apps/interflect/commands.h"
#include "apps/interflect/threads.h"
#include "interflect/base/crc32.h"
#include "interflect/base/pending_file.h"
#include "interflect/base/rank_sums.h"
#include "interflect/ray_caster.h"
#include "interflect/render/light_help.h"
#include "interflect/solution.h"

namespace interflect::command {

namespace {

std::shared_ptr<Ranks> crew;

/// Command of the first process to the others.
struct Order {
    enum class Kind { solve, advance, plan, end_of_run, light, dismiss } kind;
    Limits limits = {};
    std::size_t bytes = 0;  ///< Size of the solution file that follows.
    int threads = 0;
};

template <class T>
std::span<std::byte> bytes_of(T& value) {
    return std::as_writable_bytes(std::span(&value, 1));
}

void give(Order order) {
    if (crew) crew->broadcast(bytes_of(order));
}

Order receive_order() {
    Order order{};
    crew->broadcast(bytes_of(order));
    return order;
}

/// A file of this process alone, removed with this.
class ScratchFile {
  public:
    ScratchFile()
        : file_(std::filesystem::temp_directory_path() / ("interflect-" + std::to_string(::getpid()) + ".h5")) {}
    const std::filesystem::path& path() const { return file_.temporary_path(); }

  private:
    detail::PendingFile file_;  // never committed
};

/// Sends an order and a solution file.
void give_file(Order order, const std::function<void(const std::filesystem::path&)>& write) {
    const ScratchFile file;
    write(file.path());
    Ranks::Bytes bytes(std::filesystem::file_size(file.path()));
    std::ifstream(file.path(), std::ios::binary)
        .read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    const auto threads =
        static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
    order.threads = threads < tbb::info::default_concurrency() ? threads : 0;
    order.bytes = bytes.size();
    give(order);
    crew->broadcast(bytes);
}

/// Returns read(path) of the file that follows an order.
template <class Read>
auto receive_file(std::size_t size, const Read& read) {
    Ranks::Bytes bytes(size);
    crew->broadcast(bytes);
    const ScratchFile file;
    std::ofstream(file.path(), std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(size));
    return read(file.path());
}

void serve_light(const Order& order) {
    const ThreadLimit threads(order.threads);
    const SolvedScene solved = receive_file(order.bytes, read_solution);
    const RayCaster ray_caster(solved.scene);
    help_with_light(solved.scene, &solved.solution, ray_caster, *crew);
}

void serve_run(const Order& order) {
    const ThreadLimit threads(order.threads);
    Solver solver = receive_file(order.bytes, Solver::open);
    for (Order next = receive_order(); next.kind != Order::Kind::end_of_run; next = receive_order()) {
        if (next.kind == Order::Kind::advance)
            solver.advance(next.limits, {.on_progress = {}, .ranks = crew.get()});
        else if (next.kind == Order::Kind::light)
            serve_light(next);
        else
            solver.set_plan(next.limits);
    }
}

std::string content_of(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// Results have equal bits if the program and the instruction set of the processor are equal (libraries use the
/// latter).
struct Fingerprint {
    std::uint32_t program, instructions;
    bool operator==(const Fingerprint&) const = default;
};

Fingerprint fingerprint() {
    const std::string program = content_of("/proc/self/exe"), processor = content_of("/proc/cpuinfo");
    const std::size_t flags = processor.find("flags");
    const std::string instructions =
        flags == std::string::npos ? "" : processor.substr(flags, processor.find('\n', flags) - flags);
    return {detail::crc32(program), detail::crc32(instructions)};
}

void require_equal_processes(Ranks& ranks) {
    const Fingerprint own = fingerprint();
    const std::vector<Fingerprint> all = detail::gather_over_ranks<Fingerprint>(ranks, std::span(&own, 1));
    for (std::size_t r = 1; r < all.size(); ++r) {
        if (all[r].program != all[0].program)
            throw std::runtime_error(fmt::format(
                "process {} runs another build of Interflect than process 0: start the same file everywhere", r));
        if (all[r].instructions != all[0].instructions)
            throw std::runtime_error(fmt::format(
                "process {} has a processor with other instructions than process 0, so results would differ: "
                "use machines of one type",
                r));
    }
}

}  // namespace

bool join_crew() {
    crew = join_ranks();
    if (crew) require_equal_processes(*crew);
    return !crew || crew->rank() == 0;
}

void abort_crew(int exit_code) {
    if (crew && crew->count() > 1) crew->abort(exit_code);
}

void serve_crew() {
    for (Order order = receive_order(); order.kind != Order::Kind::dismiss; order = receive_order())
        order.kind == Order::Kind::light ? serve_light(order) : serve_run(order);
    crew.reset();
}

void dismiss_crew() {
    give({.kind = Order::Kind::dismiss});
    crew.reset();
}

Ranks* start_light_help(const std::function<void(const std::filesystem::path&)>& write) {
    if (!crew || crew->count() == 1) return nullptr;
    give_file({.kind = Order::Kind::light}, write);
    return crew.get();
}

CrewRun::CrewRun(Solver& solver) : solver_(solver) {
    if (!crew) return;
    if (const Method& method = solver.options().method; crew->count() > 1 && !method.shares_rays)
        spdlog::warn("{} does not divide its rays: each of the {} processes does all the work", method.name,
                     crew->count());
    give_file({.kind = Order::Kind::solve}, [&](const std::filesystem::path& path) { solver.save(path); });
}

CrewRun::~CrewRun() { give({.kind = Order::Kind::end_of_run}); }

AdvanceReport CrewRun::advance(const Limits& limits, Monitor monitor) try {
    give({.kind = Order::Kind::advance, .limits = limits});
    monitor.ranks = crew.get();
    return solver_.advance(limits, monitor);
} catch (const std::exception& e) {
    if (crew) spdlog::error("{}", e.what());
    abort_crew(failed);  // the others wait for this process in the midst of their work
    throw;
}

void CrewRun::set_plan(const Limits& limits) {
    solver_.set_plan(limits);  // first: it may throw
    give({.kind = Order::Kind::plan, .limits = limits});
}

}  // namespace interflect::command
