#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "interflect/base/colour.h"
#include "interflect/base/parallel.h"
#include "interflect/elements/forest.h"
#include "interflect/solver/materials.h"

namespace interflect {

/// What leaves the elements of a forest: B = M + rho H [lm/m^2 or W/m^2], found for each when it is asked for. Refers
/// to the surfaces and to H.
class Radiosity {
  public:
    Radiosity() = default;  ///< There is none.
    /// @param irradiance  H of every element.
    /// @param emits       Whether M counts; else B is only what is reflected.
    Radiosity(const Materials& materials, std::span<const Rgb> irradiance, bool emits = true)
        : materials_(&materials), irradiance_(irradiance), emits_(emits) {}

    bool empty() const { return irradiance_.empty(); }
    bool emits() const { return emits_; }

    /// B, or 0 where it is not finite.
    Rgb of(const ElementForest& forest, std::uint32_t e) const { return of(materials_->material(forest.patch(e)), e); }
    /// The same, of an element whose material is known.
    Rgb of(const Material& material, std::uint32_t e) const {
        const Rgb b = as_it_is(material, e);
        return is_finite(b) ? b : Rgb(0);
    }
    bool is_lost(const ElementForest& forest, std::uint32_t e) const {
        return !is_finite(as_it_is(materials_->material(forest.patch(e)), e));
    }

  private:
    Rgb as_it_is(const Material& material, std::uint32_t e) const {
        const Rgb reflected = material.reflectance * irradiance_[e];
        return emits_ ? material.exitance + reflected : reflected;
    }

    const Materials* materials_ = nullptr;
    std::span<const Rgb> irradiance_;
    bool emits_ = false;
};

/// What leaves all patches together [lm or W], in double precision and always in the same order.
inline RgbD radiated_power(const ElementForest& forest, const Radiosity& light) {
    return parallel_sum(forest.patch_count(), elements_at_once, RgbD(0), [&](std::size_t begin, std::size_t end) {
        RgbD sum(0);
        for (auto i = static_cast<std::uint32_t>(begin); i < end; ++i)
            sum += RgbD(light.of(forest, i)) * static_cast<double>(forest.area(i));
        return sum;
    });
}

/// Importance per area of the elements of a forest [1/m^2], as the sum of two parts.
class Importance {
  public:
    Importance() = default;  ///< There is none.
    /// @param a, b  Of every element; either may be empty.
    explicit Importance(std::span<const float> a, std::span<const float> b = {}) : a_(a), b_(b) {}

    bool empty() const { return a_.empty() && b_.empty(); }
    float operator[](std::uint32_t e) const { return (a_.empty() ? 0 : a_[e]) + (b_.empty() ? 0 : b_[e]); }

  private:
    std::span<const float> a_, b_;
};

}  // namespace interflect
