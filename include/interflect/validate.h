#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "interflect/ray_caster.h"
#include "interflect/scene.h"

namespace interflect {

/// Something in a scene that spoils its light, or that should be known before it is solved.
struct Finding {
    /// One place where it is; what does not apply is empty.
    struct Place {
        std::string object{}, material{};
        std::string where{};           ///< "file:line".
        Imath::V3d position{0, 0, 0};  ///< In the world [m].
        bool has_position = false;
    };
    std::string kind;           ///< Stable identifier, such as "duplicate-face".
    bool is_problem = false;    ///< Whether it changes the light, or is nearly certainly a mistake; else a note.
    std::string message;        ///< What it is, in one sentence.
    std::string advice;         ///< What to do about it.
    std::int64_t count = 0;     ///< How often.
    std::vector<Place> places;  ///< The first of them.
};

struct ValidateOptions {
    std::size_t places = 3;         ///< Most of each kind that are listed.
    float high_reflectance = 0.9f;  ///< Paints, paper and snow have less; in (0, 1).
};

/// Looks for what would spoil a solve of the scene as it was read, before cut_at_contacts(). Problems:
/// "degenerate-face" (without area, left out by the reader), "duplicate-face" (the same corners as another),
/// "inverted-face" (one-sided, and the scene is behind it), "inverted-lamp" (its front is against a surface, its back
/// is not), "hidden-lamp" (covered, or enclosed by surfaces close to it), "zero-power-lamp", "high-reflectance",
/// "no-light", "implausible-size", "maintenance-factor". Notes: "coincident-face" (another in its plane covers a part
/// of it), "open-edge" (of one face alone) and "no-view"; then the findings of validate_setup(). What faces and lamps
/// see is found with rays: 64 a face, of at most 4096 of a kind.
/// @param ray_caster  Of this scene.
/// @return            In the order above. O(n log n) for n patches. @throws InputError where the ray caster is
/// another's.
std::vector<Finding> validate(const Scene& scene, const RayCaster& ray_caster, const ValidateOptions& options = {});

/// The part of validate() that costs milliseconds: probable mistakes of placing, units or axes. Problems:
/// "close-luminaire" (more than half of its light is received by a surface within 2 cm, or within a hundredth of a
/// scene smaller than 2 m), "outside-luminaire" (all of its light escapes; in a closed room, more than half of it
/// does, or a quarter of all directions are free), "wide-opening" (larger than the scene) and "shut-out-sky" (a sky or
/// a sun, and a closed scene that is seen from inside). Notes: "mixed-photometry" (LM-63 and EULUMDAT in one scene),
/// "probable-unit" and "probable-up-axis" (of formats without either). Point lights, spots and measured lights have 256
/// rays each, at most 1024 of them; 2^14 lines find where a sky enters.
/// @return  In this order, the same for any number of threads. @throws InputError as validate() does.
std::vector<Finding> validate_setup(const Scene& scene, const RayCaster& ray_caster,
                                    const ValidateOptions& options = {});

}  // namespace interflect
