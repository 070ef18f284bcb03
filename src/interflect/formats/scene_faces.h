#pragma once

#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "interflect/formats/location.h"
#include "interflect/load.h"
#include "interflect/scene.h"
#include "interflect/scene/core.h"

namespace interflect::detail {

/// More patches than ReadOptions::max_patches.
struct PatchLimit : std::invalid_argument {
    using std::invalid_argument::invalid_argument;
};

/// Adds faces relative to the scene's origin and records omitted ones. Throws std::invalid_argument for invalid
/// requests.
class SceneFaces {
  public:
    /// @param scene  With name and origin.
    SceneFaces(Scene& scene, const ReadOptions& options) : scene_(scene), max_patches_(options.max_patches) {}

    /// @throws PatchLimit beyond the limit, to which omitted faces count.
    void require_room(double patches) const;
    /// Returns a world position [m] relative to the scene's origin.
    V3f position(const Imath::V3d& world) const;
    /// Sets the unrounded world outline of the next face.
    void place(std::span<const Imath::V3d> outline);
    /// Omits faces without area; see add_polygon().
    void add(std::span<const std::vector<std::uint32_t>> loops, std::uint32_t material, std::uint32_t object,
             bool two_sided, const Location& where);
    /// @param message  Kind of face.
    void leave_out(const std::string& message, const Location& where);

    Imath::V3d suitable_origin() const { return origin_for(core_of(sample_.faces())); }
    /// @throws InputError if no face is left, if a large distant one was lost to rounding, or if the scene is too
    /// small, too dark or too bright.
    void require_usable() const;

  private:
    struct LostFace {
        double width = 0;  // area over longest extent [m]
        Imath::V3d centre{0, 0, 0};
        Location where;
    };
    struct LeftOut {
        std::string message;
        Location where;
    };
    void require_width() const;
    void require_precision() const;
    void require_patches() const;

    Scene& scene_;
    std::uint64_t max_patches_;
    FaceSample sample_;
    LostFace placed_;  // next face; width 0 without area
    LostFace lost_;    // widest one lost to rounding
    LeftOut first_left_out_;
    std::uint64_t left_out_ = 0;
};

}  // namespace interflect::detail
