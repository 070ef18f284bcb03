#pragma once

#include <cstdint>
#include <filesystem>
#include <list>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>

#include "interflect/formats/location.h"
#include "interflect/formats/model.h"
#include "interflect/image/stored_image.h"

namespace interflect::inline detail {

/// The materials of OBJ files, from their libraries (.mtl).
class ObjMaterials {
  public:
    /// @param model  Gets materials, textures, files and warnings. Its first material is the default one.
    ObjMaterials(Model& model, const ReadOptions& options);

    /// Reads a library. @param where  The line that names it. @throws InputError, std::invalid_argument
    void read(const std::filesystem::path& path, const Location& where);
    /// The same from memory. @param path  Name for messages; its folder is where textures are looked for.
    void read_text(std::string_view text, const std::filesystem::path& path);
    /// Index in Model::materials; of the default one, with a warning, where no library has the name.
    std::uint32_t find(const std::string& name, const Location& where);

  private:
    /// What a library tells of a material.
    struct Definition {
        Rgb diffuse{0.5f, 0.5f, 0.5f}, emitted{0, 0, 0}, specular{0, 0, 0};
        float opacity = 1;
        bool has_dissolve = false;      // d, which overrides Tr
        std::filesystem::path texture;  // of the diffuse reflectance
        std::filesystem::path mask;     // of the opacity
        Location where;
        std::uint32_t material = none;  // index in Model::materials, once it is used
    };
    void read_line(std::span<const std::string_view> words, Definition& definition, const Location& where);
    std::filesystem::path texture_path(std::span<const std::string_view> words, const Location& where);
    std::uint32_t convert(const std::string& name, const Definition& definition);
    /// Index in Model::textures of a material's texture; none where it has none that can be read, with a warning.
    std::uint32_t texture(const Definition& definition);
    /// Its texture, read anew: white where it has none that can be read.
    Texture read_colours(const Definition& definition);
    StoredImage read_mask(const Definition& definition);
    /// Whether there is a texture that can be read; else warns. @param key  What names it in the library.
    bool is_readable(const std::filesystem::path& texture, std::string_view key, const Definition& definition);
    /// Gives a material the holes of its mask.
    void cut_out(const Definition& definition, Material& material);
    std::uint32_t add_texture(Texture texture);
    void warn(const std::string& kind, const std::string& message, const Location& where) {
        model_.warnings.add(kind, message, where.text());
    }

    Model& model_;
    const ReadOptions& options_;
    std::unordered_map<std::string, Definition> definitions_;
    std::unordered_map<std::string, std::uint32_t> textures_;  // by path
    std::list<std::filesystem::path> libraries_;               // which locations point to
    std::uint64_t texels_ = 0;
};

}  // namespace interflect::inline detail
