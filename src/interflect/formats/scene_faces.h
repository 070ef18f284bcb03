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

/// A file asks for more patches than ReadOptions::max_patches.
struct PatchLimit : std::invalid_argument {
    using std::invalid_argument::invalid_argument;
};

/// Adds the faces of a file to a scene, which is relative to an origin, and keeps account of those that are left out.
/// Functions throw std::invalid_argument, with a sentence, where the file asks for what cannot be.
class SceneFaces {
  public:
    /// @param scene  Has its name and its origin.
    SceneFaces(Scene& scene, const ReadOptions& options) : scene_(scene), max_patches_(options.max_patches) {}

    /// @throws PatchLimit  where `patches` more would pass the limit, to which faces left out count as well.
    void require_room(double patches) const;
    /// A place in the world [m], relative to the scene's origin.
    V3f position(const Imath::V3d& world) const;
    /// Tells where the outline of the face that is added next lies in the world, before rounding.
    void place(std::span<const Imath::V3d> outline);
    /// Adds a face as add_polygon() does; one without area is left out.
    void add(std::span<const std::vector<std::uint32_t>> loops, std::uint32_t material, std::uint32_t object,
             bool two_sided, const Location& where);
    /// Counts a face that is left out. @param message  Says what kind of face.
    void leave_out(const std::string& message, const Location& where);

    /// The origin that suits the faces placed so far.
    Imath::V3d suitable_origin() const { return origin_for(core_of(sample_.faces())); }
    /// @throws InputError where the whole has no face, or lost one that is as large as others to rounding, since it is
    /// too far from them, or is too small, too dark or too bright to be computed.
    void require_usable() const;

  private:
    /// A face of which rounding leaves nothing.
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
    LostFace placed_;  // the face that is added next; width 0 where its shape has no area even before rounding
    LostFace lost_;    // the largest of them
    LeftOut first_left_out_;
    std::uint64_t left_out_ = 0;
};

}  // namespace interflect::inline detail
