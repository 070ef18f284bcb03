#pragma once

#include <ImathBox.h>
#include <ImathMatrix.h>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interflect/formats/rad/statements/data.h"
#include "interflect/formats/rad/statements/statements.h"
#include "interflect/formats/shapes/curves.h"
#include "interflect/light_sources.h"

namespace interflect::detail {

/// Luminaire as ies2rad writes it: `brightdata` that modifies a light, with the functions and coordinates of
/// Radiance's source.cal.
struct RadLightPattern {
    enum class Correction { none, flat, box, cylinder };
    enum class Coordinate { theta, phi, phi2, phi4, b_vertical, b_vertical2, b_horizontal, b_horizontal2 };

    Correction correction = Correction::none;
    std::vector<double> arguments;  ///< Factor; then the size of a box or cylinder [m].
    std::string data_file;
    std::vector<Coordinate> coordinates;
    Imath::M44d to_file;  ///< Transform from the luminaire's frame (PhotometricWeb) to the file.
};

/// Parses a pattern. @return  nullopt for other patterns. @throws std::invalid_argument for missing arguments.
std::optional<RadLightPattern> parse_light_pattern(const RadPrimitive& primitive);

/// Emitting surfaces in the luminaire's frame.
struct RadEmitter {
    std::vector<PolygonMesh> surfaces;
    LuminousOpening::Shape shape = LuminousOpening::Shape::box;  ///< Opening around the surfaces.

    Imath::Box3d bounds() const;
};

/// Computes the intensities of the emitter from its projected area, for a radiance of 1 before the pattern.
/// The opening is a box, upright cylinder or ellipsoid around all surfaces.
PhotometricWeb make_light_web(const RadLightPattern& pattern, const RadData& data, const RadEmitter& emitter);

}  // namespace interflect::detail
