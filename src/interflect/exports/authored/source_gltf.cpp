#include "interflect/exports/authored/source_gltf.h"

#include <ImathBox.h>
#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <utility>
#include <vector>

#include "interflect/base/files/crc32.h"
#include "interflect/base/files/input_file.h"
#include "interflect/formats/gltf/baked_light.h"
#include "interflect/formats/gltf/gltf.h"
#include "interflect/formats/text/extension.h"
#include "interflect/formats/text/json_text.h"

namespace interflect::detail {

namespace fs = std::filesystem;

namespace {

constexpr const char* meshopt = "EXT_meshopt_compression";

nlohmann::json authored_json(std::string_view text, const fs::path& path) {
    nlohmann::json json = parse_json(text, path);
    remove_baked_light(json);
    return json;
}

void pad(std::string& bytes) {
    constexpr std::size_t alignment = 8;  // multiple of the alignments of all types of accessors
    bytes.resize((bytes.size() + alignment - 1) / alignment * alignment, '\0');
}

/// Returns the depth of nested lists and objects. The JSON writer needs stack for each level.
int nesting_of(std::string_view json) {
    int depth = 0, deepest = 0;
    bool in_text = false;
    for (std::size_t i = 0; i < json.size(); ++i) {
        const char c = json[i];
        if (c == '"') in_text = !in_text;
        if (in_text && c == '\\') ++i;
        if (in_text) continue;
        if (c == '{' || c == '[') deepest = std::max(deepest, ++depth);
        if (c == '}' || c == ']') --depth;
    }
    return deepest;
}

/// Returns the bounds of the file's faces in the world.
Imath::Box3d bounds_of(const Model& model) {
    Imath::Box3d bounds;
    for (const MeshInstance& instance : model.instances) {
        const Mesh& mesh = model.meshes[instance.mesh];
        for (const std::uint32_t v : mesh.indices) {  // not all vertices of a file belong to faces
            Imath::V3d x;
            instance.to_world.multVecMatrix(mesh.positions[v], x);
            bounds.extendBy(x);
        }
    }
    return bounds;
}

bool has_bounds(const Scene& scene, const Imath::Box3d& bounds) {
    Imath::Box3d own;
    for (const Patch& patch : scene.patches)
        for (int c = 0; c < patch.vertex_count(); ++c)
            own.extendBy(Imath::V3d(scene.vertices[patch.vertices[c]]) + scene.origin);
    constexpr double rounding = 1e-3;  // above the error of single precision; another unit changes far more
    const double most = rounding * bounds.size().length();
    return (own.min - bounds.min).length() <= most && (own.max - bounds.max).length() <= most;
}

/// Returns the type of an image by its first bytes.
const char* mime_type_of(std::string_view bytes) {
    if (bytes.starts_with("\x89PNG")) return "image/png";
    if (bytes.starts_with("\xabKTX 20")) return "image/ktx2";
    if (bytes.starts_with("RIFF")) return "image/webp";
    return "image/jpeg";
}

void move_view(Json& view, const std::vector<int>& new_buffer, const std::vector<std::size_t>& offset) {
    const std::size_t buffer = view.at("buffer");
    if (buffer >= offset.size())
        throw GltfFault(fmt::format("a buffer view has buffer {} of {}", buffer, offset.size()));
    if (const std::size_t moved = offset[buffer]) view["byteOffset"] = view.value("byteOffset", std::size_t{0}) + moved;
    view["buffer"] = new_buffer[buffer];
}

}  // namespace

SourceGltf::SourceGltf(const fs::path& path, std::string bytes, const ReadOptions& options)
    : bytes_(std::move(bytes)),
      parts_(gltf_parts(bytes_)),
      json_(authored_json(parts_.json, path)),
      options_(options),
      model_(read_gltf_model(bytes_, path, options_)),
      asset_(path, options_, json_),
      buffers_(asset_, parts_),
      accessors_(asset_, buffers_) {}

GltfElements SourceGltf::elements(std::uint32_t accessor) {
    if (accessor >= accessors_.count())
        throw GltfFault(fmt::format("an attribute has accessor {} of {}", accessor, accessors_.count()));
    return accessors_.elements(accessor, "SCALAR VEC2 VEC3 VEC4", asset_.root());
}

std::map<std::string, DracoAttribute> SourceGltf::decompressed(std::uint32_t mesh, std::uint32_t primitive) {
    const nlohmann::json& json = json_["meshes"][mesh]["primitives"][primitive];
    const nlohmann::json& extension = json["extensions"]["KHR_draco_mesh_compression"];
    const nlohmann::json& accessors = json_["accessors"];
    std::vector<std::string> names;
    std::vector<std::uint32_t> ids;
    for (const auto& [name, id] : extension["attributes"].items()) {
        names.push_back(name);
        ids.push_back(id.get<std::uint32_t>());
    }
    const std::uint64_t triangles = accessors[json["indices"].get<std::size_t>()]["count"].get<std::uint64_t>() / 3;
    const std::uint64_t vertices = accessors[json["attributes"]["POSITION"].get<std::size_t>()]["count"];
    const std::string_view bytes = buffers_.view(extension["bufferView"]).bytes;
    DracoMesh decoded = decode_draco(bytes, ids, triangles, vertices, asset_.root());
    if (decoded.vertex_count != vertices)
        throw GltfFault(fmt::format("meshes[{}].primitives[{}]: {} compressed vertices, expected {}", mesh, primitive,
                                    decoded.vertex_count, vertices));
    std::map<std::string, DracoAttribute> result;
    for (std::size_t i = 0; i < names.size(); ++i) result[names[i]] = std::move(decoded.attributes[i]);
    return result;
}

GltfDocument SourceGltf::document() {
    Json json = Json::parse(parts_.json);
    remove_baked_light(json);
    // Join the buffers
    std::string joined;
    std::vector<int> new_buffer;
    std::vector<std::size_t> offset;
    Json buffers = Json::array({Json::object()});
    const std::vector<GltfValue> described = asset_.root().objects("buffers");
    for (std::size_t i = 0; i < described.size(); ++i) {
        const bool has_uri = described[i].has("uri"), is_chunk = !has_uri && i == 0 && parts_.is_binary;
        const bool has_data = has_uri || is_chunk;
        pad(joined);
        offset.push_back(has_data ? joined.size() : 0);
        new_buffer.push_back(has_data ? 0 : static_cast<int>(buffers.size()));
        if (has_uri) joined += asset_.read_uri(described[i].text("uri"), described[i]);
        if (is_chunk) joined += parts_.binary.substr(0, described[i].integer("byteLength"));
        if (!has_data) buffers.push_back(json["buffers"][i]);  // placeholder for views of extensions
    }
    if (json.contains("buffers")) json["buffers"] = std::move(buffers);
    if (json.contains("bufferViews"))
        for (Json& view : json["bufferViews"]) {
            move_view(view, new_buffer, offset);
            if (view.contains("extensions") && view["extensions"].contains(meshopt))
                move_view(view["extensions"][meshopt], new_buffer, offset);
        }
    GltfDocument document(std::move(json), std::move(joined));
    // Embed the images
    const std::vector<GltfValue> images = asset_.root().objects("images");
    for (std::size_t i = 0; i < images.size(); ++i) {
        const std::string uri = images[i].text("uri");
        if (uri.empty() || uri.starts_with("data:") || asset_.is_missing(uri, images[i])) continue;
        const std::string bytes = asset_.read_uri(uri, images[i]);
        Json& image = document.json["images"][i];
        image.erase("uri");
        image["mimeType"] = mime_type_of(bytes);
        const int view = document.add_buffer_view(bytes);
        document.json["images"][i]["bufferView"] = view;
    }
    return document;
}

std::unique_ptr<SourceGltf> source_of(const Scene& scene, const fs::path& folder, Warnings& warnings) {
    if (scene.files.empty()) return nullptr;
    fs::path path = scene.files.front();
    const std::string extension = lower_case_extension(path);
    if (extension != ".glb" && extension != ".gltf") return nullptr;
    const auto cannot = [&](const std::string& why) {
        warnings.add("source-file", "the scene's own file " + why + ": its faces and materials are written anew",
                     scene.files.front());
        return nullptr;
    };
    std::error_code ignored;
    if (!fs::is_regular_file(path, ignored)) path = folder / path.filename();
    if (!fs::is_regular_file(path, ignored)) return cannot("is not there");
    try {
        std::string bytes = read_bytes(path);
        if (!scene.file_checksums.empty() && crc32(bytes) != scene.file_checksums.front())
            return cannot("has changed since it was solved");
        if (const int most = ReadOptions().max_nesting; nesting_of(gltf_parts(bytes).json) > most)
            return cannot(fmt::format("has values in more than {} others (max_nesting)", most));
        auto source = std::make_unique<SourceGltf>(path, std::move(bytes));
        if (!has_bounds(scene, bounds_of(source->model())))
            return cannot("was solved in another unit or with another up axis (unit, up_axis)");
        return source;
    } catch (const InputError& unreadable) {
        return cannot(fmt::format("cannot be kept ({})", unreadable.what()));
    } catch (const GltfFault& fault) {
        return cannot(fmt::format("cannot be kept ({})", fault.what()));
    }
}

}  // namespace interflect::detail
