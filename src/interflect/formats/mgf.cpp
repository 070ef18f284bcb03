#include "interflect/formats/mgf.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <unordered_map>
#include <utility>

#include "interflect/base/error.h"
#include "interflect/formats/line_reader.h"
#include "interflect/formats/mgf_colour.h"
#include "interflect/formats/mgf_contexts.h"
#include "interflect/formats/mgf_curves.h"
#include "interflect/formats/mgf_faults.h"
#include "interflect/formats/mgf_objects.h"
#include "interflect/formats/mgf_scene_builder.h"
#include "interflect/formats/mgf_sources.h"
#include "interflect/formats/mgf_transform.h"
#include "interflect/formats/mgf_work.h"
#include "interflect/formats/number.h"
#include "interflect/formats/text_file.h"

namespace interflect {

namespace {

namespace fs = std::filesystem;
using Imath::M44d;
using Imath::V3d;
using Words = std::span<const std::string_view>;

/// What is wrong with the line being read; where it is read, file and line are added.
using Fault = std::invalid_argument;

double number(std::string_view word) {
    if (const auto value = parse_number(word)) return *value;
    throw Fault(fmt::format("'{}' is not a finite number in single precision", word));
}

double non_negative(std::string_view word) {
    const double value = number(word);
    if (value < 0) throw Fault(fmt::format("'{}' must not be negative", word));
    return value;
}

V3d vector(Words words) { return {number(words[0]), number(words[1]), number(words[2])}; }

/// Whether the words hold three that differ from each other.
bool has_three_distinct(Words words) {
    const auto second = std::find_if(words.begin(), words.end(), [&](auto w) { return w != words.front(); });
    return std::any_of(second, words.end(), [&](auto w) { return w != words.front() && w != *second; });
}

/// A file in the middle of being read, with how much was open when it began: it can close no more than it opened.
struct OpenFile {
    const SourceFile& source;
    LineReader lines;
    std::size_t outer_transforms, outer_objects;
    const OpenFile* includer;
};

struct OpenTransform {
    TransformSequence sequence;
    M44d total;  // from the coordinates inside to the world
    Location opened;
    std::vector<int> copy;  // indices of the copy being read; empty where the transform is no array
    LineReader::Position body;
    double copies_together = 1;  // product of the sizes of all arrays around, this one included
    std::uint64_t first_patch = 0;
    bool repeating = false;
};

class Reader {
  public:
    /// @param origin  What the scene is made relative to.
    Reader(const fs::path& path, const ReadOptions& options, const V3d& origin);
    void read(const fs::path& path, std::string text);
    V3d suitable_origin() const { return scene_.suitable_origin(); }
    Scene finish();

  private:
    using Handler = void (Reader::*)(Words);
    /// What an entity defines, and so what bears its faults: where that is a colour or a material, only its use is
    /// refused.
    enum class Defines { colour, material, other };
    struct Entity {
        Handler handle;
        std::size_t fewest, most;  // arguments
        const char* usage;
        Defines defines = Defines::other;
    };
    static const std::unordered_map<std::string_view, Entity>& entities();

    // Files and lines.
    void read_file(const SourceFile& source, Words transform);
    void read_lines();
    void read_line(Words words);
    void apply(const Entity& entity, Words arguments);
    void defer(Defines defines, const std::string& message);
    void close_all();
    void refuse_recursion(const SourceFile& source) const;
    Location here() const { return {&file_->source.path, file_->lines.line()}; }
    void count_repeated(std::uint64_t words);

    // Entities, as in the table.
    void include(Words words);
    void skip_ies(Words words);
    void colour(Words words) { colours_.enter(words); }
    void colour_xy(Words words);
    void colour_spectrum(Words words);
    void colour_temperature(Words words);
    void colour_mix(Words words);
    void material(Words words);
    void sides(Words words);
    void diffuse_reflectance(Words words);
    void diffuse_transmittance(Words words) { changed_material().td = fraction(words[0]); }
    void specular_reflectance(Words words);
    void specular_transmittance(Words words);
    void exitance(Words words);
    void refraction(Words words);
    void vertex(Words words) { vertices_.enter(words); }
    void point(Words words) { vertices_.current().point = vector(words); }
    void normal(Words words) { vertices_.current().normal = vector(words).normalized(); }
    void face(Words words);
    void face_with_holes(Words words);
    void sphere(Words words);
    void torus(Words words);
    void cylinder(Words words);
    void cone(Words words);
    void ring(Words words);
    void prism(Words words);
    void transform(Words words);
    void object(Words words);

