#pragma once

namespace interflect {

/// Where the four random numbers of a ray come from.
enum class PointSet {
    sobol,   ///< Owen-scrambled Sobol' points, a sequence of its own for each source: error falls faster than N^-1/2.
    random,  ///< Pseudo-random (Philox): error falls like N^-1/2.
};

}  // namespace interflect
