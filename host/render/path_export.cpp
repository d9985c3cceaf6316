#include "host/render/path_export.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "host/error.h"
#include "host/image/atomic_file.h"

namespace etendue {
namespace {

using nlohmann::json;

json array(const glm::vec4& v) { return {v.x, v.y, v.z, v.w}; }
json array(const glm::vec3& v) { return {v.x, v.y, v.z}; }

std::string as_json(const std::vector<RecordedPath>& paths) {
    json list = json::array();
    for (const RecordedPath& path : paths) {
        json vertices = json::array();
        for (const PathVertex& v : path.vertices) {
            vertices.push_back({{"event", event_name(v.event)},
                                {"object", v.object},
                                {"position", {v.position.x, v.position.y, v.position.z}},
                                {"arriving", v.arriving},
                                {"leaving", v.leaving},
                                {"throughput", array(v.throughput)}});
            if (!v.shape.empty()) vertices.back()["shape"] = v.shape;
            if (v.polarization)
                vertices.back()["polarization"] = {{"stokes", array(v.polarization->stokes)},
                                                   {"x", array(v.polarization->axis)}};
            if (v.smooth) vertices.back()["smooth"] = true;
            if (v.roulette) vertices.back()["ended_by_roulette"] = true;
        }
        list.push_back({{"pass", path.pass}, {"index", path.index}, {"vertices", std::move(vertices)}});
        if (path.wavelengths.x > 0) list.back()["wavelengths"] = array(path.wavelengths);
        if (path.is_cut) list.back()["cut"] = true;
    }
    const bool forward = !paths.empty() && paths[0].forward;
    const json document = {{"generator", "etendue " ETENDUE_VERSION},
                           {"direction", forward ? "forward" : "backward"},
                           {"unit", forward ? "lm" : "share of the pixel"},
                           {"paths", std::move(list)}};
    return document.dump(1) + "\n";
}

// Quoted as RFC 4180 has it.
std::string quoted(const std::string& text) {
    std::string result = "\"";
    for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
    return result + "\"";
}

std::string as_csv(const std::vector<RecordedPath>& paths) {
    std::string text = "path,vertex,event,object,shape,x,y,z,arriving,leaving,wavelength,s1,s2,s3\n";
    for (size_t p = 0; p < paths.size(); ++p)
        for (size_t i = 0; i < paths[p].vertices.size(); ++i) {
            const PathVertex& v = paths[p].vertices[i];
            const double nm = wavelength_at(paths[p], v);
            std::string stokes = ",,";
            if (v.polarization) {
                const glm::vec3& s = v.polarization->stokes;
                stokes = fmt::format("{:.6g},{:.6g},{:.6g}", s.x, s.y, s.z);
            }
            text += fmt::format("{},{},{},{},{},{:.9g},{:.9g},{:.9g},{:.7g},{:.7g},{},{}\n", p, i,
                                event_name(v.event), quoted(v.object), quoted(v.shape), v.position.x,
                                v.position.y, v.position.z, v.arriving, v.leaving,
                                nm > 0 ? fmt::format("{:.7g}", nm) : "", stokes);
        }
    return text;
}

// glTF 2.0: a mesh of lines with a colour at each of their ends.
std::string as_glb(const std::vector<RecordedPath>& paths) {
    std::vector<glm::vec3> positions, colors;
    glm::vec3 lo(INFINITY), hi(-INFINITY);
    for (const RecordedPath& path : paths)
        for (size_t i = 1; i < path.vertices.size(); ++i)
            for (const size_t end : {i - 1, i}) {
                positions.push_back(glm::vec3(path.vertices[end].position));
                colors.push_back(line_color(path, path.vertices[i - 1]));
                lo = glm::min(lo, positions.back()), hi = glm::max(hi, positions.back());
            }
    if (positions.empty()) fail_input("no path is left to be written as lines");
    const size_t bytes = positions.size() * sizeof(glm::vec3);
    json document;
    document["asset"] = {{"version", "2.0"}, {"generator", "etendue " ETENDUE_VERSION}};
    document["extensionsUsed"] = json::array({"KHR_materials_unlit"});
    document["scene"] = 0;
    document["scenes"][0]["nodes"] = json::array({0});
    document["nodes"][0] = {{"name", "rays"}, {"mesh", 0}};
    document["materials"][0] = {{"name", "rays"}, {"extensions", {{"KHR_materials_unlit", json::object()}}}};
    document["meshes"][0]["primitives"][0] = {
        {"mode", 1}, {"material", 0}, {"attributes", {{"POSITION", 0}, {"COLOR_0", 1}}}};
    for (const size_t i : {0, 1}) {
        document["accessors"][i] = {
            {"bufferView", i}, {"componentType", 5126}, {"type", "VEC3"}, {"count", positions.size()}};
        document["bufferViews"][i] = {{"buffer", 0}, {"byteOffset", i * bytes}, {"byteLength", bytes}};
    }
    document["accessors"][0]["min"] = {lo.x, lo.y, lo.z};
    document["accessors"][0]["max"] = {hi.x, hi.y, hi.z};
    document["buffers"][0]["byteLength"] = 2 * bytes;
    std::string text = document.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::string file;
    const auto word = [&](uint32_t w) { file.append(reinterpret_cast<const char*>(&w), 4); };
    const uint64_t total = 12 + 8 + text.size() + 8 + 2 * bytes;
    if (total > UINT32_MAX) fail_input("the paths do not fit in one .glb file");
    word(0x46546C67), word(2), word(uint32_t(total));  // "glTF"
    word(uint32_t(text.size())), word(0x4E4F534A);     // "JSON"
    file += text;
    word(uint32_t(2 * bytes)), word(0x004E4942);  // "BIN"
    file.append(reinterpret_cast<const char*>(positions.data()), bytes);
    file.append(reinterpret_cast<const char*>(colors.data()), bytes);
    return file;
}

}  // namespace

void check_path_file(const std::filesystem::path& file) {
    const auto ending = file.extension();
    if (ending != ".json" && ending != ".csv" && ending != ".glb")
        fail_input("--output {}: paths are written as .json, .csv or .glb", file.string());
    check_writable(file);
}

void write_paths(const std::filesystem::path& file, const std::vector<RecordedPath>& paths) {
    const auto ending = file.extension();
    const std::string text = ending == ".json"  ? as_json(paths)
                             : ending == ".csv" ? as_csv(paths)
                                                : as_glb(paths);
    write_atomically(file, text);
}

}  // namespace etendue