    // What they share.
    MgfMaterial& changed_material();
    double fraction(std::string_view word);
    V3d normal_of(std::string_view vertex);
    void add_loop(Words names);
    std::uint32_t usable_material();
    void add_face();
    void add_mesh(const Mesh& mesh);
    void open_transform(Words words, const LineReader::Position& body);
    bool close_transform();
    M44d total_transform() const { return transforms_.empty() ? M44d() : transforms_.back().total; }
    void place_copy(OpenTransform& transform);
    bool next_copy(OpenTransform& transform);

    ReadOptions options_;
    MgfSources sources_;
    OpenFile* file_ = nullptr;
    int include_depth_ = 0, repeating_arrays_ = 0;
    RepeatedWork repeated_;
    MgfFaults faults_;
    ContextTable<MgfColour> colours_;
    ContextTable<MgfMaterial> materials_;
    ContextTable<MgfVertex> vertices_;
    std::vector<OpenTransform> transforms_;
    std::vector<std::vector<std::uint32_t>> loops_;  // of the face being read
    std::vector<V3d> outline_;                       // its first loop, in the world
    // Messages for all of a kind, with the first one's particulars.
    std::string unknown_entity_, unused_fault_;
    MgfSceneBuilder scene_;
    MgfObjects objects_;
};

const std::unordered_map<std::string_view, Reader::Entity>& Reader::entities() {
    constexpr auto any = static_cast<std::size_t>(-1);
    static const std::unordered_map<std::string_view, Entity> table = {
        {"i", {&Reader::include, 1, any, "i file [transform]"}},
        {"ies", {&Reader::skip_ies, 0, any, "ies file [-m multiplier] [transform]"}},
        {"c", {&Reader::colour, 0, 3, "c [name [= [template]]]"}},
        {"cxy", {&Reader::colour_xy, 2, 2, "cxy x y", Defines::colour}},
        {"cspec", {&Reader::colour_spectrum, 4, any, "cspec shortest longest value1 value2 ...", Defines::colour}},
        {"cct", {&Reader::colour_temperature, 1, 1, "cct kelvin", Defines::colour}},
        {"cmix", {&Reader::colour_mix, 4, any, "cmix weight1 colour1 weight2 colour2 ...", Defines::colour}},
        {"m", {&Reader::material, 0, 3, "m [name [= [template]]]"}},
        {"sides", {&Reader::sides, 1, 1, "sides 1|2", Defines::material}},
        {"rd", {&Reader::diffuse_reflectance, 1, 1, "rd reflectance", Defines::material}},
        {"td", {&Reader::diffuse_transmittance, 1, 1, "td transmittance", Defines::material}},
        {"rs", {&Reader::specular_reflectance, 2, 2, "rs reflectance roughness", Defines::material}},
        {"ts", {&Reader::specular_transmittance, 2, 2, "ts transmittance roughness", Defines::material}},
        {"ed", {&Reader::exitance, 1, 1, "ed exitance", Defines::material}},
        {"ir", {&Reader::refraction, 2, 2, "ir real imaginary", Defines::material}},
        {"v", {&Reader::vertex, 0, 3, "v [name [= [template]]]"}},
        {"p", {&Reader::point, 3, 3, "p x y z"}},
        {"n", {&Reader::normal, 3, 3, "n x y z"}},
        {"f", {&Reader::face, 3, any, "f vertex1 vertex2 vertex3 ..."}},
        {"fh", {&Reader::face_with_holes, 3, any, "fh vertex1 vertex2 vertex3 ... - hole1 hole2 hole3 ..."}},
        {"sph", {&Reader::sphere, 2, 2, "sph centre radius"}},
        {"torus", {&Reader::torus, 3, 3, "torus centre inner-radius outer-radius"}},
        {"cyl", {&Reader::cylinder, 3, 3, "cyl end1 radius end2"}},
        {"cone", {&Reader::cone, 4, 4, "cone end1 radius1 end2 radius2"}},
        {"ring", {&Reader::ring, 3, 3, "ring centre inner-radius outer-radius"}},
        {"prism", {&Reader::prism, 4, any, "prism vertex1 vertex2 vertex3 ... length"}},
        {"xf", {&Reader::transform, 0, any, "xf [transform]"}},
        {"o", {&Reader::object, 0, 1, "o [name]"}},
    };
    return table;
}

Reader::Reader(const fs::path& path, const ReadOptions& options, const V3d& origin)
    : options_(options),
      repeated_(options.max_patches),
      colours_("colour", options.max_name_length),
      materials_("material", options.max_name_length),
      vertices_("vertex", options.max_name_length),
      scene_(path, options, origin),
      objects_(options_, scene_) {}

void Reader::read(const fs::path& path, std::string text) {
    scene_.add_file(path);
    read_file(sources_.add(path, std::move(text)).first, {});
}

Scene Reader::finish() {
    // A file without a face is refused anyway; what is wrong with it says more.
    if (scene_.patch_count() == 0) faults_.refuse_first();
    return scene_.finish();
}

// ---- Files and lines

/// @param transform  What an `i` gives with the file; it is in force until the end of the file, and read again for each
///                   copy where it is an array.
void Reader::read_file(const SourceFile& source, Words transform) {
    OpenFile file{source, LineReader(source.text), 0, objects_.depth(), file_};
    const LineReader::Position start = file.lines.position();
    if (!transform.empty()) open_transform(transform, start);
    file.outer_transforms = transforms_.size();
    file.outer_objects = objects_.depth();
    OpenFile* const includer = std::exchange(file_, &file);
    bool again = false;
    do {
        read_lines();
        close_all();
        again = !transform.empty() && close_transform();
    } while (again);
    file_ = includer;
}

void Reader::read_lines() {
    while (file_->lines.next()) try {
            if (file_->lines.length() > options_.max_line_length)
                throw Fault(fmt::format("a line of {} characters; at most {} are read", file_->lines.length(),
                                        options_.max_line_length));
            read_line(file_->lines.words());
        } catch (const Fault& fault) {
            throw InputError(file_->source.path, file_->lines.line(), fault.what());
        }
}

void Reader::read_line(Words words) {
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
        } catch (const Fault& fault) {
            defer(entity.defines, fault.what());
        }
    }
}

