#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

#include "interflect/base/threads/stop_request.h"
#include "interflect/ranks.h"
#include "interflect/render/rays/path_plan.h"
#include "interflect/render/rays/sample_batch.h"
#include "interflect/render/reflections/virtual_lights.h"

namespace interflect::detail {

/// Batches of the paths of a picture, traced by all ranks in tiles. Rank 0 chooses the batches and alone receives their
/// light; the others help(). So time, stops and adaptive sampling are decisions of rank 0, and only it stores the
/// picture. A tile has the same batches for any number of ranks.
class SharedBatches {
  public:
    /// @param virtual_lights  Of `plan`; may be null. @param ranks  Null: this process alone.
    SharedBatches(const PathPlan& plan, VirtualLights* virtual_lights, Ranks* ranks)
        : plan_(plan), virtual_lights_(virtual_lights), ranks_(ranks) {}

    /// Paths of one trace(), enough to occupy all processes.
    static std::size_t paths_at_once(const Ranks* ranks);
    bool is_helper() const { return ranks_ && ranks_->rank() != 0; }

    // Rank 0:

    /// Sets SampleBatch::done.
    /// @param is_over     Omits the remaining tiles of this process; called once per tile.
    /// @param is_limited  The other ranks omit tiles after PictureOptions::time.
    RayCounts trace(std::span<SampleBatch> batches, const std::function<bool()>& is_over, bool is_limited);
    /// Later batches are lit by another set of virtual lights. Returns its number of rays; 0 without virtual lights.
    std::int64_t renew_virtual_lights();
    /// Ends help() and waits until all ranks are there: a picture without the light of one is not usable.
    void end();

    // Other ranks:

    /// Traces the tiles of this rank until end(). @param time_left  As PictureOptions::time.
    void help(const StopRequest& time_left);

  private:
    struct Key {
        std::uint32_t pixel, number, first_point, size;
    };
    struct Chunk {
        std::size_t batches = 0;         // 0: the end
        std::uint32_t light_set = none;  // of virtual lights
        bool is_limited = false;
    };
    RayCounts trace_own(std::span<SampleBatch> batches, const std::function<bool()>& is_over);

    const PathPlan& plan_;
    VirtualLights* virtual_lights_;
    Ranks* ranks_;
    std::uint32_t light_set_ = none;
};

}  // namespace interflect::detail
