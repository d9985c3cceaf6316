// Answers requests for pictures, slice by slice: opens the scene, keeps a renderer of the window's size, and
// chooses how fine a picture is. Without threads; PreviewSession runs it on one.
//
// While the view moves, pictures are smaller by a whole number of pixels, so that they come quickly; at rest
// they are refined to full size, and then for as long as one looks.
#pragma once
#include <functional>
#include <thread>

#include "host/options.h"
#include "host/preview/background_pilot.h"
#include "host/preview/preview.h"
#include "host/preview/start_programs.h"
#include "host/preview/watched_files.h"

namespace etendue {

class PreviewWorker {
  public:
    // `interrupt` is asked within passes whether the picture at hand is still wanted. `changed`: status or
    // picture are new, and worth showing before the slice ends. `ask`: whether the class files of the scene
    // may run; waits for the answer.
    PreviewWorker(
        const ViewOptions& options, std::function<bool()> interrupt, std::function<void()> changed,
        std::function<bool(const std::string& question)> ask = [](auto&) { return false; });
    ~PreviewWorker();

    void open();  // device and scene; fails as `render` does
    // One slice of some hundredths of a second, but where kernels are compiled. False: nothing is left to do.
    bool work(const PreviewRequest& request);
    // Is there a film that a task could work on? Not before the first one, and not after one was given up.
    bool takes_tasks() const { return renderer_ && current_; }
    // Where none can be taken nothing happens. An Error becomes the message.
    void run_task(const std::function<void(PreviewScene&)>& task);
    // Loads the scene again where its files or shaders have changed. An Error becomes the message, and what
    // was there stays.
    bool reload_changed();

    // After DeviceLost: another device with the same scene, as it was edited, on which the film begins anew.
    // False: the last one was lost before it made a picture; another one will not do better.
    bool replace_device();

    const PreviewStatus& status() const { return status_; }
    const std::shared_ptr<const PreviewPicture>& picture() const { return picture_; }

  private:
    template <class Opening>
    auto ask_for_class_files(Opening opening);
    void watch_files();
    void describe_scene();
    void take_over(const std::shared_ptr<Scene>& next);
    void try_change(const std::function<std::shared_ptr<Scene>()>& change);
    void start_film(const PreviewRequest& request);
    std::optional<AlgorithmChoice> first_choice(const PreviewRequest& request) const;
    RenderSettings settings_for(const Scene& scene, uint32_t receiver, const PreviewRequest& request) const;
    std::unique_ptr<Renderer> make_renderer(Scene& scene, uint32_t receiver, const PreviewRequest& request,
                                            const std::optional<AlgorithmChoice>& choice);
    uint32_t step_for(double seconds, const PreviewRequest& request) const;
    void restart(uint32_t step);
    void begin_pilot(const PreviewRequest& request);
    void look_at_pilot();
    void use_choice(const PreviewRequest& request);
    void publish(const PreviewRequest& request);
    void look_at_errors(const PreviewRequest& request);
    const Image& aovs(const PreviewPicture& picture);
    std::vector<glm::vec3> develop_layer(Layer layer, const PreviewPicture& picture);
    void update_status(bool at_rest);
    void say(const std::string& message, bool is_error = false);
    uint32_t receiver_ref(const PreviewRequest& request) const;

    ViewOptions options_;
    const std::function<bool()> interrupt_;
    const std::function<void()> changed_;
    const std::function<bool(const std::string&)> ask_;
    const StartPrograms start_programs_;
    std::jthread color_spectra_;  // computes them ahead
    bool has_started_ = false;    // there was a picture
    std::unique_ptr<Device> device_;
    std::unique_ptr<LiveScene> live_;
    std::shared_ptr<Scene> scene_;  // the renderer's
    std::unique_ptr<Renderer> renderer_;
    WatchedFiles watched_;
    bool has_drawn_ = false;  // the device at hand, a picture
    PreviewStatus status_;
    std::shared_ptr<const PreviewPicture> picture_;
    std::optional<PreviewRequest> current_;       // what the film shows
    std::optional<AlgorithmChoice> choice_;       // that --algorithm auto came to, for this scene
    std::unique_ptr<BackgroundPilot> pilot_;      // while it runs
    Algorithm algorithm_ = Algorithm::automatic;  // that the renderer was made for
    uint32_t capacity_ = 0;                       // pixels that the renderer has room for
    uint32_t step_ = 0;
    double seconds_a_pixel_ = 0;  // of a pass; 0 = not known yet
    uint64_t next_errors_ = 2;    // passes
    std::vector<glm::vec3> errors_;
    Image aovs_;  // of the film at hand; without pixels until asked for
};

}  // namespace etendue
