/// @file
/// Images, their files, tone mapping and exposure.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "interflect/core.h"
#include "interflect/scene.h"

namespace interflect {

/// Limit for rendering and reading images, independent of file headers.
inline constexpr std::int64_t max_image_pixels = std::int64_t{1} << 28;

/// A picture: linear Rec. 709 colours in any unit, row by row, row 0 at the top.
struct Image {
    int width = 0, height = 0;
    std::vector<Rgb> pixels;  ///< [y * width + x]

    Image() = default;
    /// @param fill  Initial colour of every pixel.
    Image(int image_width, int image_height, const Rgb& fill = Rgb(0, 0, 0))
        : width(image_width),
          height(image_height),
          pixels(static_cast<std::size_t>(image_width) * static_cast<std::size_t>(image_height), fill) {}

    Rgb& at(int x, int y) { return pixels[index(x, y)]; }
    const Rgb& at(int x, int y) const { return pixels[index(x, y)]; }

  private:
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    }
};

/// @throws InputError unless the image has pixels and their number matches width and height.
void require_pixels(const Image& image);

/// @throws InputError unless both images have pixels and the same size.
void require_same_size(const Image& image, const Image& reference);

/// Replaces every factor x factor block of pixels by its mean.
/// @throws InputError if width or height is not a multiple of `factor`, factor < 1, and as require_pixels() does.
Image box_downsample(const Image& image, int factor);

/// Returns the number of pixels with an infinite or NaN channel.
std::int64_t count_non_finite(const Image& image);

enum class ImageFormat {
    png,   ///< 8-bit sRGB for display; needs a tone-mapped image.
    jpeg,  ///< Like png, but lossy; can be written, but only read as a texture.
    exr,   ///< OpenEXR, linear 32-bit float, for measurements; stores ImageMetadata.
    hdr,   ///< Radiance RGBE, linear, 8-bit mantissas with a common exponent.
};

/// Returns the image format for a file name's extension (.png .jpg .jpeg .exr .hdr, ignoring case).
/// @throws InputError that lists the extensions, for any other extension.
ImageFormat require_image_format(const std::filesystem::path& path);

/// Whether the format stores 8-bit sRGB values and therefore needs a tone-mapped image.
constexpr bool needs_tone_mapping(ImageFormat format) {
    return format == ImageFormat::png || format == ImageFormat::jpeg;
}

/// Content and origin of an image. OpenEXR files store it in the attributes interflect.view, .eye, .look_at (both in
/// world coordinates, double precision), .up, .fov or .extent, .quantity, .scene, .exposure, .seed (text, since it has
/// 64 bits) and .version; control characters in names are escaped.
struct ImageMetadata {
    View view;
    std::string quantity = "radiance [cd/m^2]";  ///< Quantity of the pixels with its unit.
    std::string scene;                           ///< Source file.
    std::string version;                         ///< Version of this program.
    std::uint64_t seed = 0;
    float exposure = 0;  ///< Suggested exposure for display [stops]; see tone_map().
    std::string filter;  ///< Filter against noise (DenoisedPicture::filter); empty: none.
};

/// An additional layer of an OpenEXR file.
struct ImageLayer {
    std::string name;               ///< Prefix of the channels, as in name.R; if it is empty, the channel is R.
    std::string channels;           ///< One letter for each channel, such as "RGB", "XYZ" or "Z".
    std::span<const float> values;  ///< Row by row, row 0 at the top, channels interleaved.
};

/// Writes an image in the format of the extension of `path`. The same arguments give the same bytes.
/// @param image     Linear Rec. 709. For .png and .jpg tone-mapped and clamped to [0, 1]; for .hdr clamped to [0,
///                  2^126]. These three formats show non-finite pixels as pure magenta.
/// @param metadata, layers  Stored by .exr only.
/// @throws InputError for an unknown extension and as require_pixels() does; std::runtime_error with the path and the
///         reason if the file cannot be written.
void write_image(const std::filesystem::path& path, const Image& image, const ImageMetadata& metadata = ImageMetadata(),
                 std::span<const ImageLayer> layers = {});

