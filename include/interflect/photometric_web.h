#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "interflect/colour.h"

namespace interflect {

/// The surface that a luminaire shines from, about its photometric centre. Every point of it shines alike.
struct LuminousOpening {
    enum class Shape { box, cylinder, ellipsoid };
    Shape shape = Shape::box;
    V3f size{0, 0, 0};  ///< Along x, y and z of PhotometricWeb [m]; a box of size 0 is a point, a flat one a rectangle.
    int axis = 2;       ///< Along which a cylinder stands, 0 to 2; one of length 0 is a disk.

    bool is_point() const { return size == V3f(0); }
};

/// The luminous intensity of a luminaire in all directions, as it was measured far away (IES LM-63, EULUMDAT).
///
/// Directions are in the luminaire's own frame: -z is its nadir, where type C photometry has the vertical angle 0; x
/// lies in the C0 half plane and y in C90, so that C runs counter-clockwise as seen from above. Intensities are a table
/// over a polar angle, from a pole, and an azimuth around it; both are linear in between, and zero beyond their ends.
struct PhotometricWeb {
    enum class Pole {
        nadir,  ///< Types C and A: the azimuth runs from x to y.
        c90     ///< Type B: the pole is y, and the azimuth runs from the nadir to x.
    };
    std::string name;  ///< The file that it was read from.
    Pole pole = Pole::nadir;
    std::vector<float> polar;        ///< [degrees], at least two, ascending within [0, 180].
    std::vector<float> azimuth;      ///< [degrees], at least two, ascending, over at most 360.
    std::vector<float> intensities;  ///< [cd] or [W/sr], >= 0: [azimuth * polar.size() + polar].
    LuminousOpening opening;
    double lamp_lumens = 0;  ///< Rated flux of its lamps [lm], for which the intensities hold; 0: not told (absolute).

    /// Column of the table: intensities of all polar angles at one azimuth.
    const float* at_azimuth(std::size_t i) const { return intensities.data() + i * polar.size(); }
    /// Intensity in a direction of the luminaire's frame, which need not be normalised. O(log(angles)).
    float intensity(const V3f& direction) const;
    /// Integral of intensity() over all directions [lm or W], exact up to rounding. O(table).
    double flux() const;
    /// Largest intensity of the table.
    float peak() const;
};

/// What is wrong with it, in words without a subject ("has ..."); empty where nothing is. A web that emits nothing is.
std::string web_fault(const PhotometricWeb& web);

}  // namespace interflect
