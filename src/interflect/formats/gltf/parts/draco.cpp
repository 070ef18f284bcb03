#include "interflect/formats/gltf/parts/draco.h"

#include <fmt/format.h>

#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#endif
#include <draco/compression/decode.h>
#include <draco/compression/point_cloud/point_cloud_decoder.h>
#include <draco/core/varint_decoding.h>
#include <draco/metadata/metadata_decoder.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

namespace interflect::detail {

namespace {

/// Reads the counts that bound the decoder's memory. Only the Edgebreaker method stores the number of vertices first
/// (Draco 2.2 specification, section 2).
bool claims_at_most(draco::DecoderBuffer buffer, std::uint64_t max_triangles, std::uint64_t max_vertices) {
    constexpr int metadata_flag = 0x8000;
    draco::DracoHeader header{};
    if (!draco::PointCloudDecoder::DecodeHeader(&buffer, &header).ok()) return false;
    constexpr int version = 2 << 8 | 2;
    if ((header.version_major << 8 | header.version_minor) != version) return false;
    buffer.set_bitstream_version(version);
    if (header.flags & metadata_flag) {
        draco::GeometryMetadata metadata;
        draco::MetadataDecoder decoder;
        if (!decoder.DecodeGeometryMetadata(&buffer, &metadata)) return false;
    }
    const bool is_edgebreaker = header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING;
    std::uint8_t traversal = 0;
    std::uint32_t first = 0, second = 0;
    if (is_edgebreaker && !buffer.Decode(&traversal)) return false;
    if (!draco::DecodeVarint(&first, &buffer) || !draco::DecodeVarint(&second, &buffer)) return false;
    const std::uint32_t vertices = is_edgebreaker ? first : second, triangles = is_edgebreaker ? second : first;
    return triangles <= max_triangles && vertices <= max_vertices;
}

DracoAttribute attribute_of(const draco::Mesh& mesh, std::uint32_t id, const GltfValue& extension) {
    const draco::PointAttribute* attribute = mesh.GetAttributeByUniqueId(id);
    DracoAttribute result;
    result.components = attribute ? attribute->num_components() : 0;
    if (result.components < 1 || result.components > 4)
        extension.fail(fmt::format("its data have no attribute {} of 1 to 4 components", id));
    std::vector<float> value(static_cast<std::size_t>(result.components));
    for (draco::PointIndex point(0); point < mesh.num_points(); ++point) {
        if (!attribute->ConvertValue(attribute->mapped_index(point), static_cast<std::int8_t>(result.components),
                                     value.data()))
            extension.fail(fmt::format("attribute {} of its data has no numbers", id));
        result.values.insert(result.values.end(), value.begin(), value.end());
    }
    return result;
}

}  // namespace

DracoMesh decode_draco(std::string_view bytes, const std::vector<std::uint32_t>& attributes,
                       std::uint64_t max_triangles, std::uint64_t max_vertices, const GltfValue& extension) {
    draco::DecoderBuffer buffer;
    buffer.Init(bytes.data(), bytes.size());
    const auto type = draco::Decoder::GetEncodedGeometryType(&buffer);
    if (!type.ok() || type.value() != draco::TRIANGULAR_MESH) extension.fail("its data are no mesh of Draco's");
    if (!claims_at_most(buffer, max_triangles, max_vertices))
        extension.fail("its data are damaged, or have more triangles or vertices than its accessors");
    draco::Decoder decoder;
    const auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok()) extension.fail(fmt::format("its data are damaged ({})", decoded.status().error_msg_string()));
    const draco::Mesh& mesh = *decoded.value();
    DracoMesh result;
    result.vertex_count = mesh.num_points();
    for (draco::FaceIndex face(0); face < mesh.num_faces(); ++face)
        for (const draco::PointIndex& point : mesh.face(face)) {
            if (point.value() >= mesh.num_points()) extension.fail("its data are damaged (a vertex out of range)");
            result.indices.push_back(point.value());
        }
    for (const std::uint32_t id : attributes) result.attributes.push_back(attribute_of(mesh, id, extension));
    return result;
}

}  // namespace interflect::detail
