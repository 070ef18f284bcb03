#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "interflect/elements/forest.h"
#include "interflect/solver/state/light_state.h"

namespace interflect::detail {

/// Assumed relative variation of the irradiance within a leaf without measurements.
inline constexpr float assumed_variation = 0.1f;

/// Variation of irradiance among siblings, as squared luminance [(lm/m^2)^2 or (W/m^2)^2].
struct SiblingVariation {
    float spread = 0;  ///< Mean square difference from the parent: signal (true variation) plus noise.
    float noise = 0;   ///< Expected noise in `spread`; infinite if it is unknown.
    /// Assumed signal of under-sampled siblings; negative for other siblings.
    float assumed = -1;

    bool is_known() const { return noise < std::numeric_limits<float>::infinity(); }
    bool is_under_sampled() const { return assumed >= 0; }
    /// Returns the signal. Unless it is assumed, it is an unbiased estimate, which may be negative.
    float signal() const { return is_under_sampled() ? assumed : spread - noise; }
    /// Returns the factor of the differences (Wiener filter), in [0, 1].
    float shrinkage() const;
    /// Returns the mean squared error after shrinkage, in addition to that of the parent. The estimate is unbiased
    /// (Stein 1981, in three dimensions, because the four differences sum to zero).
    float risk() const;
};

SiblingVariation sibling_variation(const LightState& light, ElementIndex first);

bool uses_shrinkage(const LightState& light);

struct AddedError {
    float noise = 0, bias = 0;
};
AddedError added_error(const LightState& light, ElementIndex first, const SiblingVariation& variation);

/// Factors of the differences of four siblings from their parent, and the remaining noise variance of each sibling,
/// relative to the mean of the four.
struct Shrinkage {
    std::array<float, 4> kept, noise;
};
Shrinkage shrinkage_of(const LightState& light, ElementIndex first, const SiblingVariation& variation);

/// Returns the signal of e and its siblings; 0 if it is unknown.
float signal_among_siblings(const LightState& light, ElementIndex e);

inline ElementIndex first_sibling(const ElementForest& forest, ElementIndex e) {
    return forest.first_child(forest.parent(e));
}

}  // namespace interflect::detail
