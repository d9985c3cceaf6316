// KHR_draco_mesh_compression: primitives whose accessors have no data of their own, but those that Draco
// unpacks.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wall"
#pragma GCC diagnostic ignored "-Wextra"
#include <draco/compression/decode.h>
#pragma GCC diagnostic pop

#include "host/gltf/import.h"

namespace etendue {
namespace {

template <class C>
void write_points(const draco::Mesh& mesh, const draco::PointAttribute& from, uint32_t components,
                  Bytes& out) {
    out.resize(size_t(mesh.num_points()) * components * sizeof(C));
    std::vector<C> value(components);
    for (uint32_t p = 0; p < mesh.num_points(); ++p) {
        if (!from.ConvertValue<C>(from.mapped_index(draco::PointIndex(p)), int8_t(components), value.data()))
            std::fill(value.begin(), value.end(), C(0));
        std::memcpy(out.data() + size_t(p) * components * sizeof(C), value.data(), components * sizeof(C));
    }
}

void write_points_as(Component component, const draco::Mesh& mesh, const draco::PointAttribute& from,
                     uint32_t components, Bytes& out) {
    switch (component) {
        case Component::i8:
            return write_points<int8_t>(mesh, from, components, out);
        case Component::u8:
            return write_points<uint8_t>(mesh, from, components, out);
        case Component::i16:
            return write_points<int16_t>(mesh, from, components, out);
        case Component::u16:
            return write_points<uint16_t>(mesh, from, components, out);
        case Component::u32:
            return write_points<uint32_t>(mesh, from, components, out);
        case Component::f32:
            return write_points<float>(mesh, from, components, out);
    }
}

std::unique_ptr<draco::Mesh> unpack(const JsonAt& at, std::span<const uint8_t> bytes) {
    try {
        draco::DecoderBuffer buffer;
        buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
        draco::Decoder decoder;
        auto mesh = decoder.DecodeMeshFromBuffer(&buffer);
        if (!mesh.ok()) fail_at(at, "the compressed data are damaged: {}", mesh.status().error_msg_string());
        return std::move(mesh).value();
    } catch (const std::length_error&) {
        fail_at(at, "the compressed data are damaged");
    }
}

void give_data(GltfImport& import, Accessor& accessor, Bytes bytes, size_t stride) {
    accessor.data = import.decoded.emplace_back(std::move(bytes)).data();
    accessor.stride = stride;
}

}  // namespace

void decode_draco(GltfImport& import, const JsonAt& primitive) {
    std::optional<JsonAt> extension = find_extension(primitive, "KHR_draco_mesh_compression");
    if (!extension) return;
    JsonAt attributes = member(primitive, "attributes"), packed = member(*extension, "attributes");
    require_object(packed);
    const auto accessor = [&](const JsonAt& at) -> Accessor& {
        return import.accessors[index_value(at, import.accessors.size(), "/accessors")];
    };
    // Data that stand there for those who cannot unpack are the same, and so are those of an earlier
    // primitive.
    Accessor* indices = nullptr;
    if (std::optional<JsonAt> at = find(primitive, "indices")) indices = &accessor(*at);
    bool is_packed = indices && !indices->data;
    for (auto i = packed->begin(); i != packed->end(); ++i)
        is_packed = is_packed || !accessor(member(attributes, i.key())).data;
    if (!is_packed) return;

    const uint32_t view = index_value(member(*extension, "bufferView"), import.views.size(), "/bufferViews");
    const std::unique_ptr<draco::Mesh> mesh = unpack(*extension, import.views[view].bytes);
    if (integer(primitive, "mode", 4) != 4)
        fail_at(primitive, "is packed by Draco, and no list of triangles; must have mode 4");
    if (indices && !indices->data) {
        if (indices->count != 3 * size_t(mesh->num_faces()))
            fail_at(*extension, "holds {} triangles; its indices are {}", mesh->num_faces(), indices->count);
        Bytes bytes(4 * indices->count);
        for (uint32_t f = 0; f < mesh->num_faces(); ++f) {
            const auto& face = mesh->face(draco::FaceIndex(f));
            const uint32_t corners[3] = {face[0].value(), face[1].value(), face[2].value()};
            std::memcpy(bytes.data() + 12 * size_t(f), corners, sizeof corners);
        }
        indices->component = Component::u32;
        give_data(import, *indices, std::move(bytes), 4);
    }
    for (auto i = packed->begin(); i != packed->end(); ++i) {
        JsonAt at = member(packed, i.key());
        Accessor& to = accessor(member(attributes, i.key()));
        if (to.data) continue;
        const draco::PointAttribute* from = mesh->GetAttributeByUniqueId(uint32_t(integer_value(at)));
        if (!from) fail_at(at, "the compressed data have no such attribute");
        if (to.count != mesh->num_points())
            fail_at(at, "has {} elements; the compressed data have {}", to.count, mesh->num_points());
        if (from->num_components() != to.components)
            fail_at(at, "has {} components; those of the compressed data have {}", to.components,
                    int(from->num_components()));
        Bytes bytes;
        write_points_as(to.component, *mesh, *from, to.components, bytes);
        give_data(import, to, std::move(bytes), to.components * component_size(to.component));
    }
}

}  // namespace etendue
