#include "host/scene/classes.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <regex>
#include <sstream>
#include <utility>

#include "host/error.h"
#include "host/scene/features.h"

namespace etendue {
namespace {

// "rough_glass" -> "RoughGlass"
std::string camel_case(const std::string& name) {
    std::string result;
    bool upper = true;
    for (char c : name) {
        if (c == '_' || c == '-')
            upper = true;
        else
            result += upper ? char(std::toupper(c)) : c, upper = false;
    }
    return result;
}

std::string trim(std::string text) {
    const auto blank = [](unsigned char c) { return std::isspace(c); };
    while (!text.empty() && blank(text.back())) text.pop_back();
    text.erase(text.begin(), std::find_if_not(text.begin(), text.end(), blank));
    return text;
}

// The comment lines at the head of a file, without the slashes, up to a line "Example:" and behind it.
struct HeadComment {
    std::string summary, example;
};

HeadComment head_comment(const std::string& text) {
    const auto without_indent = [](const std::string& line, size_t most) {
        return line.substr(std::min({line.find_first_not_of(' ', 2), most, line.size()})) + "\n";
    };
    HeadComment result;
    std::istringstream lines(text);
    bool in_example = false;
    for (std::string line; std::getline(lines, line) && line.rfind("//", 0) == 0;) {
        if (trim(line.substr(2)) == "Example:")
            in_example = true;
        else if (in_example)
            result.example += without_indent(line, 7);  // "//     "
        else
            result.summary += without_indent(line, 3);
    }
    return {trim(result.summary), trim(result.example)};
}

void read_class(const std::string& text, ClassInfo& info) {
    HeadComment head = head_comment(text);
    info.summary = std::move(head.summary), info.example = std::move(head.example);
    info.says_polarization = text.find(info.prefix + "_mueller(") != std::string::npos ||
                             text.find(info.prefix + "_emitted_stokes(") != std::string::npos;
    info.says_coverage = text.find(info.prefix + "_coverage(") != std::string::npos;
    info.is_crystal = text.find(info.prefix + "_crystal(") != std::string::npos;
    info.has_aperture = text.find("#define " + info.prefix + "_HAS_APERTURE") != std::string::npos;
    info.never_emits = text.find("#define " + info.prefix + "_NEVER_EMITS") != std::string::npos;
    info.records_rays = text.find("#define " + info.prefix + "_RECORDS_RAYS") != std::string::npos;
    info.on_surface = text.find(info.prefix + "_at_surface(") != std::string::npos;
    info.has_receptor = text.find(info.prefix + "_receptor(") != std::string::npos;
    info.has_pupil = text.find(info.prefix + "_pupil(") != std::string::npos;
    info.is_far = text.find(info.prefix + "_far(") != std::string::npos;
    std::smatch unit;
    if (std::regex_search(info.summary, unit, std::regex(R"(A pixel: (\S+)\.)"))) info.pixel_unit = unit[1];
    info.has_general_mueller = text.find("is_general") != std::string::npos;
    info.has_body_mueller = text.find("set_body(") != std::string::npos;
    info.disperses = std::regex_search(text, std::regex(R"(#define \w+_DISPERSES\b)"));
    info.polarizes = std::regex_search(text, std::regex(R"(#define \w+_POLARIZES\b)"));
}

double range_end(const std::string& text) {
    if (text == "inf") return std::numeric_limits<double>::infinity();
    if (text == "-inf") return -std::numeric_limits<double>::infinity();
    return std::stod(text);
}

// DEFAULT [in RANGE] [UNIT]. Description. Or DEFAULT of WORD|WORD… . Description.
void parse_annotation(const std::string& annotation, Parameter& p, const std::string& file) {
    static const std::regex form(
        R"(^(\[[^\]]*\]|\S+?)(?:\s+in\s+([\[(])\s*([^,\s]+)\s*,\s*([^\])\s]+)\s*([\])]))?(?:\s+(\S[^.]*?))?\.(?:\s+(.*))?$)");
    std::smatch match;
    if (!std::regex_match(annotation, match, form))
        fail_input(
            "{}: the comment of member {} reads '{}'; expected '//: DEFAULT [in RANGE] [UNIT]. Description.'",
            file, p.member.name, annotation);
    p.from_scene = true;
    const std::string value = match[1];
    if (value == "required")
        p.required = true;
    else if (value != "none") {
        p.default_value = nlohmann::json::parse(value, nullptr, false);
        if (p.default_value.is_discarded())
            fail_input("{}: default '{}' of member {} is not a JSON value", file, value, p.member.name);
    }
    if (match[2].matched) {
        p.lo_open = match[2] == "(", p.hi_open = match[5] == ")";
        p.lo = range_end(match[3]), p.hi = range_end(match[4]);
    }
    p.unit = trim(match[6]);
    if (p.unit.rfind("of ", 0) == 0) {
        std::istringstream words(std::exchange(p.unit, "").substr(3));
        for (std::string word; std::getline(words, word, '|');) p.choices.push_back(word);
    }
    p.text = trim(match[7]);
}

// A shader that uses a struct in a buffer, so that its layout can be read from the SPIR-V.
ShaderLayout compile_layout(ShaderSources sources, const std::string& includes, const std::string& record,
                            const std::filesystem::path& cache_folder) {
    for (const InterfaceInfo& interface : all_interfaces()) {
        auto& header = sources.generated[fmt::format("generated/{}_classes.glsl", interface.name)];
        if (header.empty()) header = class_header(interface, {});
    }
    sources.generated["reflect_record.comp"] = fmt::format(
        "{}layout(scalar, set = 0, binding = 0) buffer Reflected {{ {} reflected[]; }};\n"
        "void main() {{ reflected[0] = reflected[1]; }}\n",
        includes, record);
    CompileOptions options;
    options.defines = Features::everything().defines();
    options.optimize = false;
    options.cache_folder = cache_folder;
    return reflect_shader(compile_shader(sources, "reflect_record.comp", options).spirv);
}

// Records start at multiples of it, so that drivers can read whole vectors.
constexpr uint32_t record_alignment = 16;

const BlockLayout& reflected_block(const ShaderLayout& layout) {
    for (const BlockLayout& block : layout.blocks)
        if (block.name == "Reflected") return block;
    fail_input("a record could not be reflected");
}

}  // namespace

const std::array<InterfaceInfo, 6>& all_interfaces() {
    static const std::array<InterfaceInfo, 6> table = {{
        {Interface::geometry, "geometry", "geometry", "interfaces/geometry.glsl", "GEOMETRY_CLASSES",
         "GeometryRecords"},
        {Interface::light, "light", "lights", "interfaces/light_source.glsl", "LIGHT_CLASSES",
         "LightRecords"},
        {Interface::receiver, "receiver", "receivers", "interfaces/receiver.glsl", "RECEIVER_CLASSES",
         "ReceiverRecords"},
        {Interface::surface, "surface", "surfaces", "interfaces/surface_optics.glsl", "SURFACE_CLASSES",
         "SurfaceRecords"},
        {Interface::medium, "medium", "media", "interfaces/medium_optics.glsl", "MEDIUM_CLASSES",
         "MediumRecords"},
        {Interface::phase, "phase", "phases", "interfaces/phase_function.glsl", "PHASE_CLASSES",
         "PhaseRecords"},
    }};
    return table;
}

const InterfaceInfo& interface_info(Interface interface) { return all_interfaces()[size_t(interface)]; }

bool Parameter::in_range(double value) const {
    if (std::isnan(value)) return false;
    return (lo_open ? value > lo : value >= lo) && (hi_open ? value < hi : value <= hi);
}

std::string Parameter::range() const {
    if (!choices.empty()) {
        std::string words;
        for (const std::string& word : choices) words += (words.empty() ? "" : "|") + word;
        return words;
    }
    if (std::isinf(lo) && std::isinf(hi)) return "";
    return fmt::format("{}{}, {}{}", lo_open ? '(' : '[', lo, hi, hi_open ? ')' : ']');
}

std::string Parameter::shown_default() const {
    if (required) return "required";
    return default_value.is_null() ? "none" : default_value.dump();
}

ClassRegistry::ClassRegistry(ShaderSources sources, std::filesystem::path cache_folder)
    : sources_(std::move(sources)), cache_folder_(std::move(cache_folder)) {
    if (!sources_.folder.empty() && !std::filesystem::exists(sources_.folder / "registry.h"))
        fail_input("{}: not a folder of shaders: it has no registry.h", sources_.folder.string());
    const std::string text = sources_.get("registry.h");
    static const std::regex row(R"(X\(\s*(\d+)\s*,\s*(\w+)\s*,\s*(\w+)\s*\))");
    for (const InterfaceInfo& interface : all_interfaces()) {
        size_t begin = text.find(fmt::format("#define {}(X)", interface.table));
        if (begin == std::string::npos) fail_input("registry.h: table {} is missing", interface.table);
        begin = text.find(')', begin) + 1;  // behind "(X)"
        size_t end = begin;                 // the table ends with the first line that is not continued
        do end = text.find('\n', end + 1);
        while (end != std::string::npos && text[end - 1] == '\\');
        const std::string table = text.substr(begin, end - begin);
        auto& classes = classes_[interface.interface];
        for (std::sregex_iterator i(table.begin(), table.end(), row), none; i != none; ++i) {
            ClassInfo info;
            info.interface = interface.interface;
            info.tag = uint32_t(std::stoul((*i)[1]));
            info.record = (*i)[2];
            info.name = info.prefix = (*i)[3];
            if (const std::string common = std::string(interface.name) + "_"; info.name.rfind(common, 0) == 0)
                info.name.erase(0, common.size());
            info.file = fmt::format("{}/{}.glsl", interface.folder, info.name);
            if (auto source = sources_.find(info.file)) read_class(*source, info);
            classes.push_back(std::move(info));
        }
    }
}

void ClassRegistry::add_class_file(Interface interface, const std::filesystem::path& file) {
    ClassInfo info;
    info.interface = interface;
    info.name = info.prefix = file.stem().string();
    info.record = camel_case(info.name);
    info.file = file.string();
    auto& classes = classes_[interface];
    info.tag = 128;
    for (const ClassInfo& other : classes) {
        if (other.name == info.name)
            fail_input("{}: there is already a {} class called {}", info.file, interface_info(interface).name,
                       info.name);
        info.tag = std::max(info.tag, other.tag + 1);
    }
    std::ifstream stream(file, std::ios::binary);
    if (!stream) fail_input("{}: cannot read the class file", info.file);
    const std::string text = (std::ostringstream() << stream.rdbuf()).str();
    if (!std::regex_search(text, std::regex(fmt::format(R"(struct\s+{}\b)", info.record))))
        fail_input("{}: a class file declares its record; struct {} is missing", info.file, info.record);
    read_class(text, info);
    sources_.generated[info.file] = text;
    classes.push_back(std::move(info));
}

const std::vector<ClassInfo>& ClassRegistry::classes(Interface interface) const {
    return classes_.at(interface);
}

const ClassInfo* ClassRegistry::find(Interface interface, const std::string& name) {
    for (ClassInfo& info : classes_.at(interface))
        if (info.name == name) {
            if (info.stride == 0) reflect(info);
            return &info;
        }
    return nullptr;
}

std::string ClassRegistry::summary(Interface interface) const {
    return first_sentence(head_comment(sources_.get(interface_info(interface).contract)).summary);
}

std::vector<MemberLayout> ClassRegistry::reflect_struct(const std::string& file, const std::string& name,
                                                        uint32_t& stride) const {
    const ShaderLayout layout =
        compile_layout(sources_, fmt::format("#include \"{}\"\n", file), name, cache_folder_);
    stride = reflected_block(layout).stride;
    return reflected_block(layout).element_members;
}

void ClassRegistry::reflect(ClassInfo& info) const {
    const InterfaceInfo& interface = interface_info(info.interface);
    ShaderSources sources = sources_;
    sources.generated[fmt::format("generated/{}_classes.glsl", interface.name)] =
        class_header(interface, {&info});
    const ShaderLayout layout = compile_layout(
        std::move(sources), fmt::format("#include \"{}\"\n", interface.contract), info.record, cache_folder_);
    const BlockLayout& block = reflected_block(layout);
    info.stride = (block.stride + record_alignment - 1) / record_alignment * record_alignment;

    // The annotations stand behind the members of the struct, one member a line.
    const std::string text = sources_.get(info.file);
    std::map<std::string, std::string> annotations;
    std::smatch start;
    if (std::regex_search(text, start, std::regex(fmt::format(R"(struct\s+{}\s*\{{)", info.record)))) {
        std::istringstream lines(start.suffix().str());
        static const std::regex member(R"(^\s*\w+\s+(\w+)\s*;\s*//:\s*(.*?)\s*$)");
        for (std::string line; std::getline(lines, line) && trim(line).rfind("};", 0) != 0;)
            if (std::smatch match; std::regex_match(line, match, member)) annotations[match[1]] = match[2];
    }
    for (const MemberLayout& member : block.element_members) {
        Parameter parameter;
        parameter.member = member;
        if (auto found = annotations.find(member.name); found != annotations.end())
            parse_annotation(found->second, parameter, info.file);
        info.parameters.push_back(std::move(parameter));
    }
}

std::string first_sentence(const std::string& comment) {
    std::string text = comment.substr(0, comment.find("\n\n"));
    std::replace(text.begin(), text.end(), '\n', ' ');
    for (size_t end = 0; (end = text.find(". ", end)) != std::string::npos; ++end)
        if (std::isupper(static_cast<unsigned char>(text[end + 2]))) return text.substr(0, end + 1);
    return text;
}

std::string class_header(const InterfaceInfo& interface, const std::vector<const ClassInfo*>& classes,
                         const std::map<std::string, ClassConstants>& constants) {
    // A kernel for one class of surfaces sets ONLY_SURFACE_CLASS to its tag: the dispatch then has one case.
    // MET_SURFACE_CLASSES are those between whose directions it evaluates: all where vertices are connected.
    // COVERED_SURFACE_CLASSES are those of which a part may not be there.
    std::string rows, one, covered;
    for (const ClassInfo* info : classes) {
        const std::string row = fmt::format(" X({}u, {}, {})", info->tag, info->record, info->prefix);
        one += fmt::format("#if ONLY_SURFACE_CLASS == {}\n#define {}(X){}\n#endif\n", info->tag,
                           interface.table, row);
        rows += row;
        if (info->says_coverage) covered += row;
    }
    std::string text = fmt::format("#define {}(X){}\n", interface.table, rows);
    if (interface.interface == Interface::surface)
        text = fmt::format(
            "#ifdef ONLY_SURFACE_CLASS\n{}#else\n{}#endif\n"
            "#if CONNECT_VERTICES\n#define MET_{}(X){}\n#else\n#define MET_{} {}\n#endif\n"
            "#define COVERED_{}(X){}\n",
            one, text, interface.table, rows, interface.table, interface.table, interface.table, covered);
    for (const ClassInfo* info : classes) {
        const auto known = constants.find(info->name);
        if (known != constants.end()) text += known->second.macros;
        text += fmt::format("#define TAG_{} {}\n#include \"{}\"\n", info->prefix, info->tag, info->file);
        if (interface.interface == Interface::surface && !info->says_polarization)
            text += fmt::format("#define {}_mueller(r, c, from, to, event) unsaid_mueller(to, event)\n",
                                info->prefix);
        if (interface.interface == Interface::light && !info->says_polarization)
            text += fmt::format("#define {}_emitted_stokes(r, u_position, u_direction) no_light_stokes()\n",
                                info->prefix);
        if (interface.interface == Interface::receiver) {
            text += fmt::format("#define {0}_HAS_RECEPTOR {1:d}\n#define {0}_IS_FAR {2:d}\n", info->prefix,
                                info->has_receptor, info->is_far);
            text += fmt::format("#define {}_ON_SURFACE {:d}\n", info->prefix, info->on_surface);
            if (!info->on_surface)
                text += fmt::format(
                    "#define {0}_at_surface(r, primitive, point, front, leaves) no_receiver_sample()\n"
                    "#define {0}_face(r, film, front) 0u\n",
                    info->prefix);
            if (!info->records_rays) text += fmt::format("#define {}_RECORDS_RAYS 0\n", info->prefix);
            if (!info->has_receptor)
                text += fmt::format("#define {}_receptor(r, origin, direction) no_receptor_hit()\n",
                                    info->prefix);
            if (!info->has_pupil) text += fmt::format("#define {}_pupil(r) vec4(0)\n", info->prefix);
            if (!info->is_far)
                text += fmt::format("#define {}_far(r, direction, film_aspect) no_receiver_sample()\n",
                                    info->prefix);
        }
        if (interface.interface == Interface::medium && !info->is_crystal)
            text += fmt::format("#define {}_crystal(r) isotropic_medium(1.0)\n", info->prefix);
        if (interface.interface == Interface::phase && !info->says_polarization)
            text += fmt::format("#define {}_mueller(r, cosine) depolarizing()\n", info->prefix);
        // All classes of an interface are views of one buffer, on one binding.
        const MemberLayout* last = info->parameters.empty() ? nullptr : &info->parameters.back().member;
        const uint32_t padding = last ? (info->stride - last->offset - last->size) / 4 : 0;
        text += fmt::format("struct {0}Row {{ {0} record;{1} }};\n", info->record,
                            padding ? fmt::format(" uint padding[{}];", padding) : "");
        text += fmt::format(
            "layout(scalar, set = 0, binding = {}) readonly buffer {}__{} {{ {}Row {}_records[]; }};\n",
            int(interface.interface), interface.buffer, info->prefix, info->record, info->prefix);
        text +=
            fmt::format("{0} {1}_record(uint index) {{ {0} r = {1}_records[index].record; {2}return r; }}\n",
                        info->record, info->prefix, known == constants.end() ? "" : known->second.statements);
    }
    return text;
}

}  // namespace etendue
