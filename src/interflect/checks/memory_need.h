#pragma once

#include <cstddef>

#include "interflect/ray_caster.h"
#include "interflect/scene.h"
#include "interflect/solve_options.h"

namespace interflect::detail {

/// Peak memory of a run [bytes].
struct MemoryNeed {
    std::size_t scene = 0;
    std::size_t ray_tracer = 0;  ///< Includes coincident faces.
    std::size_t patches = 0;     ///< Without elements.
    std::size_t rest = 0;        ///< Program, threads, hits of camera rays.

    /// Arrays of the solver [bytes]. Measured: 98 to 109 for 0.7 to 3 million elements.
    std::size_t per_element = 128;
    /// Three colours, and an index per four siblings [bytes].
    static constexpr std::size_t per_textured_element = 37;
    /// Bytes: H, unshot light and pass result, 12 each; contributions 24 or received light 12.
    static constexpr std::size_t per_element_and_group = 60;
    /// Memory per element and light group for SolveOptions::keep_direct [bytes].
    static constexpr std::size_t per_element_of_direct_light = 24;

    std::size_t without_elements() const { return scene + ray_tracer + patches + rest; }
    std::size_t with(std::size_t elements) const { return without_elements() + elements * per_element; }
};

/// Excludes links of method hr, 24 bytes each.
MemoryNeed memory_need(const Scene& scene, const RayCaster& ray_caster);
/// Includes SolveOptions::keep_direct.
MemoryNeed memory_need(const Scene& scene, const RayCaster& ray_caster, const SolveOptions& options);

/// @throws InputError with the required memory if the patches do not fit.
std::size_t elements_within(const MemoryNeed& need, std::size_t bytes, const Scene& scene);

}  // namespace interflect::detail
