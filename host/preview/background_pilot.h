// The pilot of --algorithm auto on a thread and a device of its own, with a scene of its own: pictures go on
// meanwhile. What it compiles the driver keeps on disk, from where the renderer that follows has it.
#pragma once
#include <atomic>
#include <thread>

#include "host/options.h"
#include "host/gpu/program_store.h"
#include "host/render/renderer.h"

namespace etendue {

class BackgroundPilot {
  public:
    // Of the scene as its file has it, seen by its receiver `index` where that stands now.
    BackgroundPilot(const SceneChoice& options, const RenderSettings& settings, size_t index,
                    const Receiver& receiver);
    ~BackgroundPilot();  // waits until the pass, or the kernel that is being compiled, ends
    BackgroundPilot(const BackgroundPilot&) = delete;

    void give_up() { stop_ = true; }  // there is another scene
    bool was_given_up() const { return stop_; }
    bool has_ended() const { return ended_; }
    // Once it has ended. Where the pilot failed: backward rays.
    const AlgorithmChoice& choice() const { return choice_; }
    const std::vector<ExpectedProgram>& programs() const { return programs_; }  // that the choice needs

  private:
    void run(const SceneChoice& options, RenderSettings settings, size_t index, const Receiver& receiver);
    std::atomic<bool> stop_ = false, ended_ = false;
    AlgorithmChoice choice_;
    std::vector<ExpectedProgram> programs_;
    std::thread thread_;
};

}  // namespace etendue
