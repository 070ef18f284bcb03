#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <list>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>

#include "interflect/formats/build/model.h"
#include "interflect/formats/reading/location.h"
#include "interflect/image/codecs/stored_image.h"

namespace interflect::detail {

/// Removes the comment after a name, and the blanks before it. The comment begins with a blank and '#', because names
/// may contain '#'.
inline std::string_view name_before_comment(std::string_view name) {
    const std::size_t comment = std::min(name.find(" #"), name.find("\t#"));
    return comment == name.npos ? name : name.substr(0, name.find_last_not_of(" \t", comment) + 1);
}

/// Returns the words of a line before its comment. The comment begins with a word that starts with '#'.
inline std::span<const std::string_view> words_before_comment(std::span<const std::string_view> words) {
    return {words.begin(), std::find_if(words.begin(), words.end(), [](auto word) { return word.starts_with('#'); })};
}

/// Reads the material libraries (MTL) of an OBJ file. Adds the used materials and their textures to a Model.
class ObjMaterials {
  public:
    /// Adds a default material. Refers to its arguments.
    ObjMaterials(Model& model, const ReadOptions& options);

    /// Reads the definitions of a library, if it has not been read. Warns if the file does not exist.
    /// @param reference  Place of the library's name in the OBJ file.
    /// @throws InputError; std::invalid_argument if ReadOptions::max_include_depth or outside_files forbids the file.
    void read_library(const std::filesystem::path& path, const Location& reference);
    /// Reads the text of a library. @param path  Path of the library, for messages and relative names of textures.
    void read_definitions(std::string_view text, const std::filesystem::path& path);
    /// Returns the index of a material in Model::materials. Adds the material at its first use. If no library defines
    /// the material, warns and returns 0, the index of the default material.
    /// @param name       May contain a comment after the name.
    /// @param reference  Place of the name in the OBJ file.
    std::uint32_t index_of(const std::string& name, const Location& reference);

  private:
    struct Definition {
        Rgb diffuse{0.5f, 0.5f, 0.5f};      // Kd
        Rgb emitted{0, 0, 0};               // Ke, radiance
        Rgb specular{0, 0, 0};              // Ks
        float opacity = 1;                  // d, or 1 - Tr
        bool has_dissolve = false;          // whether d is given, which overrides Tr
        std::filesystem::path colour_file;  // map_Kd, or empty
        std::filesystem::path mask_file;    // map_d, or empty
        // Keys that are left out with a warning:
        bool has_emission_image = false;      // map_Ke
        bool has_specular_image = false;      // map_Ks
        bool has_transparency_image = false;  // map_Tr
        bool has_filter = false;              // Tf, unless it is neutral
        Location location;                    // line of newmtl
        std::uint32_t material_index = none;  // index in Model::materials after the first use
    };
    Definition& start_definition(const std::string& name, const Location& location);
    void read_line(std::span<const std::string_view> words, Definition& definition, const Location& location);
    /// Reads d or Tr. @param words  The key and its values.
    static void read_opacity(std::span<const std::string_view> words, Definition& definition);
    /// Returns the path of a texture. @param words  Options and the file name, which may contain spaces and '#'.
    std::filesystem::path texture_path(std::span<const std::string_view> words, const Location& location);
    /// Returns null if no library defines the material, or if the name matches several.
    Definition* find_definition(const std::string& name);

    /// Adds a material to the model. Returns its index.
    std::uint32_t add_material(const std::string& name, const Definition& definition);
    /// Adds the reflectance and transmittance of a material with a mask (map_d) as textures of the mask's size.
    /// Returns whether reflectances above 1 were reduced.
    bool add_masked_textures(const Definition& definition, Material& material);
    /// Limits reflectance and transmittance, so that energy is conserved. Returns whether they changed.
    bool limit_material(Material& material, bool has_mask) const;
    void warn_of_omitted_keys(const Definition& definition);

    /// Returns the index of the texture of map_Kd; `none` if the material has none. Each file becomes one texture.
    std::uint32_t colour_texture_index(const Definition& definition);
    /// Returns the index of the new texture.
    std::uint32_t add_texture(Texture texture);
    /// Reduces the largest textures if the model has more than max_texels. @param location  Place for the warning.
    void limit_texels(const Location& location);
    /// Reads the image of map_Kd. Requires accept_texture().
    Texture read_colours(const Definition& definition);
    StoredImage read_mask(const Definition& definition);
    /// Returns whether a texture exists in a format that the key (map_Kd or map_d) allows. If not, warns.
    bool accept_texture(const std::filesystem::path& texture, std::string_view key, const Definition& definition);
    /// Adds to the number of decoded pixels. @throws InputError above a limit.
    void count_decoded(std::size_t pixels);

    void warn(const std::string& kind, const std::string& message, const Location& location) {
        model_.warnings.add(kind, message, location.text());
    }

    Model& model_;
    const ReadOptions& options_;
    std::unordered_map<std::string, Definition> definitions_;  // keys: names with their comments
    /// Definitions with a comment after their name. Keys: names without comments. Null if several names become equal.
    std::unordered_map<std::string, Definition*> commented_definitions_;
    std::unordered_map<std::string, std::uint32_t> colour_textures_;  // indices of textures; keys: files
    std::unordered_set<std::string> read_paths_;                      // paths given to read_library()
    std::list<std::filesystem::path> library_paths_;                  // locations refer to these paths
    std::uint64_t texel_count_ = 0;                                   // number of texels in Model::textures
    std::uint64_t decoded_pixels_ = 0;                                // number of pixels of all decoded images
};

}  // namespace interflect::detail
