// Accessors: checked once against their views, then read in bulk, with no virtual call or lookup per element.
#include <algorithm>
#include <cstring>
#include <limits>

#include "host/gltf/import.h"

namespace etendue {
namespace {

// Elements of an accessor without data are zeros that the file does not pay for.
const size_t max_zeros = size_t(1) << 24;
// What a file may address: indices are 32-bit, and the largest one is reserved.
const uint64_t max_count = UINT32_MAX;

struct TypeShape {
    const char* name;
    uint32_t components, columns;
};
const TypeShape type_shapes[] = {{"SCALAR", 1, 1}, {"VEC2", 2, 1}, {"VEC3", 3, 1}, {"VEC4", 4, 1},
                                 {"MAT2", 4, 2},   {"MAT3", 9, 3}, {"MAT4", 16, 4}};

Component component_value(const JsonAt& at) {
    uint64_t value = integer_value(at);
    if (value < 5120 || value > 5126 || value == 5124)
        fail_at(at, "is {}; must be 5120, 5121, 5122, 5123, 5125 or 5126", value);
    return Component(value);
}

// The columns of a matrix start at multiples of 4 bytes (glTF 2.0, section 3.6.2.4).
size_t element_size(const TypeShape& shape, Component component) {
    size_t column = shape.components / shape.columns * component_size(component);
    return shape.columns == 1 ? column : shape.columns * ((column + 3) / 4 * 4);
}

// Start of `count` elements, all inside the view.
const uint8_t* data_in_view(const JsonAt& at, const BufferView& view, size_t offset, size_t count,
                            size_t stride, size_t size) {
    if (offset > view.bytes.size() || (count - 1) * stride + size > view.bytes.size() - offset)
        fail_at(at, "reads bytes {} to {} of a bufferView that has {}", offset,
                offset + (count - 1) * stride + size, view.bytes.size());
    return view.bytes.data() + offset;
}

const BufferView& view_of(const GltfImport& import, const JsonAt& object) {
    return import.views[index_value(member(object, "bufferView"), import.views.size(), "/bufferViews")];
}

size_t byte_offset(const JsonAt& object) { return integer(object, "byteOffset", 0, 0, uint64_t(1) << 53); }

void load_sparse(const GltfImport& import, const JsonAt& at, size_t size, Accessor& accessor) {
    Accessor::Sparse& sparse = accessor.sparse;
    sparse.count = integer_value(member(at, "count"), 1, accessor.count);
    JsonAt indices = member(at, "indices"), values = member(at, "values");
    JsonAt type = member(indices, "componentType");
    sparse.index_component = component_value(type);
    if (sparse.index_component != Component::u8 && sparse.index_component != Component::u16 &&
        sparse.index_component != Component::u32)
        fail_at(type, "is {}; must be 5121, 5123 or 5125", uint32_t(sparse.index_component));
    size_t index_size = component_size(sparse.index_component);
    sparse.indices = data_in_view(indices, view_of(import, indices), byte_offset(indices), sparse.count,
                                  index_size, index_size);
    sparse.values =
        data_in_view(values, view_of(import, values), byte_offset(values), sparse.count, size, size);
    for (size_t i = 0; i < sparse.count; ++i) {
        uint32_t index = 0;
        std::memcpy(&index, sparse.indices + i * index_size, index_size);
        if (index >= accessor.count)
            fail_at(indices, "has index {} at position {}; the accessor has {} elements", index, i,
                    accessor.count);
    }
}

template <class C>
void convert(const uint8_t* data, size_t stride, size_t count, size_t components, bool normalized, float* out,
             size_t out_stride) {
    const float scale = normalized ? 1.0f / float(std::numeric_limits<C>::max()) : 1.0f;
    for (size_t i = 0; i < count; ++i)
        for (size_t c = 0; c < components; ++c) {
            C value;
            std::memcpy(&value, data + i * stride + c * sizeof(C), sizeof(C));
            float result = float(value) * scale;
            if (std::is_signed_v<C> && std::is_integral_v<C> && normalized) result = std::max(result, -1.0f);
            out[i * out_stride + c] = result;
        }
}

void convert_any(const Accessor& a, const uint8_t* data, size_t stride, size_t count, float* out,
                 size_t out_stride) {
    switch (a.component) {
        case Component::i8:
            convert<int8_t>(data, stride, count, a.components, a.normalized, out, out_stride);
            break;
        case Component::u8:
            convert<uint8_t>(data, stride, count, a.components, a.normalized, out, out_stride);
            break;
        case Component::i16:
            convert<int16_t>(data, stride, count, a.components, a.normalized, out, out_stride);
            break;
        case Component::u16:
            convert<uint16_t>(data, stride, count, a.components, a.normalized, out, out_stride);
            break;
        case Component::u32:
            convert<uint32_t>(data, stride, count, a.components, a.normalized, out, out_stride);
            break;
        case Component::f32:
            if (stride == a.components * sizeof(float) && out_stride == a.components)
                std::memcpy(out, data, count * stride);
            else
                convert<float>(data, stride, count, a.components, false, out, out_stride);
    }
}

template <class C>
void widen(const uint8_t* data, size_t stride, size_t count, uint32_t* out) {
    for (size_t i = 0; i < count; ++i) {
        C value;
        std::memcpy(&value, data + i * stride, sizeof(C));
        out[i] = value;
    }
}

void widen_any(Component component, const uint8_t* data, size_t stride, size_t count, uint32_t* out) {
    if (component == Component::u8) widen<uint8_t>(data, stride, count, out);
    if (component == Component::u16) widen<uint16_t>(data, stride, count, out);
    if (component == Component::u32) widen<uint32_t>(data, stride, count, out);
}

uint32_t sparse_index(const Accessor::Sparse& sparse, size_t i) {
    uint32_t index = 0;
    size_t size = component_size(sparse.index_component);
    std::memcpy(&index, sparse.indices + i * size, size);
    return index;
}

}  // namespace

size_t component_size(Component component) {
    if (component == Component::i8 || component == Component::u8) return 1;
    if (component == Component::i16 || component == Component::u16) return 2;
    return 4;
}

void load_accessors(GltfImport& import) {
    for (size_t i = 0; i < array_size(import.root, "accessors"); ++i) {
        JsonAt at = document_element(import, "accessors", i);
        Accessor accessor;
        accessor.component = component_value(member(at, "componentType"));
        accessor.normalized = boolean(at, "normalized", false);
        if (accessor.normalized && component_size(accessor.component) == 4)
            fail_at(member(at, "normalized"), "is true; only components of 8 and 16 bits can be normalised");
        accessor.count = integer_value(member(at, "count"), 1, max_count);
        JsonAt type = member(at, "type");
        const TypeShape* shape = std::find_if(std::begin(type_shapes), std::end(type_shapes),
                                              [&](const TypeShape& s) { return text_value(type) == s.name; });
        if (shape == std::end(type_shapes))
            fail_at(type, "is '{}'; must be SCALAR, VEC2, VEC3, VEC4, MAT2, MAT3 or MAT4", text_value(type));
        accessor.type = shape->name;
        accessor.components = shape->components;
        size_t size = element_size(*shape, accessor.component);
        accessor.stride = size;
        if (find(at, "bufferView")) {
            const BufferView& view = view_of(import, at);
            if (view.stride != 0 && view.stride < size)
                fail_at(at, "has elements of {} bytes in a bufferView with a byteStride of {}", size,
                        view.stride);
            if (view.stride != 0) accessor.stride = view.stride;
            accessor.data = data_in_view(at, view, byte_offset(at), accessor.count, accessor.stride, size);
        } else if (accessor.count > max_zeros) {
            fail_at(at, "has {} elements without a bufferView; at most {} are allowed", accessor.count,
                    max_zeros);
        }
        if (std::optional<JsonAt> sparse = find_object(at, "sparse"))
            load_sparse(import, *sparse, size, accessor);
        import.accessors.push_back(std::move(accessor));
    }
}

const Accessor& accessor_at(const GltfImport& import, const JsonAt& index_at) {
    return import.accessors[index_value(index_at, import.accessors.size(), "/accessors")];
}

std::vector<uint32_t> read_indices(const Accessor& accessor) {
    std::vector<uint32_t> indices(accessor.count);
    if (accessor.data)
        widen_any(accessor.component, accessor.data, accessor.stride, accessor.count, indices.data());
    size_t size = component_size(accessor.component);
    for (size_t i = 0; i < accessor.sparse.count; ++i)
        widen_any(accessor.component, accessor.sparse.values + i * size, size, 1,
                  &indices[sparse_index(accessor.sparse, i)]);
    return indices;
}

void read_floats(const Accessor& accessor, size_t first, size_t count, float* out, size_t out_stride) {
    if (accessor.data)
        convert_any(accessor, accessor.data + first * accessor.stride, accessor.stride, count, out,
                    out_stride);
    else
        for (size_t i = 0; i < count; ++i) std::fill_n(out + i * out_stride, accessor.components, 0.0f);
    size_t size = accessor.components * component_size(accessor.component);
    for (size_t i = 0; i < accessor.sparse.count; ++i) {
        size_t index = sparse_index(accessor.sparse, i);
        if (index >= first && index - first < count)
            convert_any(accessor, accessor.sparse.values + i * size, size, 1,
                        out + (index - first) * out_stride, out_stride);
    }
}

}  // namespace etendue