void Reader::apply(const Entity& entity, Words arguments) {
    if (arguments.size() < entity.fewest || arguments.size() > entity.most)
        throw Fault(fmt::format("expected '{}', found {} argument{}", entity.usage, arguments.size(),
                                arguments.size() == 1 ? "" : "s"));
    (this->*entity.handle)(arguments);
}

/// Leaves a fault to the colour or material that has it, with a warning in case that no face uses it.
void Reader::defer(Defines defines, const std::string& message) {
    if (unused_fault_.empty())
        unused_fault_ = "fault in a colour or material that no face uses is ignored, such as: " + message;
    scene_.warn("unused-fault", unused_fault_, here());
    const std::uint32_t fault = faults_.add(here(), message);
    if (defines == Defines::colour) {
        colours_.current() = {{}, fault};
        return;
    }
    MgfMaterial& material = changed_material();
    if (material.fault == none) material.fault = fault;
}

void Reader::count_repeated(std::uint64_t words) {
    if (include_depth_ > 0 || repeating_arrays_ > 0) repeated_.add(words, scene_.patch_count());
}

/// At the end of a file: what is still open was cut off, or forgotten.
void Reader::close_all() {
    for (; transforms_.size() > file_->outer_transforms; transforms_.pop_back()) {
        const OpenTransform& transform = transforms_.back();
        scene_.warn("unclosed-transform", "transform (xf) is not closed before the end of its file", transform.opened);
        repeating_arrays_ -= transform.repeating;
    }
    objects_.close_down_to(file_->outer_objects);
}

void Reader::refuse_recursion(const SourceFile& source) const {
    std::string chain = source.path.string();
    bool recursion = false;
    for (const OpenFile* open = file_; open && !recursion; open = open->includer) {
        recursion = &open->source == &source;
        chain.insert(0, open->source.path.string() + " -> ");
    }
    if (recursion) throw Fault("a file includes itself: " + chain);
}

void Reader::include(Words words) {
    if (include_depth_ >= options_.max_include_depth)
        throw Fault(fmt::format("includes are nested more than {} deep", options_.max_include_depth));
    const auto& [source, is_new] = sources_.find(words[0], file_->source);
    if (is_new) scene_.add_file(source.path);
    refuse_recursion(source);
    ++include_depth_;
    count_repeated(RepeatedWork::words_per_include);
    read_file(source, words.subspan(1));
    --include_depth_;
}

