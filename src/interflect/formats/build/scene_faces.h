#pragma once

#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "interflect/formats/reading/location.h"
#include "interflect/load.h"
#include "interflect/scene.h"
#include "interflect/scene/core/core.h"

namespace interflect::detail {

/// Adds faces relative to the scene's origin. Throws std::invalid_argument for invalid requests.
class SceneFaces {
  public:
    /// @param scene  It must have its name and origin.
    SceneFaces(Scene& scene, const ReadOptions& options) : scene_(scene), max_patches_(options.max_patches) {}

    /// @throws ReadFault if the scene, with its omitted faces, has no room for `patches` more patches.
    void require_room(double patches) const;
    /// Returns a position relative to the scene's origin [m].
    V3f position(const Imath::V3d& world) const;
    /// Sets the unrounded outline of the next face.
    void place(std::span<const Imath::V3d> outline);
    /// Adds the face unless it has no area; see add_polygon().
    void add(std::span<const std::vector<std::uint32_t>> loops, std::uint32_t material, std::uint32_t object,
             bool two_sided, const Location& where);
    void leave_out(const std::string& message, const Location& where);

    Imath::V3d suitable_origin() const { return origin_for(core_of(sample_.faces())); }
    /// @throws InputError for no faces, a large face that rounding removed, or a size or brightness out of range.
    void require_usable() const;

  private:
    struct LostFace {
        double width = 0;  // doubled area over diagonal [m]
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
    LostFace placed_;  // the next face
    LostFace lost_;    // widest face that rounding removed
    LeftOut first_left_out_;
    std::uint64_t left_out_ = 0;
};

}  // namespace interflect::detail
