// Material models that extensions put in the place of metallic-roughness, as parameters of class
// `principled`.
#include <algorithm>
#include <cmath>

#include "host/gltf/import.h"

namespace etendue {
namespace {

using nlohmann::json;

// IEC 61966-2-1: of each byte, and back.
std::vector<double> linear_bytes() {
    std::vector<double> result;
    for (int i = 0; i < 256; ++i) {
        const double srgb = i / 255.0;
        result.push_back(srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4));
    }
    return result;
}
double srgb_of(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}
uint8_t byte_of(double value) { return uint8_t(std::lround(255 * std::clamp(value, 0.0, 1.0))); }

// The texel of an image where that of an image of another size lies: linear colour, and alpha.
glm::dvec4 texel(const ImageDescription& image, uint32_t x, uint32_t y, uint32_t width, uint32_t height) {
    static const std::vector<double> linear = linear_bytes();
    const uint32_t column = uint32_t(uint64_t(x) * image.width / width),
                   row = uint32_t(uint64_t(y) * image.height / height);
    const size_t first = 4 * (size_t(row) * image.width + column);
    glm::dvec4 result;
    for (int c = 0; c < 4; ++c) {
        if (!image.rgba32f.empty())
            result[c] = image.rgba32f[first + size_t(c)];
        else if (c < 3)
            result[c] = linear[image.rgba8[first + size_t(c)]];
        else
            result[c] = image.rgba8[first + size_t(c)] / 255.0;
    }
    return result;
}

double greatest(const glm::dvec3& v) { return std::max({v.x, v.y, v.z}); }

// Of two images, of the size of the larger one.
template <class Combine>  // linear texels to one of numbers from 0 to 1, which become bytes as they are
ImageDescription combined(const ImageDescription& a, const ImageDescription& b, Combine combine) {
    ImageDescription image;
    image.name = a.name;
    const ImageDescription& larger = uint64_t(b.width) * b.height > uint64_t(a.width) * a.height ? b : a;
    image.width = larger.width, image.height = larger.height;
    image.rgba8.reserve(4 * size_t(image.width) * image.height);
    for (uint32_t y = 0; y < image.height; ++y)
        for (uint32_t x = 0; x < image.width; ++x) {
            const glm::dvec4 value =
                combine(texel(a, x, y, image.width, image.height), texel(b, x, y, image.width, image.height));
            for (int c = 0; c < 4; ++c) image.rgba8.push_back(byte_of(value[c]));
        }
    return image;
}

// One texel, of the mean of the others.
ImageDescription mean_of(const ImageDescription& image) {
    glm::dvec4 sum(0);
    for (uint32_t y = 0; y < image.height; ++y)
        for (uint32_t x = 0; x < image.width; ++x) sum += texel(image, x, y, image.width, image.height);
    sum /= double(image.width) * image.height;
    ImageDescription mean;
    mean.width = mean.height = 1;
    for (int c = 0; c < 4; ++c) mean.rgba32f.push_back(float(sum[c]));
    return mean;
}

uint32_t image_of(const GltfImport& import, const json& info) {
    return import.scene.textures[info["index"].get<uint32_t>()].image;
}

bool have_same_coordinates(json a, json b) {
    a.erase("index"), b.erase("index");
    return a == b;
}

// c_diff, where a texture says how specular the surface is.
json dimmed_diffuse(GltfImport& import, const JsonAt& extension, const json& specular_texture,
                    const glm::dvec3& specular) {
    std::optional<JsonAt> at = find_object(extension, "diffuseTexture");
    const json onto = at ? read_texture_info(import, *at) : specular_texture;
    const bool same = have_same_coordinates(onto, specular_texture);
    if (!same)
        warn(import, extension,
             "its two textures lie by different coordinates: the mean of the specular one dims the diffuse "
             "one");
    const bool has_diffuse = at.has_value();
    return derived_texture(import, onto,
                           [=, diffuse_image = image_of(import, onto),
                            image = image_of(import, specular_texture)](const auto& images) {
                               const ImageDescription& by = same ? images[image] : mean_of(images[image]);
                               return combined(images[diffuse_image], by, [&](const auto& d, const auto& s) {
                                   const double left = 1 - greatest(specular * glm::dvec3(s));
                                   const glm::dvec4 color = has_diffuse ? d : glm::dvec4(1);
                                   return glm::dvec4(srgb_of(left * color.x), srgb_of(left * color.y),
                                                     srgb_of(left * color.z), color.w);
                               });
                           });
}

}  // namespace

// Its section "Specular - Glossiness": c_diff = diffuse (1 - max(specular)), F0 = specular, alpha =
// (1 - glossiness)². With an ior of 0, F0 is the specular colour (KHR_materials_ior).
json specular_glossiness(GltfImport& import, const JsonAt& extension) {
    const std::vector<double> diffuse = numbers(extension, "diffuseFactor", {1, 1, 1, 1}, 0, 1),
                              specular = numbers(extension, "specularFactor", {1, 1, 1}, 0, 1);
    const double glossiness = number(extension, "glossinessFactor", 1, 0, 1);
    const glm::dvec3 factor(specular[0], specular[1], specular[2]);
    json p = {{"metallic", 0}, {"ior", 0}, {"specular_color", specular}, {"roughness", 1 - glossiness}};
    double left = 1;  // of the diffuse colour
    if (std::optional<JsonAt> at = find_object(extension, "specularGlossinessTexture")) {
        const json texture = read_texture_info(import, *at);
        p["base_color_texture"] = dimmed_diffuse(import, extension, texture, factor);
        p["specular_color_texture"] = texture;
        p["roughness"] = 1;
        p["metallic_roughness_texture"] = derived_texture(
            import, texture, [glossiness, image = image_of(import, texture)](const auto& images) {
                return combined(images[image], images[image], [&](const auto& t, const auto&) {
                    return glm::dvec4(0, 1 - glossiness * t.w, 0, 1);
                });
            });
    } else {
        if (std::optional<JsonAt> info = find_object(extension, "diffuseTexture"))
            p["base_color_texture"] = read_texture_info(import, *info);
        left = 1 - greatest(factor);
    }
    p["base_color"] = {left * diffuse[0], left * diffuse[1], left * diffuse[2], diffuse[3]};
    return p;
}

// What KHR_materials_unlit shows is the base colour, whatever light falls on it: a black surface that emits
// it. As all emission it lights what is around.
json unlit(GltfImport& import, const JsonAt& material, MaterialDescription& description) {
    json p = {{"metallic", 0}, {"roughness", 1}, {"specular", 0}, {"alpha_mode", alpha_mode(material)}};
    p["alpha_cutoff"] = number(material, "alphaCutoff", 0.5, 0, max_coordinate);
    std::vector<double> color = {1, 1, 1, 1};
    json texture;
    if (std::optional<JsonAt> metal = find_object(material, "pbrMetallicRoughness")) {
        color = numbers(*metal, "baseColorFactor", color, 0, 1);
        if (std::optional<JsonAt> info = find_object(*metal, "baseColorTexture"))
            texture = read_texture_info(import, *info);
    }
    p["base_color"] = {0, 0, 0, color[3]};
    if (!texture.is_null()) p["base_color_texture"] = texture;  // its alpha
    EmissionDescription emission;
    emission.value = {color[0], color[1], color[2]};
    emission.texture = texture;
    emission.where = material.pointer;
    if (color[0] + color[1] + color[2] > 0)
        description.emission = emission;
    else
        description.emission.reset();
    return p;
}

}  // namespace etendue
