#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "interflect/base/threads/parallel.h"
#include "interflect/base/threads/stop_request.h"
#include "interflect/ranks.h"
#include "interflect/render/paths/path_integrator.h"
#include "interflect/render/rays/nearby_light.h"
#include "interflect/render/rays/path_plan.h"
#include "interflect/render/rays/sample_batch.h"
#include "interflect/render/reflections/virtual_lights.h"

namespace interflect::detail {

/// Traces the batches of a picture in all ranks. Rank 0 chooses the batches and receives their light; the other ranks
/// call help(). So rank 0 alone handles time limits, stops and adaptive sampling, and only rank 0 stores the picture.
/// Batches are traced in tiles. A tile has the same batches for any number of ranks.
class SharedBatches {
  public:
    /// @param virtual_lights  The virtual lights of `plan`; may be null.
    /// @param ranks           Null: this process alone traces all batches.
    SharedBatches(const PathPlan& plan, VirtualLights* virtual_lights, Ranks* ranks)
        : virtual_lights_(virtual_lights), ranks_(ranks), integrators_([&plan] { return PathIntegrator(plan); }) {}

    /// Returns the number of paths to pass to one call of trace(), enough to occupy all processes.
    /// In hybrid shading it does not depend on their number, because batches of a tile share coefficients of
    /// DirectLight.
    static std::size_t paths_at_once(const PathPlan& plan, const Ranks* ranks);
    bool is_helper() const { return ranks_ && ranks_->rank() != 0; }

    // For rank 0:

    /// Traces the batches and sets SampleBatch::done.
    /// @param is_over     If it returns true, the remaining tiles of this process are omitted. Called once per tile.
    /// @param is_limited  Whether the other ranks omit tiles after PictureOptions::time.
    RayCounts trace(std::span<SampleBatch> batches, const std::function<bool()>& is_over, bool is_limited);
    /// Predicts the light of first hits by the samples around them, in later calls of trace().
    /// @param samples  Those of NearbyLight.
    void predict_by(int width, int height, std::vector<NearbyLight::Sample> samples);
    /// Replaces the virtual lights for later batches. Returns the number of rays for this; 0 without virtual lights.
    std::int64_t renew_virtual_lights();
    /// Ends help() in the other ranks, and waits until all of them have finished.
    void end();

    // For the other ranks:

    /// Traces the tiles of this rank until rank 0 calls end(). @param time_left  Limit given by PictureOptions::time.
    void help(const StopRequest& time_left);

  private:
    /// Fields of a SampleBatch that other ranks need to trace it.
    struct Key {
        std::uint32_t pixel, number, first_index, size;
        Tracing tracing;
    };
    /// Header of the message to the other ranks.
    struct Chunk {
        std::size_t batches = 0;         // number of batches; 0: the picture is finished, unless a NearbyLight follows
        int width = 0, height = 0;       // size of the picture if NearbyLight follows in place of batches, else 0
        std::uint32_t light_set = none;  // number of the set of virtual lights
        bool is_limited = false;
    };
    void receive_prediction(int width, int height);
    RayCounts trace_own(std::span<SampleBatch> batches, const std::function<bool()>& is_over);

    VirtualLights* virtual_lights_;
    Ranks* ranks_;
    PerThread<PathIntegrator> integrators_;
    std::uint32_t light_set_ = none;
    std::optional<NearbyLight> nearby_;
};

}  // namespace interflect::detail
