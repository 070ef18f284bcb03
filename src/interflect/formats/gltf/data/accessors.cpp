#include "interflect/formats/gltf/data/accessors.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <utility>

namespace interflect::detail {

namespace {

enum ComponentType {
    signed_byte = 5120,
    unsigned_byte = 5121,
    signed_short = 5122,
    unsigned_short = 5123,
    unsigned_int = 5125,
    float_number = 5126
};

std::size_t size_of(int component_type) {
    switch (component_type) {
        case signed_byte:
        case unsigned_byte:
            return 1;
        case signed_short:
        case unsigned_short:
            return 2;
        case unsigned_int:
        case float_number:
            return 4;
        default:
            return 0;
    }
}

constexpr std::pair<const char*, int> types_of_elements[] = {
    {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT4", 16}};  // these types have no padding

constexpr char zeros[16 * sizeof(float)] = {};

template <class T>
T load(const char* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof value);
    return value;
}

template <class T>
double load_integer(const char* bytes, bool normalized) {
    const double value = load<T>(bytes);
    return normalized ? std::max(value / std::numeric_limits<T>::max(), -1.0) : value;
}

std::size_t element_size(const GltfElements& elements) {
    return size_of(elements.component_type) * static_cast<std::size_t>(elements.components);
}

/// Returns the number and type of an accessor's elements, without their data.
GltfElements shape_of(const GltfValue& owner) {
    GltfElements shape;
    shape.count = owner.integer("count");
    shape.component_type = static_cast<int>(owner.integer("componentType"));
    shape.normalized = owner.flag("normalized", false);
    const std::string type = owner.text("type");
    const auto known = std::find_if(std::begin(types_of_elements), std::end(types_of_elements),
                                    [&](const auto& candidate) { return type == candidate.first; });
    shape.components = known == std::end(types_of_elements) ? 0 : known->second;
    if (element_size(shape) == 0)
        owner.fail(fmt::format("type '{}' of component type {} cannot be read", type, shape.component_type));
    return shape;
}

}  // namespace

double GltfElements::number(std::uint64_t element, int component) const {
    const char* bytes = first + element * stride + size_of(component_type) * static_cast<std::size_t>(component);
    switch (component_type) {
        case signed_byte:
            return load_integer<std::int8_t>(bytes, normalized);
        case unsigned_byte:
            return load_integer<std::uint8_t>(bytes, normalized);
        case signed_short:
            return load_integer<std::int16_t>(bytes, normalized);
        case unsigned_short:
            return load_integer<std::uint16_t>(bytes, normalized);
        case unsigned_int:
            return load_integer<std::uint32_t>(bytes, normalized);
        default:
            return static_cast<double>(load<float>(bytes));
    }
}

std::uint32_t GltfElements::whole_number(std::uint64_t element) const {
    const char* bytes = first + element * stride;
    if (component_type == unsigned_int) return load<std::uint32_t>(bytes);
    if (component_type == unsigned_short) return load<std::uint16_t>(bytes);
    return load<std::uint8_t>(bytes);
}

GltfAccessors::GltfAccessors(GltfAsset& asset, GltfBuffers& buffers)
    : asset_(asset), buffers_(buffers), accessors_(asset.root().objects("accessors")) {}

GltfElements GltfAccessors::in_view(const GltfValue& owner, const GltfElements& shape) {
    GltfElements result = shape;
    const GltfBuffers::View view = buffers_.view(owner.required_index("bufferView", buffers_.view_count()));
    const std::uint64_t offset = owner.integer("byteOffset", 0), size = element_size(shape);
    result.stride = view.stride > 0 ? view.stride : size;
    if (size == 0) owner.fail("its componentType is unknown");
    if (result.stride < size) owner.fail(fmt::format("byteStride {} is less than its elements' {}", view.stride, size));
    // Compares quotients, because products may overflow.
    const std::uint64_t room = offset <= view.bytes.size() ? view.bytes.size() - offset : 0;
    if (shape.count > 0 && (room < size || shape.count - 1 > (room - size) / result.stride))
        owner.fail(fmt::format("{} elements of {} bytes, {} apart, from {} on end beyond its view of {} bytes",
                               shape.count, size, result.stride, offset, view.bytes.size()));
    result.first = shape.count > 0 ? view.bytes.data() + offset : zeros;
    return result;
}

const std::string& GltfAccessors::sparse(std::uint32_t index, const GltfElements& base) {
    const auto [entry, is_new] = sparse_.try_emplace(index);
    std::string& bytes = entry->second;
    if (!is_new) return bytes;
    const GltfValue owner = accessors_[index].object("sparse");
    const std::size_t size = element_size(base);
    asset_.count_bytes(base.count * size, owner);
    bytes.resize(base.count * size);
    for (std::uint64_t i = 0; i < base.count; ++i)
        std::memcpy(bytes.data() + i * size, base.first + i * base.stride, size);
    const GltfValue indices = owner.object("indices"), replacements = owner.object("values");
    const GltfElements places = in_view(
        indices,
        {.count = owner.integer("count"), .component_type = static_cast<int>(indices.integer("componentType"))});
    GltfElements shape = base;
    shape.count = places.count;
    const GltfElements values = in_view(replacements, shape);
    for (std::uint64_t i = 0; i < places.count; ++i) {
        const std::uint32_t place = places.whole_number(i);
        if (i > 0 && place <= places.whole_number(i - 1))
            indices.fail(fmt::format("index {} follows {}; indices must ascend", place, places.whole_number(i - 1)));
        if (place >= base.count)
            indices.fail(fmt::format("element {} is replaced, but there are {}", place, base.count));
        std::memcpy(bytes.data() + place * size, values.first + i * values.stride, size);
    }
    return bytes;
}

GltfElements GltfAccessors::elements(std::uint32_t index, const std::string& types, const GltfValue& owner) {
    const GltfValue& accessor = accessors_[index];
    if (const std::string type = accessor.text("type"); (' ' + types + ' ').find(' ' + type + ' ') == types.npos)
        owner.fail(fmt::format("{} has the type '{}', expected {}", accessor.place(), type, types));
    GltfElements result = shape_of(accessor);
    if (accessor.has("bufferView")) {
        result = in_view(accessor, result);
    } else {
        result.first = zeros;
        result.stride = 0;
    }
    if (accessor.has("sparse")) {
        result.first = sparse(index, result).data();
        result.stride = element_size(result);
    }
    return result;
}

GltfElements GltfAccessors::indices(std::uint32_t index, const GltfValue& owner) {
    const GltfElements result = elements(index, "SCALAR", owner);
    const int type = result.component_type;
    if (result.normalized || (type != unsigned_byte && type != unsigned_short && type != unsigned_int))
        accessors_[index].fail("indices must be unsigned whole numbers");
    return result;
}

}  // namespace interflect::detail
