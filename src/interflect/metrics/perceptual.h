#pragma once

#include "interflect/image.h"

namespace interflect::inline detail {

/// Returns the contrast sensitivity for sine gratings: A(f) = 2.6 (0.0192 + 0.114 f) exp(-(0.114 f)^1.1), Mannos and
/// Sakrison 1974. The maximum is 0.98 at 8 cycles per degree; A(0) = 0.05, A(50) = 0.02.
/// @param cycles_per_degree  f >= 0.
double contrast_sensitivity(double cycles_per_degree);

/// Computes the perceptual distance of two pictures: the first model in Rushmeier et al. 1995, after Mannos and
/// Sakrison 1974. L and R are the luminances of image and reference, clamped to >= 0, and m is the mean of R:
///
///     d(x, y)  = (L / m)^0.33 - (R / m)^0.33                          response of the eye
///     D(u, v)  = 1/N sum of d(x, y) exp(-2 pi i (u x / width + v y / height))
///     distance = sqrt(sum over u, v of A(f(u, v))^2 |D(u, v)|^2)
///
/// This is the root mean square of d over the pixels after weighting each frequency by the contrast sensitivity. f
/// [cycles per degree] assumes that the picture's height spans `field_of_view` and that pixels are square and equal in
/// angle. The discrete Fourier transform treats d, but not the picture, as periodic. There is no window or padding.
///
/// The distance is 0 for equal images. It does not depend on a common factor, nor on the size of the picture at equal
/// pixels per degree. For a black reference it is 0 if the image is black too, otherwise infinite.
/// @param field_of_view  Full vertical angle of the view [degrees], in (0, 180).
/// @throws InputError if the sizes differ, there are no pixels, or the field of view is out of range. Pixels must be
/// finite. Cost: O(N log N) if the sides are products of small primes, at worst O(N (width + height)); 16 bytes per
/// pixel.
double perceptual_distance(const Image& image, const Image& reference, double field_of_view);

}  // namespace interflect::inline detail
