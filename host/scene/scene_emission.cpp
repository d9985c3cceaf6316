// Lights that textures or alpha make brighter in some parts than in others: maps of that, for sampling.
#include <algorithm>

#include "host/scene/scene_compiler.h"
#include "host/spectra/color.h"

namespace etendue {

// Textures that say how bright a material's surface is: of its emission, and of the surface where part of it
// may not be there.
std::vector<uint32_t> SceneCompiler::emission_textures(uint32_t material) {
    std::vector<uint32_t> textures;
    if (materials_[material].emission_texture != no_record)
        textures.push_back(materials_[material].emission_texture);
    const ObjectDescription& surface = in_.materials[material].surface;
    const ClassInfo& info = find_class(Interface::surface, surface);
    if (!info.says_coverage || (materials_[material].flags & opaque)) return textures;
    for (const Parameter& p : info.parameters) {
        const auto value = surface.parameters.find(p.member.name);
        if (p.member.type == "TextureRef" && value != surface.parameters.end() && value->is_object())
            textures.push_back(resolver_.texture(*value, p.unit != "data", surface.where));
    }
    return textures;
}

// Longest edge of a triangle in texels of the finest texture.
double SceneCompiler::texel_edge(const PrimitiveRecord& p, const std::vector<uint32_t>& textures) const {
    if (primitive_kind(p) != PrimitiveKind::triangle) return -1;
    if (memory_.world.triangle_indices.empty()) return 0;
    const glm::uvec3 t = memory_.world.triangle_indices[p.attributes & 0x3FFFFFFFu];
    double longest = 0;
    for (uint32_t index : textures) {
        const TextureUse& use = textures_[index];
        const glm::vec2 size(in_.images[use.image].width, in_.images[use.image].height);
        glm::vec2 corners[3];
        for (int i = 0; i < 3; ++i) {
            const VertexRecord& v = memory_.world.vertices[t[i]];
            const glm::vec2 uv = use.uv_set == 0 ? v.uv0 : v.uv1;
            corners[i] = size * glm::vec2(glm::dot({use.uv_matrix.x, use.uv_matrix.y}, uv),
                                          glm::dot({use.uv_matrix.z, use.uv_matrix.w}, uv));
        }
        for (int i = 0; i < 3; ++i)
            longest = std::max(longest, double(glm::distance(corners[i], corners[(i + 1) % 3])));
    }
    return longest;
}

bool SceneCompiler::emission_varies() {
    return out_.features.coverage ||
           std::any_of(area_primitives_.begin(), area_primitives_.end(), [&](uint32_t i) {
               return materials_[memory_.world.primitives[i].material].emission_texture != no_record;
           });
}

void SceneCompiler::map_emission() {
    if (!out_.features.emission_maps) return;
    uint64_t key = memory_.lit.key;
    const auto add = [&](const void* data, size_t size) {
        key = hash_text({static_cast<const char*>(data), size}, key);
    };
    for (const MaterialRecord& m : materials_) add(&m.emission.rgb, 12), add(&m.emission_texture, 4);
    if (out_.features.coverage)
        add(records_[Interface::surface].bytes().data(), records_[Interface::surface].bytes().size());
    if (key != memory_.emission.key || textures_ != memory_.emission.textures) {
        std::vector<EmissionRequest> requests;
        std::map<uint32_t, std::vector<uint32_t>> textures;
        for (uint32_t i : area_primitives_) {
            const PrimitiveRecord& p = memory_.world.primitives[i];
            if (!textures.count(p.material)) textures[p.material] = emission_textures(p.material);
            const double area = 0.5 * glm::length(glm::cross(p.v1 - p.v0, p.v2 - p.v0));
            requests.push_back({i, texel_edge(p, textures[p.material]),
                                area * luminance(glm::dvec3(materials_[p.material].emission.rgb))});
        }
        memory_.emission = {key, textures_, build_emission_maps(requests, [&](const auto& cells) {
                                const uint32_t count = uint32_t(cells.size());
                                const Buffer in = create_buffer(device_, cells, "EmissionCells");
                                const Buffer out(device_, count * sizeof(EmissionSample), "EmissionSamples");
                                run_once("kernels/measure_emission.comp", count,
                                         {{"EmissionCells", &in}, {"EmissionSamples", &out}},
                                         {{"count", count}});
                                return out.read_array<EmissionSample>(count);
                            })};
    }
    std::vector<EmissionRoot> roots(memory_.world.world_primitives);
    for (size_t i = 0; i < area_primitives_.size(); ++i)
        roots[area_primitives_[i]] = memory_.emission.maps.roots[i];
    upload("EmissionRoots", roots);
    upload("EmissionNodes", memory_.emission.maps.nodes);
}

// Of triangles that are dark in part, to where they are not: lights are chosen by where they are.
void SceneCompiler::shrink_to_lit(std::vector<LightBounds>& bounds) const {
    if (!out_.features.emission_maps) return;
    for (size_t i = 0; i < area_primitives_.size(); ++i) {
        const PrimitiveRecord& p = memory_.world.primitives[area_primitives_[i]];
        const EmissionMaps::Lit& lit = memory_.emission.maps.lit[i];
        if (primitive_kind(p) != PrimitiveKind::triangle || lit.lo.x > lit.hi.x) continue;
        Box box;
        for (float b1 : {lit.lo.x, lit.hi.x})
            for (float b2 : {lit.lo.y, lit.hi.y}) box.grow(p.v0 + b1 * (p.v1 - p.v0) + b2 * (p.v2 - p.v0));
        LightBounds& b = bounds[first_area_light_ + i];
        b.lo = glm::max(b.lo, box.lo), b.hi = glm::min(b.hi, box.hi);
        b.lo = glm::min(b.lo, b.hi);
    }
}

}  // namespace etendue
