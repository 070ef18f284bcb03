#include "interflect/denoise.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>

#include "interflect/core.h"
#include "interflect/render/filters/combine.h"
#include "interflect/render/filters/oidn.h"
#include "interflect/render/filters/own_filter.h"
#include "interflect/render/filters/surfaces.h"

namespace interflect {

using namespace detail;

namespace {

Image products(const Image& a, const Image& b) {
    Image result = a;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) result.pixels[i] *= b.pixels[i];
    return result;
}

Image quotients(const Image& a, const Image& b) {
    Image result = a;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) result.pixels[i] /= b.pixels[i];
    return result;
}

Image clamped(Image image, float low, float high) {
    for (Rgb& pixel : image.pixels)
        for (int c = 0; c < 3; ++c) pixel[c] = std::clamp(pixel[c], low, high);
    return image;
}

/// Reflected light of a half of the samples; 0 where it is not finite.
Image reflected_light(const SampledLight& half) {
    Image light = half.direct;
    for (std::size_t i = 0; i < light.pixels.size(); ++i) {
        light.pixels[i] += half.indirect.pixels[i];
        if (!is_finite(light.pixels[i])) light.pixels[i] = Rgb(0);
    }
    return light;
}

/// Albedo 1 of all surfaces: their irradiance over pi is the radiance of white ones.
Image white_surfaces(const PictureLayers& layers) {
    Image white(layers.albedo.width, layers.albedo.height);
    for (std::size_t i = 0; i < white.pixels.size(); ++i) white.pixels[i] = Rgb(layers.depth[i] > 0 ? 1.0f : 0.0f);
    return white;
}

/// Whether all pixels are black. The library would add a little light to them, which an automatic exposure shows.
bool is_black(const Image& light) {
    return std::all_of(light.pixels.begin(), light.pixels.end(), [](const Rgb& pixel) { return pixel == Rgb(0); });
}

DenoisedPicture denoise_by_oidn(const PictureLayers& layers, const std::shared_ptr<const Oidn>& library) {
    constexpr float largest = std::numeric_limits<float>::max();
    const Image albedo = clamped(layers.albedo, least_albedo, 1);
    const OidnFilter filter(library, white_surfaces(layers), layers.normal);
    std::array<Image, 2> noisy, filtered;
    for (std::size_t h = 0; h < 2; ++h) {
        noisy[h] = quotients(reflected_light(layers.halves[h]), albedo);
        filtered[h] = is_black(noisy[h]) ? noisy[h] : filter(clamped(noisy[h], 0, largest));
    }
    const CombinedLight combined = combine(Surfaces(layers), albedo, noisy, filtered);

    DenoisedPicture picture{layers.emitted, Image(albedo.width, albedo.height),
                            "Open Image Denoise " + library->version()};
    const Image reflected = products(combined.light, albedo);
    for (std::size_t i = 0; i < picture.image.pixels.size(); ++i) {
        const Rgb unfiltered = layers.reflected.direct.pixels[i] + layers.reflected.indirect.pixels[i];
        const bool is_filtered = layers.depth[i] > 0 && is_finite(unfiltered);
        picture.image.pixels[i] += is_filtered ? reflected.pixels[i] : unfiltered;
        if (!is_filtered) continue;
        // The halves share the records of indirect light, so their difference lacks the variance of the records.
        const float variance_of_records = layers.is_indirect_interpolated ? layers.reflected.indirect_variance[i] : 0;
        for (int c = 0; c < 3; ++c)
            picture.standard_error.pixels[i][c] = std::sqrt(combined.squared_error.pixels[i][c] + variance_of_records);
    }
    return picture;
}

}  // namespace

Denoiser find_denoiser(const std::string& text) {
    const auto found = std::find(denoiser_labels.begin(), denoiser_labels.end(), text);
    if (found == denoiser_labels.end())
        throw InputError(fmt::format("denoiser: expected auto, oidn or own, found '{}'", text));
    return static_cast<Denoiser>(found - denoiser_labels.begin());
}

Denoiser available_denoiser(Denoiser denoiser) {
    if (denoiser == Denoiser::own) return denoiser;
    const FoundOidn found = find_oidn();
    if (found.library) return Denoiser::oidn;
    if (denoiser == Denoiser::oidn) throw InputError("denoiser oidn: " + found.fault);
    return Denoiser::own;
}

DenoisedPicture denoise(const PictureLayers& layers, Denoiser denoiser) {
    if (available_denoiser(denoiser) == Denoiser::oidn) return denoise_by_oidn(layers, find_oidn().library);
    return {own_filter(layers), {}, label(Denoiser::own)};
}

DenoiserLibrary denoiser_library() {
    const FoundOidn found = find_oidn();
    if (!found.library) return {{}, {}, found.fault};
    return {found.library->version(), found.library->file().string(), {}};
}

}  // namespace interflect