void Reader::skip_ies(Words) { scene_.warn("ies", "luminaire with measured photometry (ies) is skipped", here()); }

// ---- Colours

void Reader::colour_xy(Words words) {
    constexpr double least_y = 1e-6;
    const Chromaticity c{number(words[0]), number(words[1])};
    if (c.x < 0 || c.y < 0 || c.x + c.y > 1)
        throw Fault(fmt::format("({}, {}) is no chromaticity: x >= 0, y >= 0, x + y <= 1", c.x, c.y));
    if (c.y < least_y)
        scene_.warn("no-luminance", "chromaticity without luminance (y = 0) is taken as one with y = 1e-6", here());
    colours_.current() = {{c.x, std::max(c.y, least_y)}};
}

void Reader::colour_spectrum(Words words) {
    std::vector<double> values;
    for (const std::string_view word : words.subspan(2)) values.push_back(number(word));
    colours_.current() = {chromaticity_of_spectrum(number(words[0]), number(words[1]), values)};
}

void Reader::colour_temperature(Words words) { colours_.current() = {chromaticity_of_black_body(number(words[0]))}; }

void Reader::colour_mix(Words words) {
    if (words.size() % 2 != 0) throw Fault("cmix takes pairs of a weight and a colour");
    std::vector<MixedColour> parts;
    for (std::size_t i = 0; i < words.size(); i += 2) {
        const MgfColour& part = colours_.find(words[i + 1]);
        if (part.fault != none) {
            colours_.current() = part;
            return;
        }
        parts.push_back({number(words[i]), part.chromaticity});
    }
    colours_.current() = {mix(parts)};
}

// ---- Materials

MgfMaterial& Reader::changed_material() {
    MgfMaterial& material = materials_.current();
    material.scene_index = none;
    material.defined = here();
    return material;
}

double Reader::fraction(std::string_view word) {
    const double value = non_negative(word);
    if (value > 1) scene_.warn("reflectance-clamped", "reflectance or transmittance above 1 is taken as 1", here());
    return std::min(value, 1.0);
}

void Reader::material(Words words) {
    materials_.enter(words);
    if (words.size() != 1) changed_material();
}

void Reader::sides(Words words) {
    const int count = parse_integer(words[0]).value_or(0);
    if (count != 1 && count != 2) throw Fault(fmt::format("sides must be 1 or 2, not '{}'", words[0]));
    changed_material().two_sided = count == 2;
}

void Reader::diffuse_reflectance(Words words) {
    MgfMaterial& material = changed_material();
    material.rd = non_negative(words[0]);
    material.rd_colour = colours_.current();
}

void Reader::specular_reflectance(Words words) {
    changed_material().rs = fraction(words[0]);
    non_negative(words[1]);
}

void Reader::specular_transmittance(Words words) {
    changed_material().ts = fraction(words[0]);
    non_negative(words[1]);
}

void Reader::exitance(Words words) {
    MgfMaterial& material = changed_material();
    material.ed = non_negative(words[0]);
    material.ed_colour = colours_.current();
}

void Reader::refraction(Words words) {
    if (!(number(words[0]) > 0)) throw Fault("the real part of an index of refraction must be positive");
    number(words[1]);
}

// ---- Surfaces

V3d Reader::normal_of(std::string_view vertex) {
    const V3d n = vertices_.find(vertex).normal;
    if (n == V3d(0)) throw Fault(fmt::format("vertex '{}' needs a normal (n) here", vertex));
    return n;
}

/// Appends a loop of the face being read.
void Reader::add_loop(Words names) {
    if (names.size() > options_.max_face_vertices)
        throw Fault(
            fmt::format("a face of {} vertices; at most {} are read", names.size(), options_.max_face_vertices));
    if (!has_three_distinct(names)) throw Fault("a face, and each of its holes, needs three different vertices");
    const M44d to_world = total_transform();
    std::vector<std::uint32_t>& loop = loops_.emplace_back();
    outline_.clear();
    for (const std::string_view name : names) {
        outline_.push_back(vertices_.find(name).point * to_world);
        loop.push_back(scene_.vertex(outline_.back()));
    }
    if (loops_.size() == 1) scene_.place_face(outline_);
    // A mirror image turns the other way round.
    if (to_world.determinant() < 0) std::reverse(loop.begin(), loop.end());
}

