// Textures and images. Only those that a material refers to are kept; their images are decoded in parallel.
#include <atomic>
#include <exception>
#include <thread>

#include "host/image/atomic_file.h"
#include "host/gltf/import.h"
#include "host/scene/image_file.h"

namespace etendue {
namespace {

// The image's place in SceneDescription::images, where it is decoded later.
uint32_t use_image(GltfImport& import, uint32_t gltf_image) {
    import.image_of.resize(array_size(import.root, "images"), UINT32_MAX);
    uint32_t& place = import.image_of[gltf_image];
    if (place == UINT32_MAX) {
        place = uint32_t(import.images_to_decode.size());
        import.images_to_decode.push_back(gltf_image);
    }
    return place;
}

Wrap wrap_value(const JsonAt& sampler, const char* key) {
    uint64_t mode = integer(sampler, key, 10497);
    if (mode == 10497) return Wrap::repeat;
    if (mode == 33071) return Wrap::clamp;
    if (mode == 33648) return Wrap::mirror;
    fail_at(member(sampler, key), "is {}; must be 10497 (repeat), 33071 (clamp) or 33648 (mirror)", mode);
}

void read_sampler(const JsonAt& sampler, TextureDescription& texture) {
    texture.wrap_u = wrap_value(sampler, "wrapS");
    texture.wrap_v = wrap_value(sampler, "wrapT");
    uint64_t filter = integer(sampler, "magFilter", 9729);
    if (filter != 9728 && filter != 9729)
        fail_at(member(sampler, "magFilter"), "is {}; must be 9728 (nearest) or 9729 (linear)", filter);
    texture.nearest = filter == 9728;
}

// The image of a texture: that of EXT_texture_webp before the one for those who cannot read it.
uint32_t source_of(const GltfImport& import, const JsonAt& texture) {
    const size_t count = array_size(import.root, "images");
    std::optional<uint32_t> source;
    if (std::optional<JsonAt> webp = find_extension(texture, "EXT_texture_webp"))
        source = index(*webp, "source", count, "/images");
    if (!source) source = index(texture, "source", count, "/images");
    if (source) return *source;
    if (find_extension(texture, "KHR_texture_basisu"))
        fail_at(texture,
                "is of KTX 2 alone (KHR_texture_basisu), which cannot be read; a texture needs a "
                "\"source\" of type PNG, JPEG, WebP, .hdr or .exr");
    fail_at(texture, "has no \"source\"; a texture needs one, of type PNG, JPEG, WebP, .hdr or .exr");
}

uint32_t use_texture(GltfImport& import, uint32_t gltf_texture) {
    import.texture_of.resize(array_size(import.root, "textures"), UINT32_MAX);
    uint32_t& place = import.texture_of[gltf_texture];
    if (place != UINT32_MAX) return place;
    JsonAt at = document_element(import, "textures", gltf_texture);
    TextureDescription texture;
    texture.image = use_image(import, source_of(import, at));
    std::optional<uint32_t> sampler = index(at, "sampler", array_size(import.root, "samplers"), "/samplers");
    if (sampler) read_sampler(document_element(import, "samplers", *sampler), texture);
    place = uint32_t(import.scene.textures.size());
    import.scene.textures.push_back(texture);
    return place;
}

// Texture coordinates beyond the second set are not read.
void check_coordinates(GltfImport& import, const JsonAt& object, nlohmann::json& result) {
    uint64_t set = integer(object, "texCoord", 0);
    if (set <= 1) return;
    warn(import, object, fmt::format("uses TEXCOORD_{}; only 0 and 1 are modelled: TEXCOORD_0 is used", set));
    result["texCoord"] = 0;
}

ImageDescription decode_gltf_image(const GltfImport& import, uint32_t gltf_image) {
    JsonAt at = document_element(import, "images", gltf_image);
    std::optional<JsonAt> uri = find(at, "uri");
    std::optional<uint32_t> view = index(at, "bufferView", import.views.size(), "/bufferViews");
    if (uri && view) fail_at(at, "has a \"uri\" and a \"bufferView\"; must have one of them");
    ImageDescription image;
    if (view) {
        image = decode_image(import.views[*view].bytes, message_at(at, fmt::format("bufferView {}", *view)));
    } else if (!uri) {
        fail_at(at, "has neither \"uri\" nor \"bufferView\"; must have one of them");
    } else if (is_data_uri(text_value(*uri))) {
        image = decode_image(decode_data_uri(*uri), message_at(*uri, "data"));
    } else {
        std::string where = message_at(*uri, text_value(*uri));
        const std::filesystem::path file = resolve_uri(import, *uri);
        image = decode_image(octets(read_whole_file(file)), where);
        image.file = file;
    }
    bool is_file = uri && !is_data_uri(text_value(*uri));
    image.name = text(at, "name", is_file ? text_value(*uri) : fmt::format("image {}", gltf_image));
    return image;
}

}  // namespace

nlohmann::json read_texture_info(GltfImport& import, const JsonAt& info) {
    require_object(info);
    nlohmann::json result = *info;
    uint32_t texture = index_value(member(info, "index"), array_size(import.root, "textures"), "/textures");
    result["index"] = use_texture(import, texture);
    check_coordinates(import, info, result);
    number(info, "scale", 1, -max_coordinate, max_coordinate);
    if (std::optional<JsonAt> transform = find_extension(info, "KHR_texture_transform")) {
        numbers(*transform, "offset", {0, 0}, -max_coordinate, max_coordinate);
        numbers(*transform, "scale", {1, 1}, -max_coordinate, max_coordinate);
        number(*transform, "rotation", 0, -max_coordinate, max_coordinate);
        check_coordinates(import, *transform, result["extensions"]["KHR_texture_transform"]);
    }
    return result;
}

nlohmann::json derived_texture(GltfImport& import, const nlohmann::json& info, ImageMaker make) {
    TextureDescription texture = import.scene.textures[info["index"].get<uint32_t>()];
    texture.image = uint32_t(import.images_to_decode.size());
    import.images_to_decode.push_back(UINT32_MAX);
    import.images_to_make[texture.image] = std::move(make);
    nlohmann::json result = info;
    result["index"] = import.scene.textures.size();
    import.scene.textures.push_back(texture);
    return result;
}

void decode_images(GltfImport& import) {
    size_t count = import.images_to_decode.size();
    import.scene.images.resize(count);
    std::vector<std::exception_ptr> failures(count);
    std::atomic<size_t> next = 0;
    auto work = [&] {
        for (size_t i = next++; i < count; i = next++) try {
                if (import.images_to_decode[i] != UINT32_MAX)
                    import.scene.images[i] = decode_gltf_image(import, import.images_to_decode[i]);
            } catch (...) {
                failures[i] = std::current_exception();
            }
    };
    std::vector<std::jthread> helpers;
    size_t threads = std::min<size_t>(count, std::max(1u, std::thread::hardware_concurrency()));
    for (size_t i = 1; i < threads; ++i) helpers.emplace_back(work);
    work();
    helpers.clear();
    for (const std::exception_ptr& failure : failures)
        if (failure) std::rethrow_exception(failure);
    for (const auto& [image, make] : import.images_to_make)
        import.scene.images[image] = make(import.scene.images);
}

}  // namespace etendue
