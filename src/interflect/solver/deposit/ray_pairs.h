#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "interflect/core.h"
#include "interflect/solver/deposit/oracle.h"

namespace interflect::detail {

/// Pairs of shooter j and receiver i of the rays in flight, as a structure of arrays.
struct alignas(64) RayPairs {
    static constexpr std::size_t lanes = 64;  // the arrays fit into the first-level cache
    using Floats = std::array<float, lanes>;
    using Numbers = std::array<std::uint32_t, lanes>;
    struct Vectors {
        Floats x, y, z;
        void set(std::size_t i, const V3f& vector) {
            x[i] = vector.x;
            y[i] = vector.y;
            z[i] = vector.z;
        }
        V3f operator[](std::size_t i) const { return {x.data()[i], y.data()[i], z.data()[i]}; }
    };

    // The hit patch (see PatchGeometry::Shape) and the hit point on it:
    Vectors patch_origin, edge_u, edge_v, twist;
    Numbers is_triangle;
    Floats hit_u, hit_v;
    // The receiver, which is the current element around the hit point:
    Numbers receiver, children;  // the element and its first child; none in leaves
    Floats u, v, size;           // cell of the element
    Vectors normal;
    Floats area, importance;  // area [m^2] and importance psi_i of the element
    // The shooter, which is the current element around the origin of the ray:
    Numbers shooter;         // index of the element in SourcePaths
    Numbers lowest_shooter;  // index of the smallest element on the path
    Vectors shooter_centre, shooter_normal;
    Floats shooter_area, shooter_least_cosine;
    Floats reflected;        // largest channel of rho_i B_j
    Numbers settled;         // whether the pair is accepted or indivisible
    Numbers power_receiver;  // element that receives the power; final if settled
    Numbers needs_children;  // whether the children of the larger end are unknown
    Numbers continues;       // whether the ray stays in flight
    Numbers next;            // first child to which the receiver descends; none: it does not descend

    /// Settles pairs that the oracle accepts or that are too small to divide.
    void evaluate_oracle(const Oracle& oracle);
    /// Sets needs_children, continues and next.
    /// @param needs_leaf  Whether rays continue to a leaf among the first `old_size` elements.
    void choose_next(bool needs_leaf, std::uint32_t old_size);
    void descend();
};

}  // namespace interflect::detail
