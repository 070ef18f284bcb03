#pragma once

namespace interflect {

/// Source of the four random numbers of a ray.
enum class PointSet {
    sobol,   ///< Owen-scrambled Sobol' points, one sequence per source. The error decreases faster than N^-1/2.
    random,  ///< Pseudo-random (Philox). The error decreases like N^-1/2.
};

}  // namespace interflect
