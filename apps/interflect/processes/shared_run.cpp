#include "apps/interflect/processes/shared_run.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <tbb/global_control.h>
#include <tbb/info.h>

#include <chrono>
#include <cstddef>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

#include "apps/interflect/commands/commands.h"
#include "apps/interflect/processes/signals.h"
#include "apps/interflect/processes/threads.h"
#include "apps/interflect/values/faults.h"
#include "interflect/cluster/fingerprint.h"
#include "interflect/exports/saved_run.h"
#include "interflect/ranks.h"
#include "interflect/ray_caster.h"
#include "interflect/render/shared_light.h"
#include "interflect/solution.h"

namespace interflect::command {

namespace {

std::shared_ptr<Ranks> ranks;

/// mpirun kills all processes two seconds after one has called for the end.
constexpr std::chrono::milliseconds time_to_end_processes{2500};

/// Order that the first process sends to the others.
struct Order {
    enum class Kind { solve, advance, plan, end_of_run, light, dismiss } kind;
    Limits limits = {};
    /// Sizes of the name of the checkpoint and of the run or solution, which follow.
    std::size_t name_bytes = 0, bytes = 0;
    int threads = 0;
    bool has_checkpoint = false;  ///< Whether the run was saved under this name.
};

template <class T>
std::span<std::byte> bytes_of(T& value) {
    return std::as_writable_bytes(std::span(&value, 1));
}

void send_order(Order order) {
    if (ranks) ranks->broadcast(bytes_of(order));
}

Order receive_order() {
    Order order{};
    ranks->broadcast(bytes_of(order));
    return order;
}

void send_text(std::string& text) { ranks->broadcast(std::as_writable_bytes(std::span(text))); }

std::string receive_text(std::size_t size) {
    std::string text(size, '\0');
    ranks->broadcast(std::as_writable_bytes(std::span(text)));
    return text;
}

/// Returns the limit of threads that --threads set, or 0 without a limit.
int limit_of_threads() {
    const auto threads =
        static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
    return threads < tbb::info::default_concurrency() ? threads : 0;
}

void serve_light(const Order& order) {
    const ThreadLimit threads(order.threads);
    const SolvedScene solved = detail::read_solution_image(receive_text(order.bytes));
    const RayCaster ray_caster(solved.scene);
    detail::share_light(solved.scene, &solved.solution, ray_caster, *ranks);
}

void serve_run(const Order& order) {
    const ThreadLimit threads(order.threads);
    const std::filesystem::path checkpoint = receive_text(order.name_bytes);
    Solver solver = Solver::open_image(receive_text(order.bytes));
    for (Order next = receive_order(); next.kind != Order::Kind::end_of_run; next = receive_order()) {
        if (next.kind == Order::Kind::advance) {
            set_last_checkpoint(next.has_checkpoint ? checkpoint : "");
            solver.advance(next.limits, {.on_progress = {}, .ranks = ranks.get()});
        } else if (next.kind == Order::Kind::light) {
            serve_light(next);
        } else {
            solver.set_plan(next.limits);
        }
    }
}

std::string difference_among_ranks() try {
    return detail::difference_among(*ranks, detail::Fingerprint::of_this_process());
} catch (const std::exception& e) {
    end_ranks_after_fault(e, failed);
    throw;
}

}  // namespace

Role connect_ranks() {
    if (launched_rank().value_or(0) > 0) ignore_stop_signals();
    ranks = join_ranks(report_fault);
    if (!ranks) return Role::first;
    const bool is_first = ranks->rank() == 0;
    if (!is_first) ignore_stop_signals();
    const std::string difference = difference_among_ranks();
    if (difference.empty()) return is_first ? Role::first : Role::other;
    if (is_first) {
        spdlog::error("{}", difference);  // before the others end, upon which mpirun ends this process
        ignore_stop_signals();
    }
    ranks.reset();
    return Role::refused;
}

void end_ranks_after_fault(const std::exception& error, int exit_code) {
    if (!ranks || ranks->count() == 1) return;
    // An error of all processes is reported by the first, which then ends the others.
    if (ranks->rank() > 0) std::this_thread::sleep_for(time_to_end_processes);
    report_fault(fmt::format("{}: {}", name_of_process(ranks->rank()), explanation(error)));
    ranks->abort(exit_code);
}

void serve_first_rank() {
    for (Order order = receive_order(); order.kind != Order::Kind::dismiss; order = receive_order())
        order.kind == Order::Kind::light ? serve_light(order) : serve_run(order);
    ranks.reset();
}

void dismiss_ranks() {
    send_order({.kind = Order::Kind::dismiss});
    ranks.reset();
}

Ranks* start_shared_light(const std::function<std::string()>& make_image) {
    if (!ranks || ranks->count() == 1) return nullptr;
    std::string image = make_image();
    send_order({.kind = Order::Kind::light, .bytes = image.size(), .threads = limit_of_threads()});
    send_text(image);
    return ranks.get();
}

SharedRun::SharedRun(Solver& solver, std::filesystem::path checkpoint)
    : solver_(solver), checkpoint_(std::move(checkpoint)) {
    if (!ranks) return;
    if (const Method& method = solver.options().method; ranks->count() > 1 && !method.shares_rays)
        spdlog::warn("{} does not divide its rays: each of the {} processes does all the work", method.name,
                     ranks->count());
    std::string run = solver.image(), name = checkpoint_.string();
    send_order(
        {.kind = Order::Kind::solve, .name_bytes = name.size(), .bytes = run.size(), .threads = limit_of_threads()});
    send_text(name);
    send_text(run);
}

SharedRun::~SharedRun() { send_order({.kind = Order::Kind::end_of_run}); }

AdvanceReport SharedRun::advance(const Limits& limits, Monitor monitor) try {
    std::error_code ignored;
    const bool has_checkpoint = has_advanced_ && std::filesystem::exists(checkpoint_, ignored);
    has_advanced_ = true;
    set_last_checkpoint(has_checkpoint ? checkpoint_ : "");
    send_order({.kind = Order::Kind::advance, .limits = limits, .has_checkpoint = has_checkpoint});
    monitor.ranks = ranks.get();
    return solver_.advance(limits, monitor);
} catch (const std::exception& e) {
    end_ranks_after_fault(e, failed);  // because the others wait for this process
    throw;
}

void SharedRun::set_plan(const Limits& limits) {
    solver_.set_plan(limits);  // comes first, because it may throw
    send_order({.kind = Order::Kind::plan, .limits = limits});
}

}  // namespace interflect::command
