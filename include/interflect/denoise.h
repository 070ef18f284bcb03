/// @file
/// Filters against the noise of pictures.
#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "interflect/image.h"
#include "interflect/render.h"

namespace interflect {

/// Filter against noise.
enum class Denoiser {
    automatic,  ///< `oidn` where its library is found, else `own`.
    /// Intel Open Image Denoise 2, a learned filter. Both halves of the samples are filtered, direct and indirect light
    /// together, as irradiance. Where the filter moves light by more than noise explains, measured between the
    /// independent halves, the moved light is returned, scale by scale and region by region.
    oidn,
    /// Pairs of pixels exchange light. Direct and indirect light are filtered separately, as irradiance, which keeps
    /// reflectances, textures and emitters sharp. Two pixels exchange light if they lie in each other's tangent plane
    /// and their light differs by no more than noise explains, which preserves shadow borders (non-local means, Buades
    /// et al. 2005, with estimated variance as in Rousselle et al. 2012). Weights of one half of the samples come from
    /// the other half. The sum of irradiance over the picture is kept exactly; details are biased where the light
    /// varies by less than its noise.
    own,
};

/// Labels of Denoiser in its order, as on the command line and in Python.
inline constexpr std::array denoiser_labels{"auto", "oidn", "own"};

constexpr const char* label(Denoiser denoiser) { return denoiser_labels[static_cast<std::size_t>(denoiser)]; }

/// @throws InputError for another text than a label.
Denoiser find_denoiser(const std::string& text);

/// Returns the filter that `denoiser` stands for, oidn or own.
/// @throws InputError for `oidn` without its library, with the reason and the remedy.
Denoiser available_denoiser(Denoiser denoiser);

/// A picture without most of its noise.
struct DenoisedPicture {
    Image image;  ///< In the unit of the layers.
    /// Standard error of each pixel and channel, as estimated from the halves of the samples, with the light that the
    /// filter moved; the mean over the surrounding region. Empty with Denoiser::own, which makes no estimate.
    Image standard_error;
    std::string filter;  ///< "own", or "Open Image Denoise 2.5.1".
};

/// Removes noise from a picture drawn by paths.
/// @return  The same bits for any number of threads on one kind of processor.
/// @throws InputError for the filter oidn without its library, std::runtime_error if the library fails.
DenoisedPicture denoise(const PictureLayers& layers, Denoiser denoiser = Denoiser::automatic);

/// Library of Denoiser::oidn.
struct DenoiserLibrary {
    std::string version;  ///< "2.5.1"; empty if none can be used.
    std::string file;     ///< Path, or name for the dynamic linker.
    std::string fault;    ///< Reason, if none can be used.
};

/// Finds the library: the file INTERFLECT_OIDN of the environment if it is set; otherwise libOpenImageDenoise.so.2 of
/// the system, of scripts/setup denoiser, or of the Python package pyoidn in the active virtual environment.
DenoiserLibrary denoiser_library();

}  // namespace interflect
