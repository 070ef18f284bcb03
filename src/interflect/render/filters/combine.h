#pragma once

#include <array>

#include "interflect/image.h"
#include "interflect/render/filters/surfaces.h"

namespace interflect::detail {

struct CombinedLight {
    Image light;          ///< Irradiance / pi.
    Image squared_error;  ///< Estimate for the reflected radiance, per channel, averaged over a region.
};

/// Corrects filtered light where the filter moved it by more than noise explains, scale by scale and region by region
/// (James and Stein 1961, with the optimal share estimated from independent halves).
///
/// At each scale a share s of the removed light P / 2 is returned. With the halves A and B, their filtered versions FA
/// and FB, P = (A - FA) + (B - FB), M = (A - FA) - (B - FB) and D = A - B, the mean squared error of the result is
///
///     E[(1 - s)^2 P^2 + D^2 - 2 (1 - s) D M] / 4
///
/// for any filter, because A and B are independent and unbiased. Its minimum is 1 - s = E[D M] / E[P^2]. The means are
/// taken over a region. Means over about 8,500 pixels of a surface are returned in full.
/// @param albedo    Errors are those of the radiance, light times albedo.
/// @param noisy     Irradiance / pi of the halves of the samples, finite.
/// @param filtered  Each half, filtered by itself.
CombinedLight combine(const Surfaces& surfaces, const Image& albedo, const std::array<Image, 2>& noisy,
                      const std::array<Image, 2>& filtered);

}  // namespace interflect::detail
