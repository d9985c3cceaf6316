#include "host/commands/choose_meanwhile.h"

#include "host/error.h"
#include "host/render/automatic.h"

namespace etendue {
namespace {

constexpr const char* unsure =
    "backward rays alone may miss light that smooth surfaces concentrate; --algorithm bidirectional does not";

AlgorithmChoice backward(std::string reason) {
    AlgorithmChoice choice;
    choice.reason = std::move(reason);
    return choice;
}

}  // namespace

ChooseMeanwhile::ChooseMeanwhile(Device& device, Scene& scene, const RenderOptions& options,
                                 const RenderSettings& settings, const Receiver& receiver)
    : device_(device), scene_(scene), settings_(settings) {
    if (settings.choice || settings.algorithm != Algorithm::automatic) return;
    settings_.choice = choose_without_pilot(device, scene, all_views(settings));
    if (settings_.choice) return;
    const double paths = double(settings.width) * settings.height * double(options.passes.value_or(0));
    if (options.passes && !deserves_pilot(paths)) {
        settings_.choice = backward("a pilot would cost more than a tenth of the passes");
        note_ = fmt::format("no pilot for so few passes: {}", unsure);
        return;
    }
    settings_.choice = backward("until a pilot tells");
    settings_.choice->is_open = true;
    pilot_ = std::make_unique<BackgroundPilot>(options, settings, size_t(&receiver - scene.receivers.data()),
                                               receiver);
}

std::unique_ptr<Renderer> ChooseMeanwhile::make_renderer() const {
    return std::make_unique<Renderer>(device_, scene_, settings_);
}

bool ChooseMeanwhile::take() {
    settings_.choice = pilot_->choice();
    device_.programs->expect(device_, pilot_->programs());
    pilot_.reset();
    const bool anew = settings_.choice->algorithm != Algorithm::backward;
    note_ = fmt::format("{}: {}{}", algorithm_name(settings_.choice->algorithm), settings_.choice->reason,
                        anew ? "; starting anew" : "");
    return anew;
}

void ChooseMeanwhile::give_up() {
    pilot_.reset();
    note_ = fmt::format("the pilot was not done in time: {}", unsure);
    settings_.choice = backward(note_);
}

}  // namespace etendue
