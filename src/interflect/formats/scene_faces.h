#pragma once

#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "interflect/formats/location.h"
#include "interflect/read_options.h"
#include "interflect/scene.h"
#include "interflect/scene/core.h"

namespace interflect::inline detail {

/// The file requests more patches than ReadOptions::max_patches.
struct PatchLimit : std::invalid_argument {
    using std::invalid_argument::invalid_argument;
};

/// Adds the faces of a file to a scene relative to an origin, and records omitted faces. Throws std::invalid_argument
/// with a sentence for impossible requests.
class SceneFaces {
  public:
    /// @param scene  Must have its name and origin.
    SceneFaces(Scene& scene, const ReadOptions& options) : scene_(scene), max_patches_(options.max_patches) {}

    /// @throws PatchLimit  if `patches` more would exceed the limit. Omitted faces count as well.
    void require_room(double patches) const;
    /// Converts a world position [m] to one relative to the scene's origin.
    V3f position(const Imath::V3d& world) const;
    /// Sets the world position of the next face's outline, before rounding.
    void place(std::span<const Imath::V3d> outline);
    /// Adds a face like add_polygon(); omits a face without area.
    void add(std::span<const std::vector<std::uint32_t>> loops, std::uint32_t material, std::uint32_t object,
             bool two_sided, const Location& where);
    /// Records an omitted face. @param message  Describes the kind of face.
    void leave_out(const std::string& message, const Location& where);

    /// Returns the best origin for the faces placed so far.
    Imath::V3d suitable_origin() const { return origin_for(core_of(sample_.faces())); }
    /// @throws InputError  if the scene has no face, lost a large distant face to rounding, or is too small, too dark
    ///                     or too bright to compute.
    void require_usable() const;

  private:
    /// Face lost to rounding.
    struct LostFace {
        double width = 0;  // across its longest extent [m]
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
    LostFace placed_;  // the next face; width 0 if it has no area even before rounding
    LostFace lost_;    // the widest lost face
    LeftOut first_left_out_;
    std::uint64_t left_out_ = 0;
};

}  // namespace interflect::inline detail
