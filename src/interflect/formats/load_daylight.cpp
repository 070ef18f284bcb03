#include <fmt/format.h>

#include <cmath>
#include <string>
#include <utility>

#include "interflect/core.h"
#include "interflect/formats/build/texture_files.h"
#include "interflect/load.h"
#include "interflect/scene/core/web_angles.h"
#include "interflect/scene/sky/environment_maps.h"
#include "interflect/scene/sky/sky_frame.h"

namespace interflect {

using namespace detail;

namespace {

/// Types of skies in CIE S 011:2003; 16 is the traditional overcast sky.
constexpr int last_overcast = 5, last_intermediate = 10, traditional_overcast = 16;
bool is_overcast(int type) { return type <= last_overcast || type == traditional_overcast; }

double sine_of(double altitude) { return std::sin(radians(altitude)); }

class DaylightAdder {
  public:
    DaylightAdder(Scene& scene, const Daylight& placed) : scene_(scene), placed_(placed), frame_(placed.zenith) {
        const float length = placed.zenith.length();
        if (!(length > 0 && std::isfinite(length))) throw InputError("the zenith has no direction");
    }

    void add() {
        const Daylight::Sun* sun = placed_.sun ? &*placed_.sun : nullptr;
        if (sun) require_sun(*sun);
        const bool has_dome = placed_.perez_sky || placed_.cie_sky;
        ModelledDaylight light = placed_.perez_sky ? perez_light(*placed_.perez_sky)
                                 : placed_.cie_sky ? cie_light(*placed_.cie_sky)
                                                   : ModelledDaylight{};
        if (sun && !has_dome) light.sun_illuminance = usual_sun_illuminance(clear_type, sun->altitude);
        if (sun) light.sun_illuminance = sun->illuminance.value_or(light.sun_illuminance);
        if (sun && light.sun_illuminance != 0)
            push("sun", DirectionalLight{-towards_sun(*sun), white(light.sun_illuminance), sun_diameter});
        if (has_dome) push("sky", dome(light));
        if (placed_.environment) add_environment(*placed_.environment);
    }

  private:
    static constexpr int clear_type = 12;

    static void require_sun(const Daylight::Sun& sun) {
        if (!(sun.altitude > 0 && sun.altitude <= right_angle) || !std::isfinite(sun.azimuth))
            throw InputError(fmt::format("a sun at the azimuth {} and altitude {}; expected an altitude above 0 to 90",
                                         sun.azimuth, sun.altitude));
    }

    double altitude(const std::string& sky) const {
        if (!placed_.sun) throw InputError(fmt::format("a sky {} needs a sun", sky));
        return placed_.sun->altitude;
    }

    ModelledDaylight perez_light(const Daylight::PerezSky& sky) const {
        return perez_daylight(sky.direct_normal, sky.diffuse_horizontal, altitude("by Perez"));
    }

    ModelledDaylight cie_light(const Daylight::CieSky& sky) const {
        ModelledDaylight light{cie_standard_sky(sky.type)};
        if (light.model.depends_on_sun()) altitude(fmt::format("of CIE type {}", sky.type));
        const auto sun_altitude = placed_.sun ? std::optional(placed_.sun->altitude) : std::nullopt;
        light.sky_illuminance = sky.illuminance.value_or(usual_sky_illuminance(sky.type, sun_altitude));
        if (sun_altitude) light.sun_illuminance = usual_sun_illuminance(sky.type, *sun_altitude);
        return light;
    }

    SkyDome dome(const ModelledDaylight& light) const {
        SkyDome dome{light.model, white(light.sky_illuminance), frame_.zenith, frame_.zenith};
        if (placed_.sun) dome.sun = towards_sun(*placed_.sun);
        const double sun_on_ground = placed_.sun ? light.sun_illuminance * sine_of(placed_.sun->altitude) : 0;
        if (light.sky_illuminance > 0)
            dome.ground = static_cast<float>(placed_.ground_reflectance * (1 + sun_on_ground / light.sky_illuminance));
        return dome;
    }

    static Rgb white(double value) { return Rgb(static_cast<float>(value)); }

    V3f towards(double azimuth) const {
        const double a = radians(azimuth);
        return frame_.east * static_cast<float>(std::sin(a)) + frame_.north * static_cast<float>(std::cos(a));
    }

    V3f towards_sun(const Daylight::Sun& sun) const {
        return towards(sun.azimuth) * static_cast<float>(std::cos(radians(sun.altitude))) +
               frame_.zenith * static_cast<float>(sine_of(sun.altitude));
    }

    void add_environment(const Daylight::Environment& environment) {
        auto image = read_environment(environment.file);
        scene_.files.push_back(environment.file.string());
        push("environment",
             EnvironmentMap{std::move(image), frame_.zenith, towards(environment.rotation), white(environment.scale)});
    }

    template <class Kind>
    void push(const char* name, Kind kind) {
        Luminaire luminaire{fmt::format("{}-{}", name, scene_.luminaires.size() + 1), 0, std::move(kind)};
        if (const std::string fault = luminaire_fault(luminaire); !fault.empty())
            throw InputError(fmt::format("the {} {}", name, fault));
        scene_.luminaires.push_back(std::move(luminaire));
        if (const std::string fault = sky_count_fault(scene_); !fault.empty()) throw InputError("the scene " + fault);
    }

    Scene& scene_;
    const Daylight& placed_;
    SkyFrame frame_;
};

}  // namespace

double usual_sky_illuminance(int cie_type, std::optional<double> sun_altitude) {
    constexpr double without_sun = 10'000;
    if (!sun_altitude) return without_sun;
    const double sine = sine_of(*sun_altitude);
    if (is_overcast(cie_type)) return 300 + 21'000 * sine;
    return cie_type <= last_intermediate ? 300 + 45'000 * sine : 800 + 15'500 * std::sqrt(sine);
}

double usual_sun_illuminance(int cie_type, double sun_altitude) {
    if (is_overcast(cie_type)) return 0;
    constexpr double beyond_atmosphere = 127'500, partly_cloudy = 0.80, clear = 0.21;
    return beyond_atmosphere *
           std::exp(-(cie_type <= last_intermediate ? partly_cloudy : clear) / sine_of(sun_altitude));
}

void add_daylight(Scene& scene, const Daylight& added) { DaylightAdder(scene, added).add(); }

}  // namespace interflect
