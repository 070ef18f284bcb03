#pragma once

#include <string>
#include <string_view>

namespace interflect {

/// Relative luminance of a sky: the CIE standard general sky (CIE S 011:2003, ISO 15469:2004),
///     L(Z, chi) ~ phi(Z) f(chi),   phi(Z) = 1 + a exp(b / cos Z) + g cos Z,
///     f(chi) = 1 + c (exp(d chi) - exp(d pi / 2)) + e cos^2 chi,
/// with Z the angle from the zenith, up to 90 degrees, and chi the angle from the centre of the sun. The standard has
/// no g; a = 0, g = 2 is the traditional overcast sky (Moon and Spencer 1942).
struct SkyModel {
    float a = 0, b = -1, c = 0, d = -1, e = 0, g = 0;

    bool depends_on_sun() const { return c != 0 || e != 0; }
    /// phi(Z) f(chi) for cos Z >= 0; negative factors are clamped to 0. @param sun_cosine  cos chi.
    double relative_luminance(double zenith_cosine, double sun_cosine) const;
    /// Integral of relative_luminance() cos Z over the upper hemisphere: relative horizontal illuminance. Accurate to
    /// five digits; takes a few milliseconds. @param sun_cosine  Cosine of the angle between zenith and sun.
    double horizontal_integral(double sun_cosine) const;
};

/// Types of the standard, for example 1, steep overcast; 5, uniform; 7, partly cloudy; 12, clear with low turbidity. 16
/// is the traditional overcast sky: L(Z) = (1 + 2 cos Z) / 3 times the zenith luminance. @throws InputError unless 1 to
/// 16.
SkyModel cie_standard_sky(int type);

/// Type by name: "overcast" (1), "uniform" (5), "intermediate" (7), "clear" (12) or "cie-1" to "cie-16"; 0 for any
/// other name.
int cie_sky_type(std::string_view name);

/// Fault of a model, in words without a subject; empty if valid. The luminance must be finite and not 0 everywhere.
std::string sky_fault(const SkyModel& model);

/// Sky and sun from a model of daylight.
struct ModelledDaylight {
    SkyModel model;
    double sky_illuminance = 0;  ///< Horizontal, of the sky alone [lx].
    double sun_illuminance = 0;  ///< Illuminance of a surface facing the sun [lx].
};
/// All-weather model: sky luminance by Perez, Seals and Michalsky 1993, efficacies by Perez et al. 1990 with 2 cm of
/// precipitable water, air mass by Kasten and Young 1989, solar constant 1367 W/m^2. The model's f(chi) = 1 + c exp(d
/// chi) + e cos^2 chi is SkyModel with c and e divided by 1 + c exp(d pi / 2). For a clearness from 1.065 to 2.8 the
/// brightness is at least 0.2, as in Radiance's gendaylit.
/// @param direct_normal, diffuse_horizontal  Irradiances [W/m^2], >= 0 and > 0, at most the solar constant.
/// @param sun_altitude  [degrees], in (0, 90].
/// @throws InputError for arguments out of range.
ModelledDaylight perez_daylight(double direct_normal, double diffuse_horizontal, double sun_altitude);

}  // namespace interflect
