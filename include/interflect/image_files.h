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
    png,   ///< 8-bit sRGB, for display. Needs a tone-mapped image.
    jpeg,  ///< As png, lossy. Can be written, and read as texture only.
    exr,   ///< OpenEXR, linear 32-bit float, for measuring. Stores ImageMetadata.
    hdr,   ///< Radiance RGBE, linear, 8-bit mantissas with a common exponent.
};

/// Image format for a file name's extension (.png .jpg .jpeg .exr .hdr, ignoring case).
/// @throws InputError, listing the extensions, for any other.
ImageFormat require_image_format(const std::filesystem::path& path);

/// Whether the format stores 8-bit sRGB values and therefore needs a tone-mapped image.
constexpr bool needs_tone_mapping(ImageFormat format) {
    return format == ImageFormat::png || format == ImageFormat::jpeg;
}

/// Content and origin of an image. OpenEXR files store it in the attributes interflect.view, .eye, .look_at (both in
/// world coordinates, double precision), .up, .fov or .extent, .quantity, .scene, .exposure, .seed (text, since it has
/// 64 bits) and .version; names are escaped() (base/escapes.h).
struct ImageMetadata {
    View view;
    std::string quantity = "radiance [cd/m^2]";  ///< With its unit.
    std::string scene;                           ///< Source file.
    std::string version;                         ///< Version of this program.
    std::uint64_t seed = 0;
    float exposure = 0;  ///< Suggested for display [stops]: see exposure in tone_map.h.
};

/// An additional layer of an OpenEXR file.
struct ImageLayer {
    std::string name;               ///< Prefix of the channels: name.R and so on; empty: R.
    std::string channels;           ///< One letter each: "RGB", "XYZ", "Z".
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
///         truncated or damaged, or claims more than `most_pixels`.
Image read_image(const std::filesystem::path& path, std::int64_t most_pixels = most_image_pixels);

/// Vertical field of view [degrees] stored in an .exr file by write_image(); nullopt without this attribute and for all
/// other formats.
/// @throws InputError as read_image() does, and for a value outside (0, 180).
std::optional<float> read_field_of_view(const std::filesystem::path& path);

}  // namespace interflect
