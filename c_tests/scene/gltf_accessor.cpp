#include "scene/gltf_accessor.hpp"

#include <cstring>
#include <span>
#include <string>

#include "scene/load.hpp"

namespace harness {

namespace {

/// A sparse accessor without a bufferView is all zeros and costs its file nothing, so its size needs a bound of its own: 192 MiB
/// of positions.
constexpr std::size_t most_zero_elements = std::size_t(1) << 24;

using Bytes = std::span<const unsigned char>;

/// Elements at a regular distance inside a bufferView; all of them lie inside their buffer.
struct ElementRange {
    Bytes bytes;  // from the first element on
    std::size_t count, stride, element_bytes;
    const unsigned char* element(std::size_t i) const { return bytes.data() + i * stride; }
};

ElementRange element_range(const tinygltf::Model& model, int view_id, std::size_t offset, std::size_t count,
                           std::size_t element_bytes) {
    const Bytes view = view_bytes(model, view_id);
    const std::size_t byte_stride = model.bufferViews[std::size_t(view_id)].byteStride;
    const std::size_t stride = byte_stride == 0 ? element_bytes : byte_stride;
    if (stride < element_bytes)
        throw SceneError("byteStride " + std::to_string(stride) + " is less than the element's " + std::to_string(element_bytes) +
                         " bytes");
    if (count == 0) throw SceneError("no elements in bufferView " + std::to_string(view_id));
    const std::size_t available = offset <= view.size() ? view.size() - offset : 0;
    // The last element starts (count - 1) strides in; a division, because the product may overflow.
    if (available < element_bytes || count - 1 > (available - element_bytes) / stride)
        throw SceneError(std::to_string(count) + " elements from byte " + std::to_string(offset) +
                         " on pass the end of bufferView " + std::to_string(view_id) + ", which has " +
                         std::to_string(view.size()) + " bytes");
    return {view.subspan(offset), count, stride, element_bytes};
}

std::uint32_t read_unsigned(const unsigned char* bytes, std::size_t component_bytes) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes, component_bytes);  // little-endian: the low bytes come first
    return value;
}

/// Bytes of an unsigned integer that may index; throws for any other type.
std::size_t index_bytes(int component_type) {
    switch (component_type) {
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return 1;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return 2;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return 4;
        default:
            throw SceneError("componentType " + std::to_string(component_type) +
                             " is not an index type: UNSIGNED_BYTE, _SHORT or _INT (5121, 5123, 5125)");
    }
}

/// Writes the sparse values of `accessor` over the packed `elements`.
void apply_sparse(const tinygltf::Model& model, const tinygltf::Accessor& accessor, std::size_t element_bytes,
                  std::vector<unsigned char>& elements) {
    const auto& sparse = accessor.sparse;
    const auto count = std::size_t(sparse.count);
    if (count > accessor.count)
        throw SceneError("sparse: " + std::to_string(count) + " values for " + std::to_string(accessor.count) + " elements");
    const ElementRange indices = element_range(model, sparse.indices.bufferView, std::size_t(sparse.indices.byteOffset), count,
                                               index_bytes(sparse.indices.componentType));
    const ElementRange values =
        element_range(model, sparse.values.bufferView, std::size_t(sparse.values.byteOffset), count, element_bytes);
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t index = read_unsigned(indices.element(i), indices.element_bytes);
        if (index >= accessor.count)
            throw SceneError("sparse: index " + std::to_string(index) + " at position " + std::to_string(i) +
                             " is out of range: " + std::to_string(accessor.count) + " elements");
        std::memcpy(&elements[index * element_bytes], values.element(i), element_bytes);
    }
}

/// All elements, packed. Copied byte by byte, since no offset in a file need be aligned.
std::vector<unsigned char> read_elements(const tinygltf::Model& model, const tinygltf::Accessor& accessor,
                                         std::size_t element_bytes) {
    std::vector<unsigned char> elements;
    if (accessor.bufferView >= 0) {
        const ElementRange range = element_range(model, accessor.bufferView, accessor.byteOffset, accessor.count, element_bytes);
        elements.resize(range.count * element_bytes);
        for (std::size_t i = 0; i < range.count; ++i) std::memcpy(&elements[i * element_bytes], range.element(i), element_bytes);
    } else if (!accessor.sparse.isSparse) {
        throw SceneError("no bufferView and not sparse");
    } else if (accessor.count > most_zero_elements) {
        throw SceneError("sparse without a bufferView: " + std::to_string(accessor.count) + " elements, of at most " +
                         std::to_string(most_zero_elements));
    } else {
        elements.resize(accessor.count * element_bytes);
    }
    if (accessor.sparse.isSparse) apply_sparse(model, accessor, element_bytes, elements);
    return elements;
}

