#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "interflect/formats/build/model.h"
#include "interflect/formats/mesh/obj/materials.h"
#include "interflect/formats/text/line_reader.h"

namespace interflect::detail {

/// Reads Wavefront OBJ. A library such as tinyobjloader would accept invalid indices and numbers.
class ObjReader {
  public:
    ObjReader(const std::filesystem::path& path, const ReadOptions& options);
    void read(std::string_view text);
    Model finish() { return std::move(model_); }

  private:
    /// Latest use of a position.
    struct Use {
        std::uint32_t mesh = none, index = 0, coordinate = none, normal = none;
    };
    struct Counts {
        std::size_t positions = 0, coordinates = 0, normals = 0;
    };
    void read_line(const LineReader& line, std::span<const std::string_view> words, const Location& where);
    void read_vertex_data(std::span<const std::string_view> words, const Location& where);
    void read_ahead();
    void vertex(std::span<const std::string_view> words);
    void coordinate(std::span<const std::string_view> words, const Location& where);
    void normal(std::span<const std::string_view> words);
    std::uint32_t normal_index(std::string_view text, const Location& where);
    std::uint32_t resolved(std::string_view text, std::size_t Counts::*kind, std::string_view name,
                           const Location& where);
    void face(std::span<const std::string_view> words, const Location& where);
    void libraries(const LineReader& line, std::span<const std::string_view> words, const Location& where);
    std::uint32_t corner(std::string_view word, const Location& where);
    /// Returns the index of the mesh with the current object and material.
    std::uint32_t mesh();
    /// Returns the index of the current object, which is named after its object and group in the file.
    std::uint32_t object();

    ReadOptions options_;
    Model model_;
    ObjMaterials materials_;
    std::vector<Imath::V3d> positions_;
    std::vector<V2f> coordinates_;
    std::vector<Imath::V3d> normals_;
    std::vector<Use> uses_;  // one entry per position
    const LineReader* lines_ = nullptr;
    Counts preceding_;               // numbers of entries before the current line
    bool has_all_vertices_ = false;  // whether the vertices of later lines have been read
    std::string object_, group_;
    std::uint32_t material_ = 0;
    std::uint32_t mesh_ = none;                                                // current mesh, once it has faces
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> meshes_;  // keys: object and material
    std::unordered_map<std::string, std::uint32_t> object_index_;
};

}  // namespace interflect::detail
