#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "interflect/base/threads/parallel.h"
#include "interflect/core.h"
#include "interflect/elements/forest.h"
#include "interflect/solver/light/materials.h"

namespace interflect::detail {

/// Radiosity B = M + rho H [lm/m^2 or W/m^2], computed on demand. Refers to its arguments.
class Radiosity {
  public:
    Radiosity() = default;
    /// @param irradiance  May be empty: H = 0.
    /// @param emits       If false, B = rho H.
    Radiosity(const Materials& materials, std::span<const Rgb> irradiance, bool emits = true)
        : materials_(&materials), irradiance_(irradiance), emits_(emits) {}

    bool empty() const { return !materials_; }
    bool emits() const { return emits_; }

    /// Returns false if B is certainly 0.
    bool may_shine(ElementIndex e) const { return emits_ || irradiance_[e] != Rgb(0); }
    /// Returns B, or 0 if it is not finite.
    Rgb of(const ElementForest& forest, ElementIndex e) const { return of_element(forest.patch(e), e); }
    Rgb of_element(PatchIndex patch, ElementIndex e) const {
        const Rgb b = unchecked(patch, e);
        return is_finite(b) ? b : Rgb(0);
    }
    bool is_not_finite(const ElementForest& forest, ElementIndex e) const {
        return !is_finite(unchecked(forest.patch(e), e));
    }
    /// Whether there are textures. The B of an inner element may then differ from the mean of its children.
    bool has_textures() const { return materials_->has_textures(); }

  private:
    Rgb unchecked(PatchIndex patch, ElementIndex e) const {
        if (!emits_) return materials_->reflectance(patch, e) * irradiance_[e];
        const MeanSurface surface = materials_->surface(patch, e);
        if (irradiance_.empty()) return surface.exitance;
        return surface.exitance + surface.reflectance * irradiance_[e];
    }

    const Materials* materials_ = nullptr;
    std::span<const Rgb> irradiance_;
    bool emits_ = false;
};

/// Returns the power that leaves an element [lm or W]; with textures, the sum over its leaves.
inline RgbD power_of(const ElementForest& forest, const Radiosity& light, ElementIndex e) {
    const ElementIndex first_child = light.has_textures() ? forest.first_child(e) : no_element;
    if (first_child == no_element) return RgbD(light.of(forest, e)) * static_cast<double>(forest.area(e));
    RgbD sum(0);
    for (std::uint32_t k = 0; k < 4; ++k) sum += power_of(forest, light, first_child + k);
    return sum;
}

/// Returns the power that leaves all surfaces [lm or W], summed in fixed order.
inline RgbD radiated_power(const ElementForest& forest, const Radiosity& light) {
    return parallel_sum(forest.patch_count(), elements_per_task, RgbD(0), [&](std::size_t begin, std::size_t end) {
        RgbD sum(0);
        for (PatchIndex i(begin); i < end; ++i) sum += power_of(forest, light, i);
        return sum;
    });
}

/// Importance per area [1/m^2]: the sum of two arrays, each of which may be empty.
class Importance {
  public:
    Importance() = default;
    explicit Importance(std::span<const float> a, std::span<const float> b = {}) : a_(a), b_(b) {}

    bool empty() const { return a_.empty() && b_.empty(); }
    float operator[](ElementIndex e) const { return (a_.empty() ? 0 : a_[e]) + (b_.empty() ? 0 : b_[e]); }

  private:
    std::span<const float> a_, b_;
};

}  // namespace interflect::detail