/// Runs `read` and puts the accessor's name before what it throws.
template <typename Read>
auto naming_accessor(int accessor_id, Read read) {
    try {
        return read();
    } catch (const SceneError& error) {
        throw SceneError("accessor " + std::to_string(accessor_id) + ": " + error.what());
    }
}

}  // namespace

std::span<const unsigned char> view_bytes(const tinygltf::Model& model, int view_id) {
    const std::string name = "bufferView " + std::to_string(view_id);
    if (view_id < 0 || std::size_t(view_id) >= model.bufferViews.size()) throw SceneError(name + " does not exist");
    const tinygltf::BufferView& view = model.bufferViews[std::size_t(view_id)];
    if (view.buffer < 0 || std::size_t(view.buffer) >= model.buffers.size())
        throw SceneError(name + ": buffer " + std::to_string(view.buffer) + " does not exist");
    const Bytes buffer = model.buffers[std::size_t(view.buffer)].data;
    if (view.byteOffset > buffer.size() || view.byteLength > buffer.size() - view.byteOffset)
        throw SceneError(name + ": " + std::to_string(view.byteLength) + " bytes from " + std::to_string(view.byteOffset) +
                         " on pass the end of buffer " + std::to_string(view.buffer) + ", which has " +
                         std::to_string(buffer.size()));
    return buffer.subspan(view.byteOffset, view.byteLength);
}

const tinygltf::Accessor& find_accessor(const tinygltf::Model& model, int accessor_id) {
    if (accessor_id < 0 || std::size_t(accessor_id) >= model.accessors.size())
        throw SceneError("accessor " + std::to_string(accessor_id) +
                         " does not exist: " + std::to_string(model.accessors.size()) + " accessors");
    return model.accessors[std::size_t(accessor_id)];
}

std::vector<float> read_positions(const tinygltf::Model& model, int accessor_id) {
    const tinygltf::Accessor& accessor = find_accessor(model, accessor_id);
    return naming_accessor(accessor_id, [&] {
        if (accessor.type != TINYGLTF_TYPE_VEC3 || accessor.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT)
            throw SceneError("POSITION is not VEC3 of FLOAT (componentType 5126)");
        const std::vector<unsigned char> elements = read_elements(model, accessor, 3 * sizeof(float));
        std::vector<float> positions(accessor.count * 3);
        std::memcpy(positions.data(), elements.data(), elements.size());
        return positions;
    });
}

std::vector<float> read_texcoords(const tinygltf::Model& model, int accessor_id) {
    const tinygltf::Accessor& accessor = find_accessor(model, accessor_id);
    return naming_accessor(accessor_id, [&] {
        const bool is_float = accessor.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT;
        const bool is_fraction = accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                                 accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT;
        if (accessor.type != TINYGLTF_TYPE_VEC2 || !(is_float || is_fraction))
            throw SceneError("TEXCOORD is not VEC2 of FLOAT, UNSIGNED_BYTE or UNSIGNED_SHORT (componentType 5126, 5121, 5123)");
        const std::size_t component_bytes = is_float ? sizeof(float) : index_bytes(accessor.componentType);
        const std::vector<unsigned char> elements = read_elements(model, accessor, 2 * component_bytes);
        std::vector<float> texcoords(accessor.count * 2);
        if (is_float) {
            std::memcpy(texcoords.data(), elements.data(), elements.size());
        } else {
            const float one = component_bytes == 1 ? 255 : 65535;
            for (std::size_t i = 0; i < texcoords.size(); ++i)
                texcoords[i] = float(read_unsigned(&elements[i * component_bytes], component_bytes)) / one;
        }
        return texcoords;
    });
}

std::vector<std::uint32_t> read_indices(const tinygltf::Model& model, int accessor_id) {
    const tinygltf::Accessor& accessor = find_accessor(model, accessor_id);
    return naming_accessor(accessor_id, [&] {
        if (accessor.type != TINYGLTF_TYPE_SCALAR) throw SceneError("indices are not SCALAR");
        const std::size_t element_bytes = index_bytes(accessor.componentType);
        const std::vector<unsigned char> elements = read_elements(model, accessor, element_bytes);
        std::vector<std::uint32_t> indices(accessor.count);
        for (std::size_t i = 0; i < indices.size(); ++i) indices[i] = read_unsigned(&elements[i * element_bytes], element_bytes);
        return indices;
    });
}

}  // namespace harness
