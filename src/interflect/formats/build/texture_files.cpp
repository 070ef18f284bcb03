#include "interflect/formats/build/texture_files.h"

#include <algorithm>
#include <utility>

#include "interflect/core.h"
#include "interflect/formats/text/text_file.h"
#include "interflect/image.h"
#include "interflect/image/codecs/srgb.h"
#include "interflect/image/files/photograph.h"

namespace interflect::detail {

Texture read_texture(const std::filesystem::path& path, std::uint64_t most) {
    Image image = read_photograph(path, static_cast<std::int64_t>(most));
    Texture texture{path.string(), static_cast<std::uint32_t>(image.width), static_cast<std::uint32_t>(image.height),
                    std::move(image.pixels)};
    if (const std::string fault = texture_fault(texture); !fault.empty()) throw InputError(path, 0, fault);
    return texture;
}

std::shared_ptr<const Texture> read_environment(const std::filesystem::path& path) {
    require_regular_file(path);
    if (needs_tone_mapping(require_image_format(path)))
        throw InputError(path, 0, "an image of 8 bits has no radiances, expected .exr or .hdr");
    return std::make_shared<Texture>(read_texture(path, max_environment_texels));
}

std::string texture_extension(const Texture& texture) {
    const auto is_srgb = [](const Rgb& texel) {
        for (int c = 0; c < 3; ++c)
            if (srgb_decode(static_cast<float>(srgb_byte(texel[c])) / 255) != texel[c]) return false;
        return true;
    };
    return std::all_of(texture.texels.begin(), texture.texels.end(), is_srgb) ? ".png" : ".exr";
}

void write_texture(const std::filesystem::path& path, const Texture& texture) {
    Image image;
    image.width = static_cast<int>(texture.width);
    image.height = static_cast<int>(texture.height);
    image.pixels = texture.texels;
    write_image(path, image);
}

}  // namespace interflect::detail