/// Index of the current material, which a face uses: now its faults count.
std::uint32_t Reader::usable_material() {
    MgfMaterial& material = materials_.current();
    faults_.refuse_faults_of(material);
    return scene_.material(material, materials_.current_name());
}

void Reader::add_face() {
    const std::uint32_t material = usable_material();
    scene_.add_face(loops_, material, objects_.current(), materials_.current().two_sided, here());
}

void Reader::face(Words words) {
    if (!has_three_distinct(words)) {
        for (const std::string_view name : words) vertices_.find(name);
        scene_.leave_out("face with fewer than three different vertices is left out", here());
        return;
    }
    loops_.clear();
    add_loop(words);
    add_face();
}

void Reader::face_with_holes(Words words) {
    loops_.clear();
    std::size_t vertices = 0;
    for (auto begin = words.begin(); begin != words.end();) {
        const auto end = std::find(begin, words.end(), "-");
        add_loop({begin, end});
        vertices += loops_.back().size();
        begin = end == words.end() ? end : end + 1;
    }
    if (vertices > options_.max_face_vertices)
        throw Fault(fmt::format("a face of {} vertices; at most {} are read", vertices, options_.max_face_vertices));
    add_face();
}

void Reader::add_mesh(const Mesh& mesh) {
    const std::uint32_t material = usable_material();
    const M44d to_world = total_transform();
    const bool mirrored = to_world.determinant() < 0;
    count_repeated(mesh.faces.size());
    std::vector<V3d> points;
    std::vector<std::uint32_t> vertex;
    for (const V3d& p : mesh.points) {
        points.push_back(p * to_world);
        vertex.push_back(scene_.vertex(points.back()));
    }
    loops_.resize(1);
    for (const auto& face : mesh.faces) {
        loops_[0].clear();
        outline_.clear();
        for (const std::uint32_t i : face) {
            loops_[0].push_back(vertex[i]);
            outline_.push_back(points[i]);
        }
        scene_.place_face(outline_);
        if (mirrored) std::reverse(loops_[0].begin(), loops_[0].end());
        scene_.add_face(loops_, material, objects_.current(), materials_.current().two_sided, here());
    }
}

void Reader::sphere(Words words) {
    scene_.require_room(8.0 * options_.curve_divisions * options_.curve_divisions);
    add_mesh(make_sphere(vertices_.find(words[0]).point, number(words[1]), options_.curve_divisions));
}

void Reader::torus(Words words) {
    scene_.require_room(16.0 * options_.curve_divisions * options_.curve_divisions);
    add_mesh(make_torus(vertices_.find(words[0]).point, normal_of(words[0]), number(words[1]), number(words[2]),
                        options_.curve_divisions));
}

void Reader::cylinder(Words words) {
    const double radius = number(words[1]);
    add_mesh(make_cone(vertices_.find(words[0]).point, radius, vertices_.find(words[2]).point, radius,
                       options_.curve_divisions));
}

void Reader::cone(Words words) {
    add_mesh(make_cone(vertices_.find(words[0]).point, number(words[1]), vertices_.find(words[2]).point,
                       number(words[3]), options_.curve_divisions));
}

void Reader::ring(Words words) {
    add_mesh(make_ring(vertices_.find(words[0]).point, normal_of(words[0]), number(words[1]), number(words[2]),
                       options_.curve_divisions));
}

void Reader::prism(Words words) {
    const Words names = words.first(words.size() - 1);
    if (names.size() > options_.max_face_vertices)
        throw Fault(
            fmt::format("a prism of {} vertices; at most {} are read", names.size(), options_.max_face_vertices));
    std::vector<V3d> outline;
    for (const std::string_view name : names) outline.push_back(vertices_.find(name).point);
    add_mesh(make_prism(outline, number(words.back())));
}

// ---- Transforms and arrays

void Reader::transform(Words words) {
    if (!words.empty()) {
        open_transform(words, file_->lines.position());
        return;
    }
    if (transforms_.size() <= file_->outer_transforms)
        throw Fault("this closes a transform, but none was opened in this file");
    close_transform();
}

