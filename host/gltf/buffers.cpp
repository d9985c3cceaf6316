// Buffers and buffer views, also such as EXT_meshopt_compression has packed.
#include <meshoptimizer.h>

#include "host/image/atomic_file.h"
#include "host/gltf/import.h"

namespace etendue {
namespace {

// The bytes of a buffer that a view, or the compressed form of one, refers to.
std::span<const uint8_t> bytes_of(const GltfImport& import, const JsonAt& view) {
    const auto& bytes =
        import.buffers[index_value(member(view, "buffer"), import.buffers.size(), "/buffers")];
    const size_t offset = integer(view, "byteOffset", 0, 0, uint64_t(1) << 53);
    const size_t length = integer_value(member(view, "byteLength"), 1, uint64_t(1) << 53);
    if (offset > bytes.size() || length > bytes.size() - offset)
        fail_at(view, "bytes {} to {} of a buffer that has {}", offset, offset + length, bytes.size());
    return bytes.subspan(offset, length);
}

// A buffer that only stands in for decompressed data has none of its own.
bool is_fallback(const JsonAt& buffer) {
    std::optional<JsonAt> extension = find_extension(buffer, "EXT_meshopt_compression");
    return extension && boolean(*extension, "fallback", false);
}

// Numbers of `stride` bytes that the filter takes (EXT_meshopt_compression, appendix B).
void check_filter(const JsonAt& at, const std::string& filter, const std::string& mode, size_t stride) {
    const bool fits = filter == "NONE" ||
                      (mode == "ATTRIBUTES" && ((filter == "OCTAHEDRAL" && (stride == 4 || stride == 8)) ||
                                                (filter == "QUATERNION" && stride == 8) ||
                                                (filter == "EXPONENTIAL" && stride % 4 == 0)));
    if (!fits)
        fail_at(at,
                "has the filter '{}' for mode {} and {} bytes; allowed: NONE, and for ATTRIBUTES OCTAHEDRAL "
                "(4 or 8 bytes), QUATERNION (8) and EXPONENTIAL (a multiple of 4)",
                filter, mode, stride);
}

Bytes decompress(const GltfImport& import, const JsonAt& at) {
    const std::span<const uint8_t> packed = bytes_of(import, at);
    const size_t stride = integer_value(member(at, "byteStride"), 1, 256);
    const size_t count = integer_value(member(at, "count"), 1, UINT32_MAX);
    JsonAt mode_at = member(at, "mode");
    const std::string& mode = text_value(mode_at);
    const std::string filter = text(at, "filter", "NONE");
    check_filter(at, filter, mode, stride);
    const bool are_indices = mode == "TRIANGLES" || mode == "INDICES";
    if (are_indices ? stride != 2 && stride != 4 : stride % 4 != 0)
        fail_at(at, "has a byteStride of {}; allowed: {}", stride,
                are_indices ? "2 and 4" : "multiples of 4");
    if (mode == "TRIANGLES" && count % 3 != 0) fail_at(at, "has {} corners of triangles", count);
    // No data packs better than 64 times by these codecs: a few bytes cannot ask for all memory.
    if (count * stride > 64 * (packed.size() + 1024))
        fail_at(at, "has {} x {} bytes in {}; these codecs do not pack so well", count, stride,
                packed.size());
    Bytes bytes(count * stride);
    int failure = 0;
    if (mode == "ATTRIBUTES")
        failure = meshopt_decodeVertexBuffer(bytes.data(), count, stride, packed.data(), packed.size());
    else if (mode == "TRIANGLES")
        failure = meshopt_decodeIndexBuffer(bytes.data(), count, stride, packed.data(), packed.size());
    else if (mode == "INDICES")
        failure = meshopt_decodeIndexSequence(bytes.data(), count, stride, packed.data(), packed.size());
    else
        fail_at(mode_at, "is '{}'; must be ATTRIBUTES, TRIANGLES or INDICES", mode);
    if (failure != 0) fail_at(at, "the compressed data are damaged");
    if (filter == "OCTAHEDRAL") meshopt_decodeFilterOct(bytes.data(), count, stride);
    if (filter == "QUATERNION") meshopt_decodeFilterQuat(bytes.data(), count, stride);
    if (filter == "EXPONENTIAL") meshopt_decodeFilterExp(bytes.data(), count, stride);
    return bytes;
}

}  // namespace

void load_buffers(GltfImport& import) {
    for (size_t i = 0; i < array_size(import.root, "buffers"); ++i) {
        JsonAt buffer = document_element(import, "buffers", i);
        size_t length = integer_value(member(buffer, "byteLength"), 1, uint64_t(1) << 53);
        std::span<const uint8_t> bytes;
        std::optional<JsonAt> uri = find(buffer, "uri");
        if (!uri && is_fallback(buffer)) {
            import.buffers.emplace_back();
            continue;
        }
        if (!uri) {
            if (i != 0 || !import.binary_chunk.data())
                fail_at(buffer,
                        "has no \"uri\"; only the first buffer of a .glb with a binary chunk needs none");
            bytes = import.binary_chunk;
        } else if (is_data_uri(text_value(*uri))) {
            bytes = import.decoded.emplace_back(decode_data_uri(*uri));
        } else {
            const auto& file = import.scene.buffer_files.emplace_back(resolve_uri(import, *uri));
            bytes = octets(import.files.emplace_back(read_whole_file(file)));
        }
        if (bytes.size() < length)
            fail_at(buffer, "is truncated: byteLength says {}, there are {} bytes", length, bytes.size());
        import.buffers.push_back(bytes.first(length));
    }
    for (size_t i = 0; i < array_size(import.root, "bufferViews"); ++i) {
        JsonAt view = document_element(import, "bufferViews", i);
        const size_t stride = size_t(integer(view, "byteStride", 0, 4, 252));
        std::optional<JsonAt> compressed = find_extension(view, "EXT_meshopt_compression");
        const size_t length = integer_value(member(view, "byteLength"), 1, uint64_t(1) << 53);
        std::span<const uint8_t> bytes;
        if (compressed) {
            bytes = import.decoded.emplace_back(decompress(import, *compressed));
            if (bytes.size() < length)
                fail_at(view, "has {} bytes; its compressed data have {}", length, bytes.size());
            bytes = bytes.first(length);
        } else {
            bytes = bytes_of(import, view);
        }
        import.views.push_back({bytes, stride});
    }
}

}  // namespace etendue
