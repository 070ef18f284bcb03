#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "interflect/colour.h"

namespace interflect {

/// Luminous surface of a luminaire, centred at its photometric centre. All of its points emit equally.
struct LuminousOpening {
    enum class Shape { box, cylinder, ellipsoid };
    Shape shape = Shape::box;
    V3f size{0, 0, 0};  ///< Along x, y and z of PhotometricWeb [m]; a box of size 0 is a point, a flat one a rectangle.
    int axis = 2;       ///< Axis of a cylinder, 0 to 2; a cylinder of length 0 is a disk.

    bool is_point() const { return size == V3f(0); }
};

/// Far-field luminous intensity of a luminaire as a function of direction (IES LM-63, EULUMDAT).
///
/// Directions are in the luminaire's frame: -z is the nadir, with vertical angle 0 in type C photometry; x is in the C0
/// half plane and y in C90, so C is counter-clockwise seen from above. Intensities are tabulated over a polar angle
/// from a pole and an azimuth about it, interpolated linearly, and zero outside the table.
struct PhotometricWeb {
    enum class Pole {
        nadir,  ///< Types C and A: the azimuth runs from x to y.
        c90     ///< Type B: the pole is y, and the azimuth runs from the nadir to x.
    };
    std::string name;  ///< Source file.
    Pole pole = Pole::nadir;
    std::vector<float> polar;        ///< [degrees], at least two, ascending within [0, 180].
    std::vector<float> azimuth;      ///< [degrees], at least two, ascending, over at most 360.
    std::vector<float> intensities;  ///< [cd] or [W/sr], >= 0: [azimuth * polar.size() + polar].
    LuminousOpening opening;
    double lamp_lumens = 0;  ///< Rated flux of the lamps for these intensities [lm]; 0: absolute photometry.

    /// Column of the table: intensities of all polar angles at one azimuth.
    const float* at_azimuth(std::size_t i) const { return intensities.data() + i * polar.size(); }
    /// Intensity in a direction of the luminaire's frame, which need not be normalised. O(log(angles)).
    float intensity(const V3f& direction) const;
    /// Integral of intensity() over all directions [lm or W], exact up to rounding. O(table).
    double flux() const;
    /// Largest intensity of the table.
    float peak() const;
};

/// Fault of a web, in words without a subject ("has ..."); empty if valid. A web without emission is invalid.
std::string web_fault(const PhotometricWeb& web);

}  // namespace interflect
