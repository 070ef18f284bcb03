#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "interflect/core.h"
#include "interflect/solver/deposit/oracle.h"

namespace interflect::detail {

/// Both ends of every ray in flight, as a structure of arrays.
struct alignas(64) RayPairs {
    static constexpr std::size_t lanes = 64;  // data fit into the first-level cache
    using Floats = std::array<float, lanes>;
    using Numbers = std::array<std::uint32_t, lanes>;
    struct Vectors {
        Floats x, y, z;
        void set(std::size_t i, const V3f& vector) { x[i] = vector.x, y[i] = vector.y, z[i] = vector.z; }
        V3f operator[](std::size_t i) const { return {x.data()[i], y.data()[i], z.data()[i]}; }
    };

    // The patch that was hit (PatchGeometry::Shape), and the hit point.
    Vectors origin, edge_u, edge_v, twist;
    Numbers is_triangle;
    Floats hit_u, hit_v;
    // The receiver: the current element above the hit.
    Numbers receiver, children;  // children: first of four, or none
    Floats u, v, size;           // its cell
    Vectors normal;
    Floats area, importance;  // psi_i
    // The shooter: the current element above the origin.
    Numbers shooter, lowest_shooter;  // indices in SourcePaths; the lowest is the ray's leaf or a new element
    Vectors shooter_centre, shooter_normal;
    Floats shooter_area, shooter_least_cosine;
    Floats reflected;  // the largest channel of rho_i B_j
    // Results of the oracle, and the next actions.
    Numbers settled;    // accepted or not divisible
    Numbers of_power;   // receiver of the power, final if settled
    Numbers on_demand;  // the shooter must be divided, or the receiver lacks children
    Numbers goes_on;    // the ray is still in flight
    Numbers next;       // first of the children to descend to, or none

    /// Settles pairs that the oracle accepts or whose larger end is too small to divide (Eq. 14, 15, Prikryl et al.
    /// 2000).
    void evaluate_oracle(const Oracle& oracle);
    /// Chooses the next action for pairs that are not divided on demand.
    /// @param needs_leaf  Rays descend to the leaf among the first `old_size` elements.
    void choose_next(bool needs_leaf, std::uint32_t old_size);
    void go_down();
};

}  // namespace interflect::detail
