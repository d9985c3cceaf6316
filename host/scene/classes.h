// The classes of scene objects: read from shaders/registry.h and from class files, never declared in C++.
//
// A class's record is a struct in its GLSL file. Names, types and offsets of the members come from reflecting
// the compiled struct; default, range, unit and meaning of a parameter from the comment behind its member:
//
//     float alpha;  //: 0 in [0, 1] UNIT. Description.
//     uint kind;    //: "one" of one|other. Description.
//
// Members without `//:` are filled by the host. The comment at the head of the file says what the class is;
// behind a line "Example:" it may have one, part of a scene file (scenes/FORMAT.md), indented.
#pragma once
#include <array>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "host/gpu/reflection.h"
#include "host/gpu/shader_source.h"

namespace etendue {

enum class Interface { geometry, light, receiver, surface, medium, phase };

struct InterfaceInfo {
    Interface interface;
    const char* name;      // as scene files spell it
    const char* folder;    // under shaders/
    const char* contract;  // file with the interface's dispatch
    const char* table;     // macro of registry.h
    const char* buffer;    // storage buffer of the records
};
const std::array<InterfaceInfo, 6>& all_interfaces();
const InterfaceInfo& interface_info(Interface interface);

struct Parameter {
    MemberLayout member;
    bool from_scene = false;  // has a `//:` comment
    bool required = false;
    nlohmann::json default_value;  // null = absent
    double lo = -std::numeric_limits<double>::infinity(), hi = std::numeric_limits<double>::infinity();
    bool lo_open = true, hi_open = true;
    std::vector<std::string> choices;  // a word of these, kept as its number
    std::string unit, text;

    bool in_range(double value) const;
    std::string range() const;          // "[0, 1]", "one|other"; empty where there is none
    std::string shown_default() const;  // "required", "none" or a JSON value
};

struct ClassInfo {
    Interface interface = Interface::surface;
    uint32_t tag = 0;
    std::string record, name, file;  // struct, class, GLSL file
    std::string prefix;              // of its functions: the name, or "INTERFACE_name" (shaders/registry.h)
    std::string summary;             // the comment at the head of the file, without the example
    std::string example;             // as it stands there, JSON; may be empty
    bool says_polarization = false;  // NAME_mueller is there, of a light NAME_emitted_stokes
    bool never_emits = false;        // a geometry that no light is sampled on
    bool says_coverage = false;      // NAME_coverage is there
    bool is_crystal = false;         // NAME_crystal is there: it refracts doubly
    bool has_aperture = false, has_receptor = false, has_pupil = false, is_far = false, records_rays = false,
         on_surface = false;           // of receivers (interfaces/receiver.glsl)
    std::string pixel_unit;            // of receivers that measure; empty = a camera
    bool polarizes = false;            // NAME_POLARIZES: scenes with the class carry polarization
    bool disperses = false;            // NAME_DISPERSES: directions depend on the wavelength
    bool has_body_mueller = false;     // light leaves its body (shaders/features/body_mueller.glsl)
    bool has_general_mueller = false;  // its matrices are not of two blocks (shaders/lib/stokes.glsl)
    // Filled by reflection, at first use:
    uint32_t stride = 0;  // bytes of a record
    std::vector<Parameter> parameters;
};

// Reads registry.h at once and class files when they are asked for.
class ClassRegistry {
  public:
    // `cache_folder`: of compiled shaders; empty = none.
    explicit ClassRegistry(ShaderSources sources, std::filesystem::path cache_folder = {});

    // Adds a class from a file outside the registry: class name = file stem, record = its struct named in
    // CamelCase of the stem. Fails with the file's name where the file or the struct is missing, or the name
    // is taken.
    void add_class_file(Interface interface, const std::filesystem::path& file);

    const std::vector<ClassInfo>& classes(
        Interface interface) const;  // in order of tags, perhaps not reflected yet
    // Reflected; null where there is no such class.
    const ClassInfo* find(Interface interface, const std::string& name);

    // The first sentence of the interface's contract.
    std::string summary(Interface interface) const;

    // Layout of any struct that shader file `file` declares.
    std::vector<MemberLayout> reflect_struct(const std::string& file, const std::string& name,
                                             uint32_t& stride) const;

    const ShaderSources& sources() const { return sources_; }

  private:
    void reflect(ClassInfo& info) const;
    ShaderSources sources_;
    std::filesystem::path cache_folder_;
    std::map<Interface, std::vector<ClassInfo>> classes_;
};

// The first sentence of a comment, on one line. ("al. 2007" ends none.)
std::string first_sentence(const std::string& comment);

// Text of "generated/NAME_classes.glsl" for the given classes: the dispatch table, the class files, their
// buffers, and for each class a function NAME_record(index). `constants` gives, by class, what is the same in
// all its records, so that the compiler drops what that switches off.
struct ClassConstants {
    std::string statements;  // set members of a record `r`
    std::string macros;      // ABSENT_NAME_MEMBER of every number that is 0
};
std::string class_header(const InterfaceInfo& interface, const std::vector<const ClassInfo*>& classes,
                         const std::map<std::string, ClassConstants>& constants = {});

}  // namespace etendue
