#pragma once

#include <functional>
#include <vector>

#include "tests/support/form_factors.h"

// What the cases are compared with: closed forms, and the midpoint rule where there is none. Nothing here is shared
// with the library.

namespace interflect::testing_support {

/// The fraction of the light of a uniformly diffuse polygon's plane that a point receives: its irradiance over the
/// exitance. Lambert's contour integral (Photometria, 1760), exact. The polygon is counter-clockwise as the point sees
/// it, and all of it is in front of the point's plane.
double configuration_factor(const V3d& point, const V3d& normal, const std::vector<V3d>& polygon);

/// The same of a disc of radius r at height h over the point's plane, whose axis passes at a distance a (Howell B-13).
double disc_configuration_factor(double r, double h, double a);

/// Solid angle of a rectangle that a point sees at a height h over one of its corners; a, b: its sides.
double corner_solid_angle(double a, double b, double h);

/// Corners of a rectangle, counter-clockwise from the side of its normal.
std::vector<V3d> corners(const Rectangle& r);

/// Luminance of a sky in a direction [cd/m^2].
using SkyLuminance = std::function<double(const V3d&)>;

/// Standard skies (ISO 15469:2004) of a horizontal illuminance E [lx], with a ground of luminance `ground` below the
/// horizon. Uniform and traditional overcast (Moon and Spencer 1942) skies in closed form, L = E / pi and
/// L = 9 E (1 + 2 sin elevation) / (7 pi 3).
SkyLuminance uniform_sky(double illuminance, double ground = 0);
SkyLuminance overcast_sky(double illuminance, double ground = 0);
/// Type 12, clear and of low turbidity; scaled to the illuminance by the midpoint rule.
SkyLuminance clear_sky(double illuminance, const V3d& sun, double ground = 0);

/// Illuminance through a rectangular opening, by the midpoint rule with 600 x 600 cells.
/// @param is_visible  Whether the sky behind a place of the opening is seen from the point; empty: it is.
double through_opening(const V3d& point, const V3d& normal, const Rectangle& opening, const SkyLuminance& luminance,
                       const std::function<bool(const V3d& place)>& is_visible = {});

}  // namespace interflect::testing_support
