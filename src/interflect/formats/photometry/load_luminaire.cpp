#include "interflect/load.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "interflect/core.h"
#include "interflect/formats/photometry/ies.h"
#include "interflect/formats/photometry/ldt.h"
#include "interflect/formats/text/extension.h"
#include "interflect/scene/core/limits.h"
#include "interflect/scene/core/web_angles.h"

namespace interflect {

using namespace detail;

PhotometricWeb load_photometric_web(const std::filesystem::path& path, const ReadOptions& options, Warnings& warnings) {
    const std::string extension = lower_case_extension(path);
    if (extension == ".ies") return read_ies(path, options, warnings);
    if (extension == ".ldt") return read_ldt(path, options, warnings);
    throw InputError(
        path, 0,
        fmt::format("no format of measured light is known by the extension '{}'; known: .ies, .ldt", extension));
}

MeasuredLight place(const PlacedLuminaire& placed, std::shared_ptr<const PhotometricWeb> web,
                    const Imath::V3d& origin) {
    if (!is_within_reach(placed.position) || (placed.aim && !is_within_reach(*placed.aim)))
        throw InputError(placed.file, 0, fmt::format("is placed farther than {:g} m away", farthest_coordinate));
    const auto is_factor = [](double x) { return std::isfinite(x) && x >= 0; };
    if (!is_factor(placed.maintenance) || !is_factor(placed.lumens.value_or(0)))
        throw InputError(placed.file, 0, "needs lumens and a maintenance factor that are finite and not negative");
    MeasuredLight light;
    light.position = V3f(placed.position - origin);
    if (placed.aim) light.direction = V3f((*placed.aim - placed.position).normalized());
    if (light.direction == V3f(0)) throw InputError(placed.file, 0, "is aimed at its own position");
    if (placed.by_top) light.position += web->opening.mounting_depth() * light.direction;
    constexpr float almost_along_x = 0.999f;
    const V3f nadir = light.direction;
    const V3f side = std::abs(nadir.x) < almost_along_x ? V3f(1, 0, 0) : V3f(0, 0, 1);
    const V3f c0 = (side - nadir * nadir.dot(side)).normalized(), c90 = c0.cross(nadir);
    const double turn = radians(placed.turn);
    light.c0 = c0 * static_cast<float>(std::cos(turn)) + c90 * static_cast<float>(std::sin(turn));
    const double rated = web->lamp_lumens > 0 ? web->lamp_lumens : web->flux();
    light.factor = Rgb(static_cast<float>(placed.maintenance * (placed.lumens ? *placed.lumens / rated : 1)));
    light.web = std::move(web);
    return light;
}

}  // namespace interflect
