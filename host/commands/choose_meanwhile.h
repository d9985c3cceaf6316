// --algorithm auto while passes go on: they start with backward rays, which compile first, and a pilot finds
// out on another thread whether these will do. What was asked for, passes, time or error, is asked of what
// was chosen.
#pragma once
#include <memory>
#include <optional>
#include <string>

#include "host/options.h"
#include "host/preview/background_pilot.h"
#include "host/render/renderer.h"

namespace etendue {

class ChooseMeanwhile {
  public:
    // Nothing is open where an algorithm was named or the settings hold a choice, where the scene tells
    // without a pilot, or where a pilot would cost more than a tenth of the passes asked for.
    ChooseMeanwhile(Device& device, Scene& scene, const RenderOptions& options,
                    const RenderSettings& settings, const Receiver& receiver);

    std::unique_ptr<Renderer> make_renderer() const;  // of what is known so far
    bool is_open() const { return pilot_ != nullptr; }
    bool has_chosen() const { return pilot_ && pilot_->has_ended(); }
    // Closes the choice. Whether to start anew with another renderer: else the one there is was right.
    bool take();
    void give_up();  // backward rays it is, and note() says that nobody knows whether they find all light
    const AlgorithmChoice& choice() const { return *settings_.choice; }  // once it was open and is no more
    const std::string& note() const { return note_; }                    // a line for the user; may be empty

  private:
    Device& device_;
    Scene& scene_;
    RenderSettings settings_;
    std::string note_;
    std::unique_ptr<BackgroundPilot> pilot_;
};

}  // namespace etendue
