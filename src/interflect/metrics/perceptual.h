#pragma once

#include "interflect/image.h"

namespace interflect::inline detail {

/// How well the eye sees a sine grating: A(f) = 2.6 (0.0192 + 0.114 f) exp(-(0.114 f)^1.1), Mannos and Sakrison 1974.
/// Best at 8 cycles per degree, 0.98; 0.05 for what does not vary, 0.02 at 50.
/// @param cycles_per_degree  f >= 0.
double contrast_sensitivity(double cycles_per_degree);

/// The perceptual distance of two pictures: the first of the models in Rushmeier et al. 1995, after Mannos and Sakrison
/// 1974. With luminances L of the image and R of the reference, those below 0 taken for 0, and m the mean of R:
///
///     d(x, y)  = (L / m)^0.33 - (R / m)^0.33                          what the eye responds to
///     D(u, v)  = 1/N sum of d(x, y) exp(-2 pi i (u x / width + v y / height))
///     distance = sqrt(sum over u, v of A(f(u, v))^2 |D(u, v)|^2)
///
/// So it is the root mean square of d over the pixels, after each frequency was weighted by how well it is seen. f
/// [cycles per degree] takes the picture's height to be `field_of_view` and pixels to be square and equal in angle. As
/// every discrete Fourier transform this one takes the picture to repeat; since d is what is transformed, only
/// differences meet across the borders, not the picture. No window, no padding: sizes are as they are.
///
/// 0 for equal images; a factor common to both does not matter, nor does the size of the picture at equal pixels per
/// degree. Where the reference is black: 0 if the image is too, else infinite.
/// @param field_of_view  Of the view, vertical, full [degrees], in (0, 180).
/// @throws InputError where the sizes differ, there are no pixels, or the field of view is out of range. Pixels must be
/// finite. Cost: O(N log N) for sides that are products of small primes, O(N (width + height)) at worst; 16 bytes a
/// pixel.
double perceptual_distance(const Image& image, const Image& reference, double field_of_view);

}  // namespace interflect::inline detail
