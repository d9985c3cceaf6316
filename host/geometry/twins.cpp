#include "host/geometry/twins.h"

#include <algorithm>
#include <cstring>
#include <numeric>
#include <utility>

#include "host/scene/records.h"

namespace etendue {
namespace {

// Of the corners in whichever order.
uint64_t corner_key(const PrimitiveRecord& p) {
    uint64_t key = 0;
    for (const glm::vec3& v : {p.v0, p.v1, p.v2}) {
        uint64_t corner = 0x9E3779B97F4A7C15u;
        for (int i = 0; i < 3; ++i) {
            const float x = v[i] + 0.0f;  // -0 is 0
            uint32_t bits;
            std::memcpy(&bits, &x, 4);
            corner = (corner ^ bits) * 0xBF58476D1CE4E5B9u;
            corner ^= corner >> 29;
        }
        key += corner;
    }
    return key;
}

bool face_apart(const PrimitiveRecord& a, const PrimitiveRecord& b) {
    return (a.v0 == b.v0 && a.v1 == b.v2 && a.v2 == b.v1) || (a.v0 == b.v1 && a.v1 == b.v0 && a.v2 == b.v2) ||
           (a.v0 == b.v2 && a.v1 == b.v1 && a.v2 == b.v0);
}

}  // namespace

std::vector<uint32_t> find_twins(std::span<const PrimitiveRecord> primitives,
                                 std::span<const MaterialDescription> materials) {
    std::vector<uint32_t> twins(primitives.size(), no_record);
    std::vector<bool> is_sheet;
    for (const MaterialDescription& m : materials)
        is_sheet.push_back(!m.double_sided && m.inside.empty() && m.outside.empty() && m.priority == 0);
    std::vector<std::pair<uint64_t, uint32_t>> keys;
    for (uint32_t i = 0; i < primitives.size(); ++i)
        if (primitive_kind(primitives[i]) == PrimitiveKind::triangle && is_sheet[primitives[i].material])
            keys.push_back({corner_key(primitives[i]), i});
    std::sort(keys.begin(), keys.end());
    for (size_t i = 0; i < keys.size(); ++i)
        for (size_t j = i + 1; j < keys.size() && keys[j].first == keys[i].first; ++j) {
            const uint32_t a = keys[i].second, b = keys[j].second;
            if (twins[a] != no_record) break;
            if (twins[b] == no_record && face_apart(primitives[a], primitives[b])) twins[a] = b, twins[b] = a;
        }
    return twins;
}

void turn_to(const PrimitiveRecord& p, PrimitiveRecord& twin, glm::uvec3* indices) {
    while (twin.v0 != p.v0) {
        const glm::vec3 v = twin.v0;
        twin.v0 = twin.v1, twin.v1 = twin.v2, twin.v2 = v;
        if (indices) *indices = {indices->y, indices->z, indices->x};
    }
}

}  // namespace etendue