/// Reads an image in the format of the extension of `path`, as linear Rec. 709 (.png is decoded from sRGB). An .exr
/// file must have channels R, G and B; its data window is the image. Alpha is ignored.
/// @throws InputError with the path and the reason for a file that is missing, is not such an image, is a JPEG, is
///         truncated or damaged, or claims more pixels than permitted.
Image read_image(const std::filesystem::path& path, std::int64_t max_pixels = max_image_pixels);

/// Vertical field of view [degrees] stored in an .exr file by write_image(); nullopt without this attribute and for all
/// other formats.
/// @throws InputError as read_image() does, and for a value outside (0, 180).
std::optional<float> read_field_of_view(const std::filesystem::path& path);

/// Tone mapping operators from luminance to display values in [0, 1]. All are monotonic and preserve black.
///
/// The first four are curves for values scaled by an exposure to about 1, in any unit. The last three model an observer
/// of the scene and one of the display. They need luminances in cd/m^2 and choose the brightness from the adaptation
/// luminance L_wa, so dim scenes look dim. L_wa is the logarithmic mean of luminance, over the same pixels as in
/// automatic_exposure().
enum class Tonemap {
    srgb,      ///< Linear, clipped at 1: displays true ratios of light.
    reinhard,  ///< On luminance, which preserves hue; 4 becomes white (Eq. 4 of Reinhard et al. 2002).
    filmic,    ///< Narkowicz's fit of the ACES response, per channel; keeps mid-grey 0.18, 10 becomes white.
    agx,       ///< Sobotka's AgX: bright colours desaturate as on film; 0.18 becomes 0.22; 6.5 stops above is white.
    ward,      ///< A single factor that preserves the visibility of threshold contrasts (Ward 1994).
    tumblin,  ///< Preserves brightness by Stevens' law (Tumblin and Rushmeier 1993, as revised by Tumblin et al. 1999).
    ferwerda,  ///< Thresholds of cones and rods; colours fade below 20 cd/m^2 (Ferwerda et al. 1996, without acuity).
};

/// Whether an operator needs luminances in cd/m^2 of the scene and the display, and chooses the brightness itself.
constexpr bool is_absolute(Tonemap curve) { return curve >= Tonemap::ward; }

/// Approximate white of an sRGB display [cd/m^2] (IEC 61966-2-1 has 80; most are brighter).
inline constexpr float usual_display_luminance = 100;

/// Exposure for a natural impression of a lit room [stops]: the logarithmic mean of luminance becomes 0.2, near the
/// normal key of Reinhard et al. 2002. Ignores black and non-finite pixels, and the darkest and brightest 5% of the
/// others, to exclude visible lamps and dark windows. 0 for a picture without light.
float automatic_exposure(const Image& image);

/// Maps a picture to display values in [0, 1] (linear; write_image() encodes them as sRGB). Black and non-finite pixels
/// are unchanged.
/// @param image     Radiance. [cd/m^2] if is_absolute(curve): a picture in W/(m^2 sr) then looks too dark.
/// @param exposure  [stops]; one more doubles the brightness. Curves receive values times 2^exposure: at 0 a luminance
///                  of 1 cd/m^2 is 1. If is_absolute(curve) the result is multiplied; 0 is as published.
/// @param display_luminance  White of the display [cd/m^2], > 0; used if is_absolute(curve).
/// @throws InputError for an exposure that is not finite, and a display luminance that is not finite and > 0.
Image tone_map(const Image& image, float exposure, Tonemap curve = Tonemap::srgb,
               float display_luminance = usual_display_luminance);

/// Encodes a tone-mapped image as the bytes of a PNG file. @throws InputError as require_pixels() does.
std::string encode_png(const Image& image);

/// Whether files of this format can hold an image of this size: PNG takes at most 2^30 bytes before compression.
bool can_hold(ImageFormat format, int width, int height);

/// Display values of a linear Rec. 709 colour: 8-bit sRGB of each channel, clamped. No channel may be NaN.
std::array<std::uint8_t, 3> srgb_bytes(const Rgb& linear);

}  // namespace interflect