/// @param body  Where reading goes on for each further copy.
void Reader::open_transform(Words words, const LineReader::Position& body) {
    if (transforms_.size() >= static_cast<std::size_t>(options_.max_nesting))
        throw Fault(fmt::format("transforms are nested more than {} deep", options_.max_nesting));
    OpenTransform transform{TransformSequence(words),
                            M44d(),
                            here(),
                            {},
                            body,
                            transforms_.empty() ? 1 : transforms_.back().copies_together,
                            scene_.patch_count()};
    for (const int size : transform.sequence.array_sizes()) transform.copies_together *= size;
    if (transform.copies_together > static_cast<double>(options_.max_patches))
        throw Fault(fmt::format("an array of {:.0f} copies is beyond the limit of {} patches; --max-patches raises it",
                                transform.copies_together, options_.max_patches));
    transform.copy.assign(transform.sequence.array_sizes().size(), 0);
    transforms_.push_back(std::move(transform));
    place_copy(transforms_.back());
}

/// Ends the innermost transform, or goes back to the start of its body for the next copy. @return whether it did the
/// latter
bool Reader::close_transform() {
    OpenTransform& transform = transforms_.back();
    if (transform.sequence.is_array()) {
        objects_.close_copy();
        if (next_copy(transform)) {
            place_copy(transform);
            file_->lines.seek(transform.body);
            return true;
        }
        repeating_arrays_ -= transform.repeating;
    }
    transforms_.pop_back();
    return false;
}

/// Puts the copy in its place, and opens the object that is named after it.
void Reader::place_copy(OpenTransform& transform) {
    transform.total = transform.sequence.matrix(transform.copy);
    if (transforms_.size() > 1) transform.total = transform.total * transforms_[transforms_.size() - 2].total;
    for (int i = 0; i < 16; ++i)
        if (!std::isfinite(transform.total[i / 4][i % 4])) throw Fault("the transform is not finite");
    if (transform.sequence.is_array()) objects_.open(fmt::format("a{}", fmt::join(transform.copy, ".")), true, here());
}

/// Counts on to the next copy, the last array fastest. @return false after the last one
bool Reader::next_copy(OpenTransform& transform) {
    if (!transform.repeating) {
        // The first copy is done: now its content is known, and whether all copies will fit.
        double copies = 1;
        for (const int size : transform.sequence.array_sizes()) copies *= size;
        scene_.require_room(static_cast<double>(scene_.patch_count() - transform.first_patch) * (copies - 1));
        transform.repeating = true;
        ++repeating_arrays_;
    }
    count_repeated(RepeatedWork::words_per_copy);
    for (std::size_t i = transform.copy.size(); i-- > 0;) {
        if (++transform.copy[i] < transform.sequence.array_sizes()[i]) return true;
        transform.copy[i] = 0;
    }
    return false;
}

// ---- Objects

void Reader::object(Words words) {
    if (!words.empty())
        objects_.open(words[0], false, here());
    else if (!objects_.close_innermost(file_->outer_objects))
        scene_.warn("unbalanced-object", "this closes an object (o), but none is open here", here());
}

ReadOptions checked(const ReadOptions& options) {
    if (options.curve_divisions < 1 || options.curve_divisions > 1000)
        throw InputError("--curve-divisions", 0, fmt::format("must be 1 to 1000, not {}", options.curve_divisions));
    if (options.max_patches > 4'000'000'000)
        throw InputError("--max-patches", 0, fmt::format("must be at most 4 * 10^9, not {}", options.max_patches));
    return options;
}

/// Reads a scene about the world's origin, and where that is far from it, once more about an origin of its own.
Scene read_about_middle(const fs::path& path, const ReadOptions& options, const std::string& text) {
    V3d origin(0);
    {
        Reader reader(path, options, origin);
        reader.read(path, text);
        origin = reader.suitable_origin();
        if (origin == V3d(0)) return reader.finish();
    }
    Reader reader(path, options, origin);
    reader.read(path, text);
    return reader.finish();
}

}  // namespace

Scene read_mgf(const fs::path& path, const ReadOptions& options) {
    return read_about_middle(path, checked(options), read_text_file(path));
}

Scene read_mgf_text(std::string_view text, const fs::path& path, const ReadOptions& options) {
    require_text(text, path);
    return read_about_middle(path, checked(options), std::string(text));
}

}  // namespace interflect
