#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "interflect/core.h"
#include "interflect/solver/deposit/oracle.h"

namespace interflect::detail {

/// Pairs of shooter j and receiver i of the rays in flight, as a structure of arrays.
struct alignas(64) RayPairs {
    static constexpr std::size_t lanes = 64;  // fits the first-level cache
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

    // The hit patch (PatchGeometry::Shape) and point.
    Vectors patch_origin, edge_u, edge_v, twist;
    Numbers is_triangle;
    Floats hit_u, hit_v;
    // Receiver: the current element around the hit.
    Numbers receiver, children;  // children: first one, if any
    Floats u, v, size;           // its cell
    Vectors normal;
    Floats area, importance;  // psi_i
    // Shooter: the current element around the origin.
    Numbers shooter, lowest_shooter;  // in SourcePaths; lowest: leaf or new element
    Vectors shooter_centre, shooter_normal;
    Floats shooter_area, shooter_least_cosine;
    Floats reflected;        // largest channel of rho_i B_j
    Numbers settled;         // accepted or indivisible
    Numbers power_receiver;  // final if settled
    Numbers needs_children;  // the larger end lacks known children
    Numbers continues;       // the ray stays in flight
    Numbers next;            // first child of the receiver to descend to, if any

    /// Settles pairs that the oracle accepts or that are too small to divide.
    void evaluate_oracle(const Oracle& oracle);
    /// @param needs_leaf  Rays descend to a leaf among the first `old_size` elements.
    void choose_next(bool needs_leaf, std::uint32_t old_size);
    void descend();
};

}  // namespace interflect::detail
