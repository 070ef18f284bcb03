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

/// Returns a name without the comment that follows it after a blank and '#'.
inline std::string_view without_comment(std::string_view name) {
    const std::size_t comment = std::min(name.find(" #"), name.find("\t#"));
    return comment == name.npos ? name : name.substr(0, name.find_last_not_of(" \t", comment) + 1);
}

/// Returns the words of a line before a comment, which starts at a word that begins with '#'.
inline std::span<const std::string_view> without_comment(std::span<const std::string_view> words) {
    return {words.begin(), std::find_if(words.begin(), words.end(), [](auto word) { return word.starts_with('#'); })};
}

/// Materials of the libraries (MTL) of an OBJ file.
class ObjMaterials {
  public:
    /// Adds a default material.
    ObjMaterials(Model& model, const ReadOptions& options);

    /// Reads a file once. @throws InputError; std::invalid_argument if forbidden by the options.
    void read(const std::filesystem::path& path, const Location& where);
    void read_text(std::string_view text, const std::filesystem::path& path);
    /// Returns an index into Model::materials; 0, with a warning, if unknown. A comment may follow the name.
    std::uint32_t find(const std::string& name, const Location& where);

  private:
    struct Definition {
        Rgb diffuse{0.5f, 0.5f, 0.5f}, emitted{0, 0, 0}, specular{0, 0, 0};
        float opacity = 1;
        bool has_dissolve = false;      // `d`, which overrides `Tr`
        std::filesystem::path texture;  // map_Kd
        std::filesystem::path mask;     // map_d
        // Keys that are left out with a warning:
        bool has_emission_image = false;      // map_Ke
        bool has_specular_image = false;      // map_Ks
        bool has_transparency_image = false;  // map_Tr
        bool has_filter = false;              // Tf, unless it is 0 or 1
        Location where;
        std::uint32_t material = none;  // set by find()
    };
    void read_line(std::span<const std::string_view> line, Definition& definition, const Location& where);
    std::filesystem::path texture_path(std::span<const std::string_view> words, const Location& where);
    /// Returns null if no library defines the material.
    Definition* find_definition(const std::string& name);
    std::uint32_t convert(const std::string& name, const Definition& definition);
    std::uint32_t colour_texture(const Definition& definition);
    /// Returns the colours of a material's texture, or white if it has no texture.
    Texture read_colours(const Definition& definition);
    StoredImage read_mask(const Definition& definition);
    /// Returns whether the file exists in a format that the key allows. If not, warns.
    bool accept_texture(const std::filesystem::path& texture, std::string_view key, const Definition& definition);
    /// Sets the textures of a material with holes. Returns whether colours above 1 were reduced.
    bool cut_out(const Definition& definition, Material& material);
    void warn_of_lost_light(const Definition& definition);
    /// Counts decoded pixels, to limit the work. @throws InputError
    void count_decoded(std::size_t pixels);
    std::uint32_t add_texture(Texture texture);
    void warn(const std::string& kind, const std::string& message, const Location& where) {
        model_.warnings.add(kind, message, where.text());
    }

    Model& model_;
    const ReadOptions& options_;
    std::unordered_map<std::string, Definition> definitions_;
    /// Definitions whose name is followed by a comment, by the name alone; null if several have this name.
    std::unordered_map<std::string, Definition*> commented_;
    std::unordered_map<std::string, std::uint32_t> colour_textures_;  // indices of textures, by file
    std::unordered_set<std::string> read_;                            // paths of libraries
    std::list<std::filesystem::path> libraries_;                      // locations refer to these paths
    std::uint64_t texels_ = 0, decoded_ = 0;
};

}  // namespace interflect::detail
