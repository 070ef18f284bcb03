#pragma once

#include <cstddef>

#include "interflect/ray_caster.h"
#include "interflect/scene.h"

namespace interflect::inline detail {

/// What a run holds at its peak [bytes].
struct MemoryNeed {
    std::size_t scene = 0;       ///< Vertices, patches, materials, textures and names.
    std::size_t ray_tracer = 0;  ///< Embree's structures, and which faces coincide.
    std::size_t patches = 0;     ///< What the forest knows of each patch, whatever elements there are.
    std::size_t rest = 0;        ///< Program, threads, and the hits of camera rays.

    /// Of each element, while a bounce's results are collected: the tree 11, H 12, importance 8, history and noise 8,
    /// points consumed 8, what the pass brought so far 16, what is shot 12 and by what importance 4, and sums of
    /// arrivals, 40, or what was received, 16, and what has not been collected yet.
    /// Where the scene has textures, 25 more: means over the element, and which elements have some.
    std::size_t per_element = 128;
    /// Of each element and light group: H, what is shot and what the pass brought, 12 each, and sums of arrivals, 24,
    /// or what was received, 12.
    static constexpr std::size_t per_element_and_group = 60;

    std::size_t without_elements() const { return scene + ray_tracer + patches + rest; }
    std::size_t with(std::size_t elements) const { return without_elements() + elements * per_element; }
};

/// What solving this scene needs. Methods that link elements (hr) need 24 bytes a link besides.
MemoryNeed memory_need(const Scene& scene, const RayCaster& ray_caster);

/// The elements that fit into so much memory.
/// @throws InputError where not even the patches do: says how much they need.
std::size_t elements_within(const MemoryNeed& need, std::size_t bytes, const Scene& scene);

}  // namespace interflect::inline detail
