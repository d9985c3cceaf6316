// What each command can be told. The command line (cli/cli.h) fills these in.
#pragma once
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "host/preview/view_transform.h"
#include "host/render/modes.h"
#include "host/scene/path_modes.h"

namespace etendue {

struct ImageSize {
    uint32_t width = 0, height = 0;
};

// What render, measure, inspect and bench open.
struct SceneChoice {
    std::filesystem::path scene;
    std::filesystem::path environment;  // image that takes the place of the scene's environment; may be empty
    std::filesystem::path shaders;      // empty = those in the binary
    std::string variant;                // of the scene's materials; empty = none
    std::optional<double> at;           // seconds: the moment of the scene's animations; none = as it stands
    bool allow_class_files = false;     // code that the scene brings along may run
    std::string receiver;               // name; render: names, or "all"; empty = the first of the scene
    std::string device;                 // name, part of one, or index; empty = the best there is
    ColorMode color = ColorMode::automatic;
    PolarizationMode polarization = PolarizationMode::automatic;
    uint32_t spectral_bins = 0;  // of the image, besides its colours; 0 = none
    SampleSequence samples = SampleSequence::sobol;
    std::string layers;  // of light: "lamps", "none", a file of them or JSON; empty = those of the scene
    std::optional<ImageSize> size;  // else 512 rows, and columns by the camera's aspect ratio
};

struct RenderOptions : SceneChoice {
    std::filesystem::path output;    // default_output(scene) where none was given; empty = none, of a part
    uint64_t first_pass = 0;         // of the run: others may make those before, and merge them
    std::optional<uint64_t> passes;  // exactly one of the three goals is set; 64 passes by default
    std::optional<double> seconds, error;
    Algorithm algorithm = Algorithm::automatic;
    std::optional<double> forward_paths;  // a pixel and pass, where a named algorithm has any; else 1
    Schedule schedule = Schedule::automatic;
    uint64_t vertex_bytes = uint64_t(256) << 20;  // for vertices of forward paths
    uint64_t seed = 0;
    std::filesystem::path checkpoint, resume, stats;  // empty = none
    bool aovs = false, quiet = false;
    std::string command_line;  // as typed, for the image's attributes
};

struct MeasureOptions : SceneChoice {
    std::filesystem::path output;        // folder; empty = none, of a part
    std::vector<std::string> receivers;  // names; empty = all that measure
    uint64_t first_pass = 0;             // as for render; whole sixteens
    std::optional<uint64_t> passes;      // exactly one of the three goals is set
    std::optional<double> seconds, error;
    bool worst = false;  // `error` is that of the worst pixel, not of the mean
    Algorithm algorithm = Algorithm::automatic;
    std::optional<double> forward_paths;  // as for render
    uint64_t vertex_bytes = uint64_t(256) << 20;
    uint64_t seed = 0;
    std::vector<glm::dvec2> points;  // of meters, for uniformity, in parts of width and height; empty = none
    std::optional<double> glare_from;          // cd/m²: what is brighter counts for UGR
    std::filesystem::path checkpoint, resume;  // empty = none
    bool quiet = false;
    std::string command_line;
};

struct ViewOptions : SceneChoice {  // `size`: of the window, in pixels
    Algorithm algorithm = Algorithm::automatic;
    Schedule schedule = Schedule::automatic;
    uint64_t vertex_bytes = uint64_t(256) << 20;
    uint64_t seed = 0;
    std::optional<uint64_t> passes;     // after which the picture rests; none = never
    std::optional<double> exposure;     // powers of two; none = metered
    ToneCurve curve = ToneCurve::srgb;  // to begin with
    std::filesystem::path stats;        // empty = none
};

struct CompareOptions {
    std::filesystem::path image, reference;
    std::optional<double> max_relmse;
};

struct InspectOptions : SceneChoice {
    Algorithm algorithm = Algorithm::automatic;
    bool json = false;  // only what auto chooses, for programs to read
};

struct MergeOptions {
    std::vector<std::filesystem::path> parts;         // checkpoints of passes of one render
    std::filesystem::path output, checkpoint, stats;  // empty = none; image or checkpoint is set
    uint64_t first_pass = 0;
    std::optional<uint64_t> passes;  // that they are to make up, from the first; else up to their last
    bool partial = false;            // passes may be missing, and parts damaged
    bool aovs = false, quiet = false;
    std::string command_line;
};

struct BenchOptions : SceneChoice {             // `scene` is each of `scenes` in turn
    std::vector<std::filesystem::path> scenes;  // none: the page of `output` is drawn again
    std::filesystem::path output;               // folder
    std::filesystem::path reference;            // image; empty = one is rendered
    std::optional<double> reference_relmse;     // that the reference itself has; else by its error layer
    std::vector<Algorithm> algorithms;
    double seconds = 30;  // of rendering for each algorithm
    uint64_t vertex_bytes = uint64_t(256) << 20;
    uint64_t seed = 0;
    bool quiet = false;
};

struct RaysOptions : SceneChoice {
    std::filesystem::path output;  // .json, .csv or .glb
    uint32_t paths = 1000;
    bool backward = false;  // from the receiver, through pixels spread over its image; else from the lights
    std::vector<std::string> events, objects;  // only paths with such an event there; empty = any
    std::vector<std::string> without;          // no paths that come to one of these
    bool inside = false;                       // of optical elements, too
    uint64_t seed = 0;
};

struct LensOptions {
    std::filesystem::path lens;
    std::filesystem::path output;  // .svg or .csv; empty = none
    std::optional<double> object;  // mm before the first surface; none = what the file says
    uint32_t rays = 7;             // of each field across the pupil, in `output`
};

struct ClassesOptions {
    std::string name;               // empty = all
    std::filesystem::path html;     // page to write instead; empty = none
    std::filesystem::path shaders;  // empty = those in the binary
    std::string device;             // of the page's pictures, as for SceneChoice
    uint32_t passes = 128;          // of each of them
    bool quiet = false;
};

}  // namespace etendue
