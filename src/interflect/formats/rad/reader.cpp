#include "interflect/formats/rad/reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "interflect/core.h"
#include "interflect/formats/build/scene_faces.h"
#include "interflect/formats/rad/sky.h"
#include "interflect/formats/reading/file_to_world.h"
#include "interflect/formats/reading/read_fault.h"
#include "interflect/formats/text/text_file.h"
#include "interflect/scene/core/web_angles.h"

namespace interflect::detail {

namespace fs = std::filesystem;
using Imath::M44d;
using Imath::V3d;

namespace {

/// Limit of copies per file; a copy takes about 170 bytes.
constexpr std::size_t max_copies = 1 << 20;

V3d point(const std::vector<double>& numbers, std::size_t first) {
    return {numbers[first], numbers[first + 1], numbers[first + 2]};
}

bool is_finite(const M44d& m) {
    return std::all_of(m.getValue(), m.getValue() + 16, [](double x) { return std::isfinite(x); });
}

}  // namespace

Location RadReader::here(const RadStatements& statements, const OpenFile& file) {
    return {&file.source.path, statements.line(), {}, file.depth > 0};
}

const std::unordered_map<std::string_view, RadReader::Surface>& RadReader::surfaces() {
    static const std::unordered_map<std::string_view, Surface> table = {
        {"polygon", {0, &RadReader::polygon}},
        {"sphere", {4, &RadReader::sphere}},
        {"bubble", {4, &RadReader::bubble}},
        {"cylinder", {7, &RadReader::cylinder}},
        {"tube", {7, &RadReader::tube}},
        {"cone", {8, &RadReader::cone}},
        {"cup", {8, &RadReader::cup}},
        {"ring", {8, &RadReader::ring}},
        {"source", {0, nullptr}},
        {"instance", {0, nullptr}},
        {"mesh", {0, nullptr}},
    };
    return table;
}

RadReader::RadReader(const fs::path& path, const ReadOptions& options)
    : options_(options), materials_(model_), repeated_(options.max_patches) {
    model_.file = path;
    object_index_.emplace("", 0);
}

void RadReader::read(const fs::path& path, std::string text) {
    const auto& [source, is_new] = sources_.add(path, std::move(text));
    if (is_new) model_.files.push_back(path.string());
    main_ = &source;
    included_.clear();
    read_file({source, {{file_to_world(options_), ""}}, ""});
}

void RadReader::read_file(const OpenFile& file) {
    RadStatements statements(file.source.text);
    for (auto kind = statements.next(); kind != RadStatements::Kind::end; kind = statements.next()) {
        const Location where = here(statements, file);
        try {
            read_statement(statements, kind, file);
        } catch (const std::invalid_argument& fault) {
            throw where.error(fault);
        }
    }
    finish_light();
}

void RadReader::read_statement(RadStatements& statements, RadStatements::Kind kind, const OpenFile& file) {
    const Location where = here(statements, file);
    if (kind == RadStatements::Kind::command) return run(statements.command(), file, where);
    const RadPrimitive primitive = statements.primitive();
    for (const std::string_view name : {primitive.modifier, primitive.type, primitive.name})
        if (name.size() > options_.max_name_length)
            throw std::invalid_argument(
                fmt::format("a name of {} characters; at most {} are read", name.size(), options_.max_name_length));
    if (file.depth > 0)
        repeated_.add(5 + primitive.numbers.size() + primitive.strings.size(), static_cast<std::uint64_t>(patches_));
    if (RadMaterials::is_modifier(primitive.type)) return materials_.define(primitive, where);
    if (!surfaces().contains(primitive.type))
        throw std::invalid_argument(fmt::format("there is no type '{}'", primitive.type));
    add_surface(primitive, file, where);
}

void RadReader::run(const std::string& command, const OpenFile& file, const Location& where) {
    if (const auto pipeline = parse_pipeline(command); pipeline && run_pipeline(*pipeline, file, where)) return;
    materials_.allow_missing();
    const std::string program = command.substr(0, std::min(command.find_first_of(" \t"), options_.max_name_length));
    model_.warnings.add("unsupported-command",
                        where.shown(fmt::format(
                            "the output of the command '{}' is left out: no program is run, and only xform of files, "
                            "genbox, genprism, gensky and gendaylit -W are built in; Radiance's 'xform -e' writes "
                            "the output of others",
                            program)),
                        where.text());
}

/// Reads files with xform, or generates surfaces, and transforms the result. Returns false if that is not possible.
bool RadReader::run_pipeline(std::span<const std::vector<std::string>> commands, const OpenFile& file,
                             const Location& where) {
    // Parse the commands
    const std::optional<GeneratedSurfaces> generated = generate_surfaces(commands.front());
    const std::optional<Daylight> daylight = parse_sky_command(commands.front());
    const bool reads_files = !generated && !daylight;
    std::vector<RadXform> xforms;
    for (const std::vector<std::string>& words : commands.subspan(reads_files ? 0 : 1)) {
        const std::optional<RadXform> xform = parse_xform(words);
        if (!xform || xform->files.empty() == (reads_files && xforms.empty())) return false;
        xforms.push_back(*xform);
    }
    // Combine the transforms. The last command is the outermost.
    OpenFile inner = file;
    for (auto xform = xforms.rbegin(); xform != xforms.rend(); ++xform) {
        inner.copies = copies_of(*xform, inner.copies);
        if (inner.modifier.empty()) inner.modifier = xform->modifier;
        inner.is_inverted = inner.is_inverted != xform->inverts;
    }
    if (daylight) return add_sky(*daylight, inner.copies.front().to_world, where);
    if (generated) {
        add_generated(*generated, inner, where);
        return true;
    }
    if (file.depth >= options_.max_include_depth)
        throw std::invalid_argument(fmt::format("files are nested more than {} deep", options_.max_include_depth));
    for (const std::string& name : xforms.front().files)
        read_file({included_file(name, file), inner.copies, inner.modifier, inner.is_inverted, &file, file.depth + 1});
    return true;
}

/// Defines the modifiers `skyfunc` and `solar` of gensky. Returns false unless z is up.
bool RadReader::add_sky(const Daylight& daylight, const M44d& to_world, const Location& where) {
    const auto direction = [&](const V3d& v) {
        V3d result;
        to_world.multDirMatrix(v, result);
        return result.normalized();
    };
    constexpr double tolerance = 1e-6;
    if ((direction({0, 0, 1}) - V3d(0, 0, 1)).length() > tolerance || to_world.determinant() < 0) return false;
    daylight_ = daylight;
    const V3d east = direction({1, 0, 0});
    if (daylight_->sun) daylight_->sun->azimuth -= degrees(std::atan2(east.y, east.x));
    try {  // validates the daylight
        Scene empty;
        add_daylight(empty, *daylight_);
    } catch (const InputError& fault) {
        throw where.error(fault.what());
    }
    if (daylight_->cie_sky && daylight_->cie_sky->type == cie_sky_type("intermediate"))
        model_.warnings.add("approximate-sky", "the intermediate sky of gensky is read as CIE type 7", where.text());
    materials_.define({"void", "brightfunc", "skyfunc", {}, {"skybr", "skybright.cal"}, {}}, where);
    materials_.define({"void", "light", "solar", {}, {}, {1, 1, 1}}, where);
    return true;
}

/// Returns whether the source shows the sky or the ground of gensky.
bool RadReader::show_sky(const RadPrimitive& source, std::uint32_t modifier) {
    if (!daylight_ || !materials_.is_modified_by(modifier, "skyfunc")) return false;
    if (source.numbers.size() != 4) throw std::invalid_argument("a source needs a direction and an angle");
    if (source.numbers[3] < half_turn) return false;
    const bool is_all = source.numbers[3] >= full_turn;
    shows_sky_ |= is_all || source.numbers[2] > 0;
    shows_ground_ |= is_all || source.numbers[2] < 0;
    return true;
}

std::optional<Daylight> RadReader::daylight() const {
    std::optional<Daylight> result = daylight_;
    if (!result) return result;
    if (!shows_ground_) result->ground_reflectance = 0;
    if (!shows_sky_) {
        // The illuminance of a sun by Perez depends on the sky.
        if (result->perez_sky && !result->sun->illuminance)
            result->sun->illuminance = perez_daylight(result->perez_sky->direct_normal,
                                                      result->perez_sky->diffuse_horizontal, result->sun->altitude)
                                           .sun_illuminance;
        result->perez_sky.reset();
        result->cie_sky.reset();
    }
    return result;
}

void RadReader::add_generated(const GeneratedSurfaces& generated, const OpenFile& file, const Location& where) {
    if (!generated.omission.empty())
        model_.warnings.add("unsupported-command", generated.omission + " is left out", where.text());
    for (const GeneratedSurface& surface : generated.surfaces) {
        if (file.depth > 0) repeated_.add(surface.numbers.size(), static_cast<std::uint64_t>(patches_));
        add_surface({generated.modifier, surface.type, surface.name, {}, {}, surface.numbers}, file, where);
    }
}

/// Searches the scene's folder, where Radiance usually runs, then the includer's.
const SourceFile& RadReader::included_file(const std::string& name, const OpenFile& file) {
    const SourceFile*& known = included_[{&file.source, name}];
    if (!known) {
        std::error_code ignored;
        const SourceFile& beside = fs::exists(main_->path.parent_path() / name, ignored) ? *main_ : file.source;
        require_within(beside.path.parent_path() / name, main_->path.parent_path(), options_,
                       fmt::format("'{}'", name));
        const auto& [source, is_new] = sources_.find(name, beside);
        if (is_new) model_.files.push_back(source.path.string());
        known = &source;
    }
    refuse_recursion(*known, file);
    return *known;
}

void RadReader::refuse_recursion(const SourceFile& source, const OpenFile& file) const {
    const OpenFile* outer = &file;
    while (outer && &outer->source != &source) outer = outer->includer;
    if (!outer) return;
    std::string chain = source.path.string();
    for (const OpenFile* open = &file; open != outer; open = open->includer)
        chain.insert(0, open->source.path.string() + " -> ");
    throw std::invalid_argument("a file includes itself: " + source.path.string() + " -> " + chain);
}

std::vector<RadReader::Copy> RadReader::copies_of(const RadXform& xform, const std::vector<Copy>& outer) {
    double count = static_cast<double>(outer.size());
    for (const int size : xform.transform.array_sizes()) count *= size;
    if (count > static_cast<double>(std::min<std::uint64_t>(max_copies, options_.max_patches)))
        throw ReadFault(
            fmt::format("an array of {:.0f} copies, of which at most {} are read and each counts as a patch "
                        "at least (max_patches)",
                        count, max_copies),
            "max_patches");
    repeated_.add(RepeatedWork::words_per_include + RepeatedWork::words_per_copy * static_cast<std::uint64_t>(count),
                  static_cast<std::uint64_t>(patches_));
    std::vector<Copy> result;
    std::vector<int> copy(xform.transform.array_sizes().size(), 0);
    do {
        const M44d inner = xform.transform.matrix(copy);
        const std::string prefix = xform.prefix(copy);
        for (const Copy& around : outer) {
            result.push_back({inner * around.to_world, around.prefix});
            if (!is_finite(result.back().to_world)) throw std::invalid_argument("the transform is not finite");
            if (!prefix.empty()) result.back().prefix += prefix + '.';
            if (result.back().prefix.size() > 4 * options_.max_name_length)
                throw std::invalid_argument("the names that -n gives are too long");
        }
    } while (next_index(copy, xform.transform.array_sizes()));
    return result;
}

void RadReader::add_surface(const RadPrimitive& primitive, const OpenFile& file, const Location& where) {
    const Surface& surface = surfaces().at(primitive.type);
    const std::string_view modifier = file.modifier.empty() ? primitive.modifier : std::string_view(file.modifier);
    const std::uint32_t index = materials_.find(modifier, where);
    if (primitive.type == "source" && show_sky(primitive, index)) return;
    if (!surface.read) {
        model_.warnings.add("unsupported-entity", fmt::format("surface of type {} is left out", primitive.type),
                            where.text());
        return;
    }
    if (surface.numbers > 0 && primitive.numbers.size() != surface.numbers)
        throw std::invalid_argument(
            fmt::format("a {} needs {} numbers, not {}", primitive.type, surface.numbers, primitive.numbers.size()));
    if (const auto light = materials_.patterned_light(index)) {
        // The web needs the exact projected area.
        constexpr Tessellation fine{.divisions = 32, .keeps_area = true};
        return add_light(*light, index, primitive, (this->*surface.read)(primitive.numbers, fine), file);
    }
    const std::uint32_t material = materials_.material(index);
    if (material == none) {
        model_.warnings.add("void-surface", "surface without a material is invisible, and left out", where.text());
        return;
    }
    // Check spheres, which have the most faces, before their tessellation
    const double d = options_.curve_divisions;
    if (primitive.type == "sphere" || primitive.type == "bubble") require_room(8 * d * d, file.copies.size());
    const Tessellation tessellation{.divisions = options_.curve_divisions,
                                    .keeps_area = largest_channel(model_.materials[material].exitance) > 0};
    add_mesh((this->*surface.read)(primitive.numbers, tessellation), primitive, material, file, where);
}

void RadReader::add_mesh(const PolygonMesh& polygons, const RadPrimitive& primitive, std::uint32_t material,
                         const OpenFile& file, const Location& where) {
    require_room(static_cast<double>(polygons.faces.size()), file.copies.size());
    patches_ += 2.0 * static_cast<double>(polygons.faces.size() * file.copies.size());
    Mesh mesh;
    mesh.name = fmt::format("{} '{}', {}", primitive.type, primitive.name, where.text());
    mesh.positions = polygons.points;
    mesh.material = material;
    mesh.back_emits = false;
    for (const auto& face : polygons.faces) {
        mesh.face_sizes.push_back(static_cast<std::uint32_t>(face.size()));
        mesh.indices.insert(mesh.indices.end(), face.begin(), face.end());
        if (file.is_inverted)
            std::reverse(mesh.indices.end() - static_cast<std::ptrdiff_t>(face.size()), mesh.indices.end());
    }
    const auto index = static_cast<std::uint32_t>(model_.meshes.size());
    model_.meshes.push_back(std::move(mesh));
    for (const Copy& copy : file.copies)
        model_.instances.push_back({index, copy.to_world, object(copy.prefix + std::string(primitive.name))});
}

/// Adds an emitting surface of ies2rad. Joins the surfaces of a box or cylinder whose size the pattern contains.
void RadReader::add_light(const RadMaterials::PatternedLight& light, std::uint32_t modifier,
                          const RadPrimitive& primitive, PolygonMesh mesh, const OpenFile& file) {
    const M44d to_luminaire = light.pattern.to_file.inverse();
    for (V3d& point : mesh.points) point = point * to_luminaire;
    if (file.is_inverted)
        for (auto& face : mesh.faces) std::reverse(face.begin(), face.end());
    const std::vector<double>& sizes = light.pattern.arguments;
    const auto belongs_to_open_light = [&] {
        if (!open_light_ || open_light_->modifier != modifier || sizes.size() < 3) return false;
        Imath::Box3d box = open_light_->emitter.bounds();
        for (const V3d& point : mesh.points) box.extendBy(point);
        constexpr double tolerance = 1.01;  // ies2rad rounds
        const V3d size = box.size() * options_.unit,
                  most(sizes[1], sizes.size() > 3 ? sizes[2] : sizes[1], sizes.back());
        return size.x <= most.x * tolerance && size.y <= most.y * tolerance && size.z <= most.z * tolerance;
    };
    if (!belongs_to_open_light()) {
        finish_light();
        open_light_ = OpenLight{light, modifier, {}, file.copies, std::string(primitive.name)};
    }
    using Shape = LuminousOpening::Shape;
    RadEmitter& emitter = open_light_->emitter;
    if (primitive.type == "sphere") emitter.shape = Shape::ellipsoid;
    if (primitive.type == "ring" || primitive.type == "cylinder") emitter.shape = Shape::cylinder;
    emitter.surfaces.push_back(std::move(mesh));
}

/// Adds the open luminaire once for each copy.
void RadReader::finish_light() {
    if (!open_light_) return;
    const OpenLight open = *std::exchange(open_light_, std::nullopt);
    PhotometricWeb web;
    try {
        web = make_light_web(open.light.pattern, data_file(open.light), open.emitter);
    } catch (const std::invalid_argument& fault) {
        throw open.light.where.error(
            fmt::format("the luminaire's data file '{}': {}", open.light.pattern.data_file, fault.what()),
            setting_of(fault));
    }
    if (!(web.flux() > 0)) return;
    web.name = open.light.pattern.data_file;
    const V3f size = web.opening.size;
    std::shared_ptr<const PhotometricWeb> shared;
    double scale = 0;
    for (const Copy& copy : open.copies) {
        const M44d to_world = open.light.pattern.to_file * copy.to_world;
        const auto direction = [&](const V3d& v) {
            V3d result;
            to_world.multDirMatrix(v, result);
            return V3f(result.normalized());
        };
        if (const double next = std::cbrt(std::abs(to_world.determinant())); !shared || next != scale) {
            scale = next;
            web.opening.size = size * static_cast<float>(scale);
            shared = std::make_shared<const PhotometricWeb>(web);
        }
        MeasuredLight light;
        light.web = shared;
        light.direction = direction({0, 0, -1});
        light.c0 = direction({1, 0, 0});
        light.mirrored = to_world.determinant() < 0;
        light.factor = open.light.radiance * static_cast<float>(scale * scale);
        Luminaire luminaire{copy.prefix + open.name, object(copy.prefix + open.name), light};
        if (const std::string fault = luminaire_fault(luminaire); !fault.empty())
            throw open.light.where.error(fmt::format("luminaire '{}' {}", luminaire.name, fault));
        model_.lights.push_back({std::move(luminaire), open.emitter.bounds().center() * to_world});
    }
}

/// Returns the data file of a light. Searches the same folders as included_file().
const RadData& RadReader::data_file(const RadMaterials::PatternedLight& light) {
    const std::string& name = light.pattern.data_file;
    std::error_code ignored;
    const fs::path folder = main_->path.parent_path(), beside_scene = folder / name;
    const fs::path path = fs::exists(beside_scene, ignored) ? beside_scene : light.where.file->parent_path() / name;
    const auto [entry, is_new] = data_.try_emplace(path);
    if (!is_new) return entry->second;
    require_within(path, folder, options_, "it");
    std::string text;
    try {
        text = read_text_file(path);
    } catch (const InputError& unreadable) {
        throw std::invalid_argument(unreadable.what());
    }
    model_.files.push_back(path.string());
    return entry->second = parse_rad_data(text, options_.max_photometric_values);
}

std::uint32_t RadReader::object(const std::string& name) {
    const auto [entry, is_new] = object_index_.try_emplace(name, static_cast<std::uint32_t>(model_.objects.size()));
    if (is_new) model_.objects.push_back(name);
    return entry->second;
}

void RadReader::require_room(double faces, std::size_t copies) {
    if (patches_ + 2 * faces * static_cast<double>(copies) > static_cast<double>(options_.max_patches))
        throw ReadFault(fmt::format("this would give more than {} patches (max_patches)", options_.max_patches),
                        "max_patches");
}

PolygonMesh RadReader::polygon(const std::vector<double>& numbers, const Tessellation&) const {
    const std::size_t vertices = numbers.size() / 3;
    if (numbers.size() % 3 != 0 || vertices < 3 || vertices > options_.max_face_vertices)
        throw std::invalid_argument(fmt::format("a polygon needs three numbers for each of 3 to {} vertices, not {}",
                                                options_.max_face_vertices, numbers.size()));
    PolygonMesh result;
    result.faces.emplace_back();
    for (std::size_t i = 0; i < vertices; ++i) {
        result.points.push_back(point(numbers, 3 * i));
        result.faces[0].push_back(static_cast<std::uint32_t>(i));
    }
    return result;
}

PolygonMesh RadReader::sphere(const std::vector<double>& numbers, const Tessellation& tessellation) const {
    return make_sphere(point(numbers, 0), numbers[3], tessellation);
}

PolygonMesh RadReader::bubble(const std::vector<double>& numbers, const Tessellation& tessellation) const {
    return make_sphere(point(numbers, 0), -numbers[3], tessellation);
}

PolygonMesh RadReader::cylinder(const std::vector<double>& numbers, const Tessellation& tessellation) const {
    return make_cone(point(numbers, 0), numbers[6], point(numbers, 3), numbers[6], tessellation);
}

PolygonMesh RadReader::tube(const std::vector<double>& numbers, const Tessellation& tessellation) const {
    return make_cone(point(numbers, 0), -numbers[6], point(numbers, 3), -numbers[6], tessellation);
}

PolygonMesh RadReader::cone(const std::vector<double>& numbers, const Tessellation& tessellation) const {
    return make_cone(point(numbers, 0), numbers[6], point(numbers, 3), numbers[7], tessellation);
}

PolygonMesh RadReader::cup(const std::vector<double>& numbers, const Tessellation& tessellation) const {
    return make_cone(point(numbers, 0), -numbers[6], point(numbers, 3), -numbers[7], tessellation);
}

PolygonMesh RadReader::ring(const std::vector<double>& numbers, const Tessellation& tessellation) const {
    const V3d normal = point(numbers, 3);
    if (normal == V3d(0)) throw std::invalid_argument("a ring needs a normal");
    const auto [inner, outer] = std::minmax(numbers[6], numbers[7]);
    return make_ring(point(numbers, 0), normal.normalized(), inner, outer, tessellation);
}

}  // namespace interflect::detail
