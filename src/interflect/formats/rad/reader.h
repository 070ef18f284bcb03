#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "interflect/formats/build/model.h"
#include "interflect/formats/rad/generators.h"
#include "interflect/formats/rad/materials.h"
#include "interflect/formats/rad/statements/statements.h"
#include "interflect/formats/rad/statements/xform.h"
#include "interflect/formats/reading/repeated_work.h"
#include "interflect/formats/reading/source_files.h"
#include "interflect/formats/shapes/curves.h"

namespace interflect::detail {

/// Reads each file once; array copies become instances.
class RadReader {
  public:
    RadReader(const std::filesystem::path& path, const ReadOptions& options);
    /// Continues the scene with another file that the user names. It sees the modifiers of earlier files.
    void read(const std::filesystem::path& path, std::string text);
    /// Returns the parts of the daylight of gensky or gendaylit that sources show.
    std::optional<Daylight> daylight() const;
    Model finish() { return std::move(model_); }

  private:
    struct Copy {
        Imath::M44d to_world;
        std::string prefix;  // prefix of surface names
    };
    struct OpenFile {
        const SourceFile& source;
        std::vector<Copy> copies;
        std::string modifier;  // as in RadXform
        bool is_inverted = false;
        const OpenFile* includer = nullptr;
        int depth = 0;
    };
    /// Luminaire of ies2rad whose surfaces are being read.
    struct OpenLight {
        RadMaterials::PatternedLight light;
        std::uint32_t modifier = none;
        RadEmitter emitter;
        std::vector<Copy> copies;
        std::string name;
    };
    using Reader = PolygonMesh (RadReader::*)(const std::vector<double>&, const Tessellation&) const;
    struct Surface {
        std::size_t numbers;  // required count of numbers, or 0 for any count
        Reader read;          // nullptr for a type that is ignored
    };
    static const std::unordered_map<std::string_view, Surface>& surfaces();

    static Location here(const RadStatements& statements, const OpenFile& file);
    void read_file(const OpenFile& file);
    void read_statement(RadStatements& statements, RadStatements::Kind kind, const OpenFile& file);
    void run(const std::string& command, const OpenFile& file, const Location& where);
    bool run_pipeline(std::span<const std::vector<std::string>> commands, const OpenFile& file, const Location& where);
    bool add_sky(const Daylight& daylight, const Imath::M44d& to_world, const Location& where);
    bool show_sky(const RadPrimitive& source, std::uint32_t modifier);
    void add_generated(const GeneratedSurfaces& generated, const OpenFile& file, const Location& where);
    const SourceFile& included_file(const std::string& name, const OpenFile& file);
    void refuse_recursion(const SourceFile& source, const OpenFile& file) const;
    std::vector<Copy> copies_of(const RadXform& xform, const std::vector<Copy>& outer);
    void add_surface(const RadPrimitive& primitive, const OpenFile& file, const Location& where);
    void add_mesh(const PolygonMesh& polygons, const RadPrimitive& primitive, std::uint32_t material,
                  const OpenFile& file, const Location& where);
    void add_light(const RadMaterials::PatternedLight& light, std::uint32_t modifier, const RadPrimitive& primitive,
                   PolygonMesh mesh, const OpenFile& file);
    void finish_light();
    const RadData& data_file(const RadMaterials::PatternedLight& light);
    std::uint32_t object(const std::string& name);
    void require_room(double faces, std::size_t copies);

    PolygonMesh polygon(const std::vector<double>& numbers, const Tessellation& tessellation) const;
    PolygonMesh sphere(const std::vector<double>& numbers, const Tessellation& tessellation) const;
    PolygonMesh bubble(const std::vector<double>& numbers, const Tessellation& tessellation) const;
    PolygonMesh cylinder(const std::vector<double>& numbers, const Tessellation& tessellation) const;
    PolygonMesh tube(const std::vector<double>& numbers, const Tessellation& tessellation) const;
    PolygonMesh cone(const std::vector<double>& numbers, const Tessellation& tessellation) const;
    PolygonMesh cup(const std::vector<double>& numbers, const Tessellation& tessellation) const;
    PolygonMesh ring(const std::vector<double>& numbers, const Tessellation& tessellation) const;

    ReadOptions options_;
    SourceFiles sources_;
    const SourceFile* main_ = nullptr;  // latest file that the user names
    std::map<std::pair<const SourceFile*, std::string>, const SourceFile*> included_;
    std::map<std::filesystem::path, RadData> data_;
    std::optional<OpenLight> open_light_;
    std::optional<Daylight> daylight_;
    bool shows_sky_ = false, shows_ground_ = false;
    Model model_;
    RadMaterials materials_;
    RepeatedWork repeated_;
    double patches_ = 0;  // number of patches requested so far
    std::unordered_map<std::string, std::uint32_t> object_index_;
};

}  // namespace interflect::detail
