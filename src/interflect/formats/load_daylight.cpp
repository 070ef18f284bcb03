#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "interflect/daylight.h"
#include "interflect/error.h"
#include "interflect/formats/sky_lights.h"
#include "interflect/formats/text_file.h"
#include "interflect/formats/texture_files.h"
#include "interflect/scene/sky_frame.h"
#include "interflect/scene/web_angles.h"

namespace interflect {

namespace {

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
        double sun_illuminance = sun ? usual_sun_illuminance(clear_type, sun->altitude) : 0;
        SkyDome dome;
        double sky_illuminance = 0;
        if (placed_.perez_sky) {
            const PerezDaylight perez = perez_daylight(placed_.perez_sky->direct_normal,
                                                       placed_.perez_sky->diffuse_horizontal, altitude("perez"));
            dome.model = perez.model;
            sky_illuminance = perez.sky_illuminance, sun_illuminance = perez.sun_illuminance;
        } else if (placed_.cie_sky) {
            const int type = placed_.cie_sky->type;
            dome.model = cie_standard_sky(type);
            if (dome.model.depends_on_sun()) altitude(fmt::format("of CIE type {}", type));
            sky_illuminance = placed_.cie_sky->illuminance.value_or(
                usual_sky_illuminance(type, sun ? std::optional(sun->altitude) : std::nullopt));
            if (sun) sun_illuminance = usual_sun_illuminance(type, sun->altitude);
        }
        if (sun) sun_illuminance = sun->illuminance.value_or(sun_illuminance);
        if (sun && sun_illuminance > 0)
            push("sun", DirectionalLight{-towards_sun(*sun), Rgb(static_cast<float>(sun_illuminance)), sun_diameter});
        if (placed_.perez_sky || placed_.cie_sky) {
            dome.zenith = frame_.zenith;
            dome.sun = sun ? towards_sun(*sun) : frame_.zenith;
            dome.irradiance = Rgb(static_cast<float>(sky_illuminance));
            const double on_ground = sky_illuminance + (sun ? sun_illuminance * sine_of(sun->altitude) : 0);
            if (sky_illuminance > 0)
                dome.ground = static_cast<float>(placed_.ground_reflectance * on_ground / sky_illuminance);
            push("sky", dome);
        }
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
        push("environment", EnvironmentMap{std::move(image), frame_.zenith, towards(environment.rotation),
                                           Rgb(static_cast<float>(environment.scale))});
    }

    template <class Kind>
    void push(const char* name, Kind kind) {
        Luminaire luminaire{fmt::format("{}-{}", name, scene_.luminaires.size() + 1), 0, std::move(kind)};
        if (const std::string fault = luminaire_fault(luminaire); !fault.empty())
            throw InputError(fmt::format("the {} {}", name, fault));
        scene_.luminaires.push_back(std::move(luminaire));
    }

    Scene& scene_;
    const Daylight& placed_;
    SkyFrame frame_;
};

}  // namespace

double usual_sky_illuminance(int cie_type, std::optional<double> sun_altitude) {
    constexpr double of_overcast = 10'000;
    if (!sun_altitude) return of_overcast;
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

void add_daylight(Scene& scene, const Daylight& placed) { DaylightAdder(scene, placed).add(); }

std::shared_ptr<const Texture> detail::read_environment(const std::filesystem::path& path) {
    require_regular_file(path);
    return std::make_shared<Texture>(read_texture(path, most_environment_texels));
}

}  // namespace interflect
