#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "interflect/colour.h"
#include "interflect/solver/oracle.h"

namespace interflect {

/// The two ends of every ray in flight, an array for each number, so that the oracle judges all of them at once.
struct alignas(64) RayPairs {
    static constexpr std::size_t lanes = 64;  // what is known of them fits into the first-level cache
    using Floats = std::array<float, lanes>;
    using Numbers = std::array<std::uint32_t, lanes>;
    struct Vectors {
        Floats x, y, z;
        void set(std::size_t i, const V3f& vector) { x[i] = vector.x, y[i] = vector.y, z[i] = vector.z; }
        V3f operator[](std::size_t i) const { return {x.data()[i], y.data()[i], z.data()[i]}; }
    };

    // The patch that was hit (PatchGeometry::Shape), and where on it.
    Vectors origin, edge_u, edge_v, twist;
    Numbers is_triangle;
    Floats hit_u, hit_v;
    // The receiver: the lowest element above the hit that the oracle has come to.
    Numbers receiver, children;  // children: the first of four, as it was when they were looked up, or none
    Floats u, v, size;           // its cell
    Vectors normal;
    Floats area, importance;  // psi_i
    // The shooter: the lowest above the origin.
    Numbers shooter, lowest_shooter;  // among Shooters; the lowest is the ray's leaf or a new element
    Vectors shooter_centre, shooter_normal;
    Floats shooter_area, shooter_least_cosine;
    Floats reflected;  // the largest channel of rho_i B_j
    // Verdicts, and what follows from them.
    Numbers settled;    // power has arrived
    Numbers of_power;   // at this element; until it has, the receiver
    Numbers on_demand;  // what is to be divided has no children yet, or is the shooter
    Numbers goes_on;    // the ray is still in flight
    Numbers next;       // the first child of those that the receiver's place is taken by; none: it stays

    /// Whether the oracle accepts each pair, or its larger end is too small to be divided (Eq. 14, 15).
    void evaluate_oracle(const Oracle& oracle);
    /// Decides what becomes of every pair but those to be divided on demand.
    /// @param needs_leaf  Rays go on, below the element where power arrives, to the leaf of the first `old_size`.
    void choose_next(bool needs_leaf, std::uint32_t old_size);
    /// Every receiver whose children are next becomes the one that holds the hit.
    void go_down();
};

}  // namespace interflect
