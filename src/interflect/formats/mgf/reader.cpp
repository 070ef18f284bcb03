#include "interflect/formats/mgf/reader.h"

#include <fmt/format.h>

#include <utility>

#include "interflect/core.h"
#include "interflect/formats/reading/file_to_world.h"

namespace interflect::detail {

using Imath::V3d;

const std::unordered_map<std::string_view, MgfReader::Entity>& MgfReader::entities() {
    constexpr auto any = static_cast<std::size_t>(-1);
    static const std::unordered_map<std::string_view, Entity> table = {
        {"i", {&MgfReader::include, 1, any, "i file [transform]"}},
        {"ies", {&MgfReader::luminaire, 1, any, "ies file [-m multiplier] [-c colour] [-top] [transform]"}},
        {"c", {&MgfReader::colour, 0, 3, "c [name [= [template]]]"}},
        {"cxy", {&MgfReader::colour_xy, 2, 2, "cxy x y", Defines::colour}},
        {"cspec", {&MgfReader::colour_spectrum, 4, any, "cspec shortest longest value1 value2 ...", Defines::colour}},
        {"cct", {&MgfReader::colour_temperature, 1, 1, "cct kelvin", Defines::colour}},
        {"cmix", {&MgfReader::colour_mix, 4, any, "cmix weight1 colour1 weight2 colour2 ...", Defines::colour}},
        {"m", {&MgfReader::material, 0, 3, "m [name [= [template]]]"}},
        {"sides", {&MgfReader::sides, 1, 1, "sides 1|2", Defines::material}},
        {"rd", {&MgfReader::diffuse_reflectance, 1, 1, "rd reflectance", Defines::material}},
        {"td", {&MgfReader::diffuse_transmittance, 1, 1, "td transmittance", Defines::material}},
        {"rs", {&MgfReader::specular_reflectance, 2, 2, "rs reflectance roughness", Defines::material}},
        {"ts", {&MgfReader::specular_transmittance, 2, 2, "ts transmittance roughness", Defines::material}},
        {"ed", {&MgfReader::exitance, 1, 1, "ed exitance", Defines::material}},
        {"ir", {&MgfReader::refraction, 2, 2, "ir real imaginary", Defines::material}},
        {"texture", {&MgfReader::texture, 2, 2, "texture rd|ed|ts image", Defines::material}},  // extension
        {"v", {&MgfReader::vertex, 0, 3, "v [name [= [template]]]"}},
        {"p", {&MgfReader::point, 3, 3, "p x y z"}},
        {"n", {&MgfReader::normal, 3, 3, "n x y z"}},
        {"uv", {&MgfReader::texture_coordinate, 2, 2, "uv u v"}},  // extension
        {"f", {&MgfReader::face, 3, any, "f vertex1 vertex2 vertex3 ..."}},
        {"fh", {&MgfReader::face_with_holes, 3, any, "fh vertex1 vertex2 vertex3 ... - hole1 hole2 hole3 ..."}},
        {"sph", {&MgfReader::sphere, 2, 2, "sph centre radius"}},
        {"torus", {&MgfReader::torus, 3, 3, "torus centre inner-radius outer-radius"}},
        {"cyl", {&MgfReader::cylinder, 3, 3, "cyl end1 radius end2"}},
        {"cone", {&MgfReader::cone, 4, 4, "cone end1 radius1 end2 radius2"}},
        {"ring", {&MgfReader::ring, 3, 3, "ring centre inner-radius outer-radius"}},
        {"prism", {&MgfReader::prism, 4, any, "prism vertex1 vertex2 vertex3 ... length"}},
        {"light", {&MgfReader::light, 2, 11, "light point|spot|directional|sky|environment ..."}},
        {"xf", {&MgfReader::transform, 0, any, "xf [transform]"}},
        {"o", {&MgfReader::object, 0, 1, "o [name]"}},
    };
    return table;
}

MgfReader::MgfReader(const std::filesystem::path& path, const ReadOptions& options, const V3d& origin)
    : options_(options),
      file_to_world_(file_to_world(options)),
      repeated_(options.max_patches),
      colours_("colour", options.max_name_length),
      materials_("material", options.max_name_length),
      vertices_("vertex", options.max_name_length),
      scene_(path, options, origin),
      objects_(options_, scene_) {}

void MgfReader::read(const std::filesystem::path& path, std::string text) {
    scene_.add_file(path);
    read_file(sources_.add(path, std::move(text)).first, {});
}

Scene MgfReader::finish() {
    // Deferred errors are more specific than the error of a scene without faces.
    if (scene_.patch_count() == 0) faults_.refuse_first();
    return scene_.finish();
}

void MgfReader::read_file(const SourceFile& source, MgfWords transform) {
    OpenMgfFile file{source, LineReader(source.text), 0, objects_.depth(), file_};
    const LineReader::Position start = file.lines.position();
    if (!transform.empty()) open_transform(transform, start);
    file.outer_transforms = transforms_.size();
    file.outer_objects = objects_.depth();
    OpenMgfFile* const includer = std::exchange(file_, &file);
    bool again = false;
    do {
        read_lines();
        close_all();
        again = !transform.empty() && close_transform();
    } while (again);
    file_ = includer;
}

void MgfReader::read_lines() {
    while (file_->lines.next()) try {
            if (file_->lines.length() > options_.max_line_length)
                throw MgfFault(fmt::format("a line of {} characters; at most {} are read", file_->lines.length(),
                                           options_.max_line_length));
            read_line(file_->lines.words());
        } catch (const MgfFault& fault) {
            throw here().error(fault);
        }
}

void MgfReader::read_line(MgfWords words) {
    count_repeated(words.size());
    if (words[0][0] == '#') return;
    const auto entry = entities().find(words[0]);
    if (entry == entities().end()) {
        if (unknown_entity_.empty())
            unknown_entity_ =
                fmt::format("unknown entity is skipped, such as '{}'", words[0].substr(0, options_.max_name_length));
        scene_.warn("unsupported-entity", unknown_entity_, here());
        return;
    }
    const Entity& entity = entry->second;
    if (entity.defines == Defines::other) {
        apply(entity, words.subspan(1));
    } else {
        try {
            apply(entity, words.subspan(1));
        } catch (const MgfFault& fault) {
            defer(entity.defines, fault.what());
        }
    }
}

void MgfReader::apply(const Entity& entity, MgfWords arguments) {
    if (arguments.size() < entity.fewest || arguments.size() > entity.most)
        throw MgfFault(fmt::format("expected '{}', found {} argument{}", entity.usage, arguments.size(),
                                   arguments.size() == 1 ? "" : "s"));
    (this->*entity.handle)(arguments);
}

void MgfReader::defer(Defines defines, const std::string& message) {
    if (unused_fault_.empty())
        unused_fault_ = "fault in a colour or material that no face uses is ignored, such as: " + here().shown(message);
    scene_.warn("unused-fault", unused_fault_, here());
    const std::uint32_t fault = faults_.add(here(), message);
    if (defines == Defines::colour) {
        colours_.current() = {{}, fault};
        return;
    }
    MgfMaterial& material = changed_material();
    if (material.fault == none) material.fault = fault;
}

void MgfReader::count_repeated(std::uint64_t words) {
    if (include_depth_ > 0 || repeating_arrays_ > 0) repeated_.add(words, scene_.patch_count());
}

void MgfReader::close_all() {
    for (; transforms_.size() > file_->outer_transforms; transforms_.pop_back()) {
        const OpenMgfTransform& transform = transforms_.back();
        scene_.warn("unclosed-transform", "transform (xf) is not closed before the end of its file", transform.opened);
        repeating_arrays_ -= transform.repeating;
    }
    objects_.close_down_to(file_->outer_objects);
}

void MgfReader::refuse_recursion(const SourceFile& source) const {
    std::string chain = source.path.string();
    bool recursion = false;
    for (const OpenMgfFile* open = file_; open && !recursion; open = open->includer) {
        recursion = &open->source == &source;
        chain.insert(0, open->source.path.string() + " -> ");
    }
    if (recursion) throw MgfFault("a file includes itself: " + chain);
}

void MgfReader::include(MgfWords words) {
    if (include_depth_ >= options_.max_include_depth)
        throw MgfFault(fmt::format("includes are nested more than {} deep", options_.max_include_depth));
    const auto& [source, is_new] = sources_.find(words[0], file_->source);
    if (is_new) scene_.add_file(source.path);
    refuse_recursion(source);
    ++include_depth_;
    count_repeated(RepeatedWork::words_per_include);
    read_file(source, words.subspan(1));
    --include_depth_;
}

void MgfReader::object(MgfWords words) {
    if (!words.empty())
        objects_.open(words[0], false, here());
    else if (!objects_.close_innermost(file_->outer_objects))
        scene_.warn("unbalanced-object", "this closes an object (o), but none is open here", here());
}

}  // namespace interflect::detail
