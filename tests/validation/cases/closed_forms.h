#pragma once

#include <functional>
#include <vector>

#include "tests/support/form_factors.h"

// References of the validation cases: closed forms, or else the midpoint rule. They share no code with the library.

namespace interflect::testing_support {

/// Computes the fraction of the light of a uniformly diffuse polygon's plane that a point receives: its irradiance over
/// the exitance. Lambert's contour integral (Photometria, 1760), exact. The polygon is counter-clockwise as seen from
/// the point, and entirely in front of the point's plane.
double configuration_factor(const V3d& point, const V3d& normal, const std::vector<V3d>& polygon);

/// Computes the same for a disc of radius r at height h over the point's plane, whose axis has the distance a (Howell
/// B-13).
double disc_configuration_factor(double r, double h, double a);

/// Computes the solid angle of a rectangle with sides a and b, from a point at height h over one of its corners.
double corner_solid_angle(double a, double b, double h);

/// Returns the corners of a rectangle, counter-clockwise from the side of its normal.
std::vector<V3d> corners(const Rectangle& r);

/// Luminance of a sky in a direction [cd/m^2].
using SkyLuminance = std::function<double(const V3d&)>;

/// Standard skies (ISO 15469:2004) with horizontal illuminance E [lx], and a ground of luminance `ground` below the
/// horizon. The uniform and the traditional overcast sky (Moon and Spencer 1942) have closed forms, L = E / pi and L =
/// 9 E (1 + 2 sin elevation) / (7 pi 3).
SkyLuminance uniform_sky(double illuminance, double ground = 0);
SkyLuminance overcast_sky(double illuminance, double ground = 0);
/// Type 12, clear and of low turbidity; scaled to the illuminance by the midpoint rule.
SkyLuminance clear_sky(double illuminance, const V3d& sun, double ground = 0);

/// Computes the illuminance through a rectangular opening, by the midpoint rule with 600 x 600 cells.
/// @param is_visible  Whether the sky is visible from the point through a place of the opening; empty: always.
double through_opening(const V3d& point, const V3d& normal, const Rectangle& opening, const SkyLuminance& luminance,
                       const std::function<bool(const V3d& place)>& is_visible = {});

}  // namespace interflect::testing_support
