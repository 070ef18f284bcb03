#pragma once

#include "interflect/image.h"

namespace interflect::detail {

/// Contrast sensitivity of the eye, A(f) = 2.6 (0.0192 + 0.114 f) exp(-(0.114 f)^1.1), Mannos and Sakrison 1974.
/// Maximum 0.98 at 8 cycles per degree; A(0) = 0.05, A(50) = 0.02.
/// @param cycles_per_degree  f >= 0.
double contrast_sensitivity(double cycles_per_degree);

/// Computes the perceptual distance of two pictures: the first model in Rushmeier et al. 1995, after Mannos and
/// Sakrison 1974. L and R are the luminances of image and reference, clamped to >= 0, and m is the mean of R:
///
///     d(x, y)  = (L / m)^0.33 - (R / m)^0.33                          response of the eye
///     D(u, v)  = 1/N sum of d(x, y) exp(-2 pi i (u x / width + v y / height))
///     distance = sqrt(sum over u, v of A(f(u, v))^2 |D(u, v)|^2)
///
/// This is the root mean square of d with frequencies weighted by the contrast sensitivity. For f [cycles per degree]
/// the picture's height spans `field_of_view`, with square pixels of equal angle. The discrete Fourier transform
/// repeats d, not the picture, across the borders; no window or padding is used.
///
/// The distance is 0 for equal images and independent of a common factor and, at equal pixels per degree, of the size.
/// For a black reference it is 0 if the image is black too, otherwise infinite.
/// @param field_of_view  Full vertical angle of the view [degrees], in (0, 180).
/// @throws InputError for different sizes, no pixels, or a field of view out of range. Pixels must be finite.
/// Cost: O(N log N) for sides with small prime factors, at worst O(N (width + height)); 16 bytes per pixel.
double perceptual_distance(const Image& image, const Image& reference, double field_of_view);

}  // namespace interflect::detail
