// What the window knows and what its panels and keys change. The session is told once a frame.
#pragma once
#include <mutex>
#include <optional>
#include <string>

#include "host/preview/camera_control.h"
#include "host/preview/isolines.h"
#include "host/preview/metering.h"
#include "host/preview/pixel_probe.h"
#include "host/preview/session.h"
#include "host/preview/view_transform.h"
#include "host/render/path_record.h"

struct GLFWwindow;

namespace etendue {

// What tasks on the session's thread bring back. They may outlive the window.
struct TaskResults {
    std::mutex mutex;
    std::optional<std::string> notice, clipboard;
    std::optional<glm::dvec3> focus;  // point to turn around
    std::optional<PixelReading> reading;
    std::optional<std::vector<RecordedPath>> paths;
    // An edit, a reading, recorded paths, a scene read again: the task has ended, in whatever way.
    bool edited = false, read = false, traced = false, reloaded = false;
};

// An edit of an object of the scene: of a parameter, or of its class.
struct ObjectEdit {
    LiveObject object;
    std::string parameter;  // empty = the class
    nlohmann::json value;
};

// The ray viewer.
struct RayView {
    bool on = false;
    bool forward = true;
    bool by_power = false;     // colours: else by wavelength, or by what the path carries
    bool faint_behind = true;  // what lies behind surfaces
    int count = 200;           // paths that are traced, of which the filter keeps some
    PathFilter filter;
    std::vector<RecordedPath> paths;
    bool wanted = false;   // they are to be traced
    bool is_made = false;  // they are being traced
};

struct ViewState {
    ViewState(const ViewOptions& options, PreviewSession& session) : options(options), session(session) {}
    const ViewOptions& options;
    PreviewSession& session;
    GLFWwindow* window = nullptr;
    PreviewStatus status;
    std::shared_ptr<const PreviewPicture> picture;  // null = none yet
    PreviewRequest request;
    ViewSettings view;
    ToneCurve other_curve = ToneCurve::false_colors;  // of meters while a camera is shown, and the other way round
    bool shows_meter = false;
    bool fits_scale = true;  // the false colours' range follows the picture
    bool isolines = true;    // on what meters see
    ValueGrid values;        // of the picture, where false colours are shown
    CameraPose pose;
    bool moved = false;      // the camera stands elsewhere than in the scene
    double moved_at = -1e9;  // glfwGetTime
    bool panels = true, help = false;
    Metering metering;
    float content_scale = 1;  // of the display: pixels for one of a display of 96 dpi
    std::string notice;       // shown for some seconds
    double notice_at = -1e9;
    double pointer_x = 0, pointer_y = 0;  // pixels of the framebuffer
    // Seconds. Of the first picture, since the process started; and the longest, from then on: from one look
    // at events to the next, and, while the view moves, from frame to frame and from picture to picture.
    double first_shown = 0, longest_frame = 0, longest_between_frames = 0, longest_between_pictures = 0;
    // As the panel shows them: those of the scene, with what is being edited.
    std::vector<LiveObject> objects;
    std::shared_ptr<const std::vector<LiveObject>> objects_from;
    std::optional<ObjectEdit> edit;  // that waits for the one before it
    bool edit_is_made = false;       // one is at work
    // How the scene file is to be read: as its panel shows it, and whether one is at work.
    ImportOptions import;
    bool reload_is_wanted = false, reload_is_made = false;
    std::optional<PixelReading> reading;
    glm::uvec2 reading_pixel{~0u};  // that was asked for last
    PreviewRequest reading_of;
    uint64_t reading_passes = 0;
    bool reading_is_made = false;
    RayView rays;
    std::shared_ptr<TaskResults> results = std::make_shared<TaskResults>();
};

// The receiver that is shown; null before there is a scene.
const PreviewReceiver* shown_receiver(const ViewState& state);

// How the picture at hand is shown: layers other than radiance have settings of their own.
ViewSettings shown_settings(const ViewState& state);

void note(ViewState& state, const std::string& notice);
void move_camera(ViewState& state, const CameraPose& pose);
void reset_camera(ViewState& state);
void choose_receiver(ViewState& state, uint32_t index);
void meter_exposure(ViewState& state);
void focus_at_pointer(ViewState& state);
void edit_object(ViewState& state, const ObjectEdit& edit);
void reload_scene(ViewState& state);  // as `import` says
void read_pixel_at_pointer(ViewState& state);
void trace_paths(ViewState& state);  // for the ray viewer
void copy_camera(ViewState& state);  // to the clipboard, as glTF
void save_image(ViewState& state);   // EXR and (sRGB, with the exposure) PNG, in the current folder
// Writes the last picture as EXR into the current folder, without the renderer; its name, or nothing where
// there is none or it cannot be written.
std::string rescue_picture(const ViewState& state);
// Takes over what the session and its tasks have brought since the last frame.
// True: there was any.
bool receive_news(ViewState& state);

}  // namespace etendue
