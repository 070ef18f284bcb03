#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "interflect/image.h"
#include "interflect/scene.h"

namespace interflect {

enum class ImageFormat {
    png,   ///< 8 bit sRGB: for people. Needs a tone-mapped image.
    jpeg,  ///< As png, lossy: written, and read as textures alone.
    exr,   ///< OpenEXR, linear 32 bit float: for measuring. Carries ImageMetadata.
    hdr,   ///< Radiance RGBE, linear, 8 bit mantissas with a common exponent.
};

/// The format that a file name's extension asks for (.png .jpg .jpeg .exr .hdr, in any case).
/// @throws InputError, listing the extensions, for any other.
ImageFormat require_image_format(const std::filesystem::path& path);

/// Whether the format holds 8 bit sRGB values, so that an image has to be tone-mapped first.
constexpr bool needs_tone_mapping(ImageFormat format) {
    return format == ImageFormat::png || format == ImageFormat::jpeg;
}

/// What an image shows and how it came to be. An OpenEXR file keeps it as the attributes interflect.view, .eye,
/// .look_at (both in world coordinates, double precision), .up, .fov or .extent, .quantity, .scene, .exposure, .seed
/// (text, since it has 64 bits) and .version; names are escaped() (base/escapes.h).
struct ImageMetadata {
    View view;
    std::string quantity = "radiance [cd/m^2]";  ///< With its unit.
    std::string scene;                           ///< The file it came from.
    std::string version;                         ///< Of this program.
    std::uint64_t seed = 0;
    float exposure = 0;  ///< Suggested for display, [stops]: see exposure in tone_map.h.
};

/// A further layer of an OpenEXR file.
struct ImageLayer {
    std::string name;               ///< Its channels are name.R and so on; empty: just R.
    std::string channels;           ///< A letter each: "RGB", "XYZ", "Z".
    std::span<const float> values;  ///< Row by row, row 0 at the top, the channels of a pixel side by side.
};

/// Writes an image in the format of the extension of `path`. Same arguments, same bytes.
/// @param image     Linear Rec. 709. For .png and .jpg tone-mapped: values are clamped to [0, 1]; for .hdr they are
/// clamped
///                  to [0, 2^126]. In these three a pixel that is not finite becomes pure magenta, to be seen.
/// @param metadata, layers  Kept by .exr only.
/// @throws InputError for an unknown extension and as require_pixels() does; std::runtime_error with the path and the
///         reason where the file cannot be written.
void write_image(const std::filesystem::path& path, const Image& image, const ImageMetadata& metadata = ImageMetadata(),
                 std::span<const ImageLayer> layers = {});

/// Reads an image in the format of the extension of `path`, as linear Rec. 709 (.png is decoded from sRGB).
/// An .exr file must have channels R, G and B; its data window is the image. Alpha is ignored.
/// @throws InputError with the path and the reason for a file that is missing, is no such image, is a JPEG, is cut
/// short
///         or damaged, or claims more than `most_pixels`.
Image read_image(const std::filesystem::path& path, std::int64_t most_pixels = most_image_pixels);

/// The vertical field of view [degrees] that write_image() noted in an .exr file; none where there is no such note, as
/// in all other formats.
/// @throws InputError as read_image() does, and for a note that is not above 0 and below 180.
std::optional<float> read_field_of_view(const std::filesystem::path& path);

}  // namespace interflect
