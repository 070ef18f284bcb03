#pragma once

#include <ImathMatrix.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "interflect/formats/mgf/context/arguments.h"
#include "interflect/formats/mgf/context/contexts.h"
#include "interflect/formats/mgf/context/faults.h"
#include "interflect/formats/mgf/context/objects.h"
#include "interflect/formats/mgf/context/scene_builder.h"
#include "interflect/formats/reading/repeated_work.h"
#include "interflect/formats/reading/source_files.h"
#include "interflect/formats/shapes/curves.h"
#include "interflect/formats/shapes/transform_sequence.h"
#include "interflect/formats/text/line_reader.h"
#include "interflect/load.h"

namespace interflect::detail {

/// File that is being read. It cannot close transforms or objects of the files that include it.
struct OpenMgfFile {
    const SourceFile& source;
    LineReader lines;
    std::size_t outer_transforms, outer_objects;  // numbers of open transforms and objects of includers
    const OpenMgfFile* includer;
};

/// Transform of an open `xf` or include, with the current array copy.
struct OpenMgfTransform {
    TransformSequence sequence;
    Imath::M44d total;              // matrix to the world
    Location opened;                // location of the `xf` or include
    std::vector<int> copy;          // number of the copy in each array; empty without arrays
    LineReader::Position body;      // start of each copy
    double copies_together = 1;     // product of the copies of this and outer arrays
    std::uint64_t first_patch = 0;  // number of patches before the first copy
    bool repeating = false;         // whether copies after the first one are being read
};

/// Reads MGF. The handlers of entities are in *_entities.cpp.
class MgfReader {
  public:
    MgfReader(const std::filesystem::path& path, const ReadOptions& options, const Imath::V3d& origin);
    void read(const std::filesystem::path& path, std::string text);
    Imath::V3d suitable_origin() const { return scene_.suitable_origin(); }
    Scene finish();

  private:
    using Handler = void (MgfReader::*)(MgfWords);
    /// Owner of an entity's deferred errors.
    enum class Defines { colour, material, other };
    struct Entity {
        Handler handle;
        std::size_t fewest, most;  // limits of the number of arguments
        const char* usage;
        Defines defines = Defines::other;
    };
    static const std::unordered_map<std::string_view, Entity>& entities();

    void read_file(const SourceFile& source, MgfWords transform);
    void read_lines();
    void read_line(MgfWords words);
    void apply(const Entity& entity, MgfWords arguments);
    void defer(Defines defines, const std::string& message);
    void close_all();
    void refuse_recursion(const SourceFile& source) const;
    Location here() const { return {&file_->source.path, file_->lines.line(), {}, file_->includer != nullptr}; }
    void count_repeated(std::uint64_t words);

    void include(MgfWords words);
    void colour(MgfWords words) { colours_.enter(words); }
    void colour_xy(MgfWords words);
    void colour_spectrum(MgfWords words);
    void colour_temperature(MgfWords words);
    void colour_mix(MgfWords words);
    void material(MgfWords words);
    void sides(MgfWords words);
    void diffuse_reflectance(MgfWords words);
    void diffuse_transmittance(MgfWords words) { changed_material().td = fraction(words[0]); }
    void specular_reflectance(MgfWords words);
    void specular_transmittance(MgfWords words);
    void exitance(MgfWords words);
    void refraction(MgfWords words);
    void texture(MgfWords words);
    void vertex(MgfWords words) { vertices_.enter(words); }
    void point(MgfWords words) { changed_vertex().point = vector_argument(words); }
    void normal(MgfWords words) { changed_vertex().normal = vector_argument(words).normalized(); }
    void texture_coordinate(MgfWords words);
    void face(MgfWords words);
    void face_with_holes(MgfWords words);
    void sphere(MgfWords words);
    void torus(MgfWords words);
    void cylinder(MgfWords words);
    void cone(MgfWords words);
    void ring(MgfWords words);
    void prism(MgfWords words);
    void transform(MgfWords words);
    void object(MgfWords words);
    void light(MgfWords words);
    void luminaire(MgfWords words);
    void sky(MgfWords words);
    void environment(MgfWords words);

    MgfMaterial& changed_material();
    MgfVertex& changed_vertex() {
        vertices_.current().scene_index = none;
        return vertices_.current();
    }
    std::uint32_t scene_vertex(MgfVertex& vertex, const Imath::V3d& world, const Imath::M44d& to_world);
    double fraction(std::string_view word);
    Imath::V3d normal_of(std::string_view vertex);
    V3f direction_of(std::string_view vertex);
    V3f turned(const Imath::V3d& direction) const;
    void add_sky(SkyDome sky, MgfWords ground);
    void perez_sky(MgfWords words);
    std::shared_ptr<const PhotometricWeb> photometric_web(std::string_view name);
    std::shared_ptr<const Texture> environment_image(std::string_view name);
    void add_luminaire(MeasuredLight light, bool by_top, const Imath::M44d& transform, const std::string& name);
    void read_loop(MgfWords names, std::vector<std::uint32_t>& loop);
    std::uint32_t usable_material();
    void add_face();
    Tessellation tessellation();
    void add_mesh(const PolygonMesh& mesh);
    void open_transform(MgfWords words, const LineReader::Position& body);
    bool close_transform();
    Imath::M44d total_transform() const { return transforms_.empty() ? file_to_world_ : transforms_.back().total; }
    void place_copy(OpenMgfTransform& transform);
    bool next_copy(OpenMgfTransform& transform);

    ReadOptions options_;
    Imath::M44d file_to_world_;
    SourceFiles sources_;
    OpenMgfFile* file_ = nullptr;
    int include_depth_ = 0, repeating_arrays_ = 0;
    RepeatedWork repeated_;
    MgfFaults faults_;
    ContextTable<MgfColour> colours_;
    ContextTable<MgfMaterial> materials_;
    ContextTable<MgfVertex> vertices_;
    std::vector<OpenMgfTransform> transforms_;
    std::vector<std::vector<std::uint32_t>> loops_;
    std::vector<Imath::V3d> outline_;            // latest loop, in world coordinates
    std::string unknown_entity_, unused_fault_;  // texts of warnings
    std::unordered_map<std::string, std::shared_ptr<const PhotometricWeb>> webs_;
    std::unordered_map<std::string, std::shared_ptr<const Texture>> environments_;
    MgfSceneBuilder scene_;
    MgfObjects objects_;
};

}  // namespace interflect::detail
