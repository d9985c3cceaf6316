#include "host/preview/worker.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <set>
#include <utility>

#include "host/error.h"
#include "host/open_scene.h"
#include "host/preview/receiver_placement.h"
#include "host/render/automatic.h"
#include "host/scene/scene_files.h"
#include "host/spectra/color.h"

namespace etendue {
namespace {

constexpr double moving_seconds = 0.05;   // that a pass may take while the view moves
constexpr double resting_seconds = 0.25;  // that the first pass of a picture at rest may take
constexpr double slice_seconds = 0.1;     // of passes between two pictures
constexpr uint32_t coarsest_step = 16;
constexpr size_t most_names = 1000;
constexpr const char* pilot_message = "choosing the algorithm: a pilot renders both ways";

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

FilmView film_view(uint32_t receiver, const PreviewRequest& request, uint32_t step) {
    return {receiver, (request.width + step - 1) / step, (request.height + step - 1) / step};
}

}  // namespace

const char* layer_name(Layer layer) {
    constexpr const char* names[] = {"radiance",
                                     "error",
                                     "albedo",
                                     "normal",
                                     "depth",
                                     "degree of linear polarization",
                                     "angle of linear polarization",
                                     "circular polarization"};
    return names[int(layer)];
}

bool PreviewRequest::shows_the_same(const PreviewRequest& other) const {
    return width == other.width && height == other.height && receiver == other.receiver &&
           placement == other.placement && algorithm == other.algorithm && seed == other.seed;
}

bool PreviewRequest::is_overtaken_by(const PreviewRequest& next) const {
    PreviewRequest moved = next;
    if (moving) moved.placement = placement;
    return !shows_the_same(moved);
}

PreviewWorker::PreviewWorker(const ViewOptions& options, std::function<bool()> interrupt,
                             std::function<void()> changed, std::function<bool(const std::string&)> ask)
    : options_(options),
      interrupt_(std::move(interrupt)),
      changed_(std::move(changed)),
      ask_(std::move(ask)),
      start_programs_(options) {}

PreviewWorker::~PreviewWorker() = default;

// `opening`, and once more where somebody allows it to run the class files that it refused.
template <class Opening>
auto PreviewWorker::ask_for_class_files(Opening opening) {
    try {
        return opening();
    } catch (const ClassFilesRefused& refused) {
        if (!ask_(refused.what())) throw;
        options_.allow_class_files = true;
        if (live_) live_->allow_class_files();
        return opening();
    }
}

void PreviewWorker::open() {
    if (start_programs_.needs_color_spectra()) color_spectra_ = std::jthread([] { color_spectra(); });
    device_ = create_device({options_.device, false});
    device_->programs->expect(*device_, start_programs_.read());
    status_.device = device_->description.name;
    live_ = ask_for_class_files([&] {
        return std::make_unique<LiveScene>(*device_, options_.scene, scene_options(options_),
                                           import_options(options_));
    });
    scene_ = live_->scene();
    status_.first_receiver = uint32_t(&choose_receiver(*scene_, options_) - scene_->receivers.data());
    describe_scene();
    watch_files();
}

void PreviewWorker::watch_files() {
    std::vector<std::filesystem::path> files = {options_.scene};
    if (!options_.shaders.empty()) files.push_back(options_.shaders);
    if (!options_.environment.empty()) files.push_back(options_.environment);
    for (const std::filesystem::path& file : files_of(live_->description())) files.push_back(file);
    watched_.watch(files);
}

void PreviewWorker::describe_scene() {
    const Scene& scene = *scene_;
    ++status_.scene;
    const auto& described = live_->description().receivers;
    status_.receivers.resize(scene.receivers.size());
    for (size_t i = 0; i < scene.receivers.size(); ++i) {
        const Receiver& receiver = scene.receivers[i];
        PreviewReceiver& status = status_.receivers[i];
        // A camera that the file does not name is as it was at first.
        const bool is_new = status.name.empty();
        status.name = receiver.name, status.class_name = receiver.info->name;
        status.unit = receiver.info->pixel_unit;
        status.aspect_ratio = receiver.aspect_ratio;
        status.lens = lens_of(receiver);
        if (i < described.size())
            status.placement = described[i].world_from_local;
        else if (is_new)
            status.placement = receiver.world_from_local;
    }
    status_.variants = live_->description().variants;
    status_.import = live_->import();
    options_.variant = status_.import.variant, options_.at = status_.import.seconds;  // for the pilot
    status_.animation_seconds = live_->description().animation_seconds;
    status_.objects = std::make_shared<const std::vector<LiveObject>>(live_->objects());
    const std::set<std::string> names(scene.placed_names.begin(), scene.placed_names.end());
    status_.placed_names.clear();
    for (const std::string& name : names)
        if (!name.empty() && status_.placed_names.size() < most_names) status_.placed_names.push_back(name);
    status_.class_names.clear();
    for (const InterfaceInfo& interface : all_interfaces())
        for (const ClassInfo& info : scene.registry->classes(interface.interface))
            status_.class_names[interface.interface].push_back(info.name);
    status_.scene_center = scene.center;
    status_.scene_radius = scene.radius;
    status_.triangles = scene.triangles, status_.shapes = scene.shapes;
    status_.instances = scene.instances, status_.lights = scene.lights;
    status_.materials = scene.materials;
}

bool PreviewWorker::replace_device() {
    if (!std::exchange(has_drawn_, false)) return false;
    say("the device was lost; the scene is loaded on another one");
    current_.reset();
    renderer_.reset();
    scene_.reset();
    live_->move_to([&]() -> Device& {
        device_.reset();
        device_ = create_device({options_.device, false});
        return *device_;
    });
    scene_ = live_->scene();
    status_.device = device_->description.name;
    ++status_.devices_lost;
    describe_scene();
    say("");
    return true;
}

// Puts the next scene in the place of the one there is; where its renderer cannot be made, all stays.
void PreviewWorker::take_over(const std::shared_ptr<Scene>& next) {
    if (next != scene_) {
        if (current_) {
            const uint32_t receiver = std::min(current_->receiver, uint32_t(next->receivers.size() - 1));
            auto renderer = make_renderer(*next, receiver, *current_, first_choice(*current_));
            renderer_ = std::move(renderer);
        } else {
            renderer_.reset();
        }
        live_->accept();
        scene_ = next;
    }
    current_.reset();
    describe_scene();
}

uint32_t PreviewWorker::receiver_ref(const PreviewRequest& request) const {
    const auto& receivers = scene_->receivers;
    return receivers[std::min<size_t>(request.receiver, receivers.size() - 1)].ref;
}

bool PreviewWorker::work(const PreviewRequest& request) {
    if (request.width == 0 || request.height == 0) return false;
    if (!current_ || !current_->shows_the_same(request)) {
        start_film(request);
    } else if (!request.moving && step_ > 1 && renderer_->passes() > 0 && !request.paused) {
        restart(std::min(step_ / 2, step_for(resting_seconds, request)));  // finer
    }
    const bool other_layer = current_->layer != request.layer ||
                             current_->wants_errors != request.wants_errors ||
                             current_->wants_depth != request.wants_depth;
    current_ = request;
    look_at_pilot();
    const bool has_come_to_rest = !request.moving && !request.paused && step_ == 1 && renderer_->passes() > 1;
    if (has_come_to_rest && request.algorithm == Algorithm::automatic) {
        begin_pilot(request);
        use_choice(request);
    }
    const uint64_t all = options_.passes.value_or(UINT64_MAX);
    const bool at_rest =
        (request.paused && renderer_->passes() > 0) || (step_ == 1 && renderer_->passes() >= all);
    if (at_rest) {
        if (other_layer || status_.at_rest != at_rest) publish(request);
        update_status(true);
        return false;
    }

    const auto start = Clock::now();
    const uint64_t rays = all_rays(renderer_->counters());
    const uint64_t left = step_ == 1 ? all - renderer_->passes() : UINT64_MAX;
    // Coarse pictures only bridge the time until the finer one.
    const double seconds = renderer_->passes() == 0 || (step_ > 1 && !request.moving) ? 0 : slice_seconds;
    const uint32_t count = uint32_t(std::min<uint64_t>(renderer_->passes_in(seconds), left));
    if (!renderer_->render_passes(count)) {
        current_.reset();  // the film is of no use
        return true;
    }
    const FilmView view = film_view(0, request, step_);
    const double taken = seconds_since(start);
    seconds_a_pixel_ = taken / count / (double(view.width) * view.height);
    status_.rays_per_second = double(all_rays(renderer_->counters()) - rays) / taken;
    publish(request);
    update_status(false);
    if (!std::exchange(has_started_, true)) start_programs_.write(*scene_);
    has_drawn_ = true;
    return true;
}

void PreviewWorker::start_film(const PreviewRequest& request) {
    const uint32_t index = std::min(request.receiver, uint32_t(status_.receivers.size() - 1));
    move_receiver(*scene_, index, request.placement.value_or(status_.receivers[index].placement),
                  scene_->receivers[index].parameters);
    if (!renderer_ || request.width * request.height > capacity_ || algorithm_ != request.algorithm) {
        renderer_.reset();  // two may not fit
        renderer_ = make_renderer(*scene_, index, request, first_choice(request));
    }
    current_ = request;
    restart(step_for(request.moving ? moving_seconds : resting_seconds, request));
}

// Of --algorithm auto before it has come to one, by a pilot that takes seconds: backward rays.
std::optional<AlgorithmChoice> PreviewWorker::first_choice(const PreviewRequest& request) const {
    if (request.algorithm != Algorithm::automatic) return {};
    AlgorithmChoice first;
    first.reason = "until the view rests";
    return choice_.value_or(first);
}

RenderSettings PreviewWorker::settings_for(const Scene& scene, uint32_t receiver,
                                           const PreviewRequest& request) const {
    RenderSettings settings;
    settings.width = request.width, settings.height = request.height;
    settings.receiver = scene.receivers[receiver].ref;
    settings.seed = request.seed;
    settings.algorithm = request.algorithm;
    settings.schedule = options_.schedule;
    settings.vertex_bytes = options_.vertex_bytes;
    settings.spectral_bins = options_.spectral_bins;
    // A film may go on to show another receiver.
    for (const Receiver& any : scene.receivers) settings.stokes |= any.wants_stokes;
    return settings;
}

std::unique_ptr<Renderer> PreviewWorker::make_renderer(Scene& scene, uint32_t receiver,
                                                       const PreviewRequest& request,
                                                       const std::optional<AlgorithmChoice>& choice) {
    RenderSettings settings = settings_for(scene, receiver, request);
    settings.choice = choice;
    settings.restarts_first = true;
    auto renderer = std::make_unique<Renderer>(*device_, scene, settings);
    renderer->set_interrupt(interrupt_);
    algorithm_ = request.algorithm;
    capacity_ = request.width * request.height;
    status_.kernels = scene.kernels;
    return renderer;
}

// The finest picture of which a pass takes that long at most.
uint32_t PreviewWorker::step_for(double seconds, const PreviewRequest& request) const {
    uint32_t step = 1;
    while (step < coarsest_step) {
        const FilmView view = film_view(0, request, step);
        if (seconds_a_pixel_ > 0 && seconds_a_pixel_ * view.width * view.height <= seconds) break;
        step *= 2;
    }
    return step;
}

void PreviewWorker::restart(uint32_t step) {
    step_ = step;
    renderer_->restart(current_->seed, film_view(receiver_ref(*current_), *current_, step));
    errors_.clear();
    next_errors_ = 2;
    status_.error.reset();
    aovs_ = {};
}

void PreviewWorker::begin_pilot(const PreviewRequest& request) {
    if (choice_ || pilot_) return;
    const uint32_t receiver = std::min(request.receiver, uint32_t(scene_->receivers.size() - 1));
    const RenderSettings settings = settings_for(*scene_, receiver, request);
    choice_ = choose_without_pilot(*device_, *scene_, all_views(settings));
    if (choice_) return;
    say(pilot_message);
    pilot_ = std::make_unique<BackgroundPilot>(options_, settings, receiver, scene_->receivers[receiver]);
}

void PreviewWorker::look_at_pilot() {
    if (!pilot_ || !pilot_->has_ended() || device_->programs->is_making()) return;
    if (!pilot_->was_given_up()) {
        choice_ = pilot_->choice();
        device_->programs->expect(*device_, pilot_->programs());
    }
    pilot_.reset();
    if (status_.message == pilot_message) say("");
}

// Has the renderer of the choice, once its programs are made, take the place of the one there is.
void PreviewWorker::use_choice(const PreviewRequest& request) {
    if (!choice_ || device_->programs->is_making() || renderer_->choice().algorithm == choice_->algorithm)
        return;
    const uint32_t receiver = std::min(request.receiver, uint32_t(scene_->receivers.size() - 1));
    renderer_.reset();
    renderer_ = make_renderer(*scene_, receiver, request, choice_);
    restart(step_for(resting_seconds, request));
}

void PreviewWorker::run_task(const std::function<void(PreviewScene&)>& task) {
    if (!takes_tasks()) return;
    PreviewScene scene{*device_, *live_, *scene_, *renderer_, *current_, receiver_ref(*current_),
                       step_,    nullptr};
    try_change([&] {
        task(scene);
        return scene.next;
    });
}

bool PreviewWorker::reload_changed() {
    if (!watched_.changed()) return false;
    say("loading the scene again");
    try_change([&] {
        std::shared_ptr<Scene> next = ask_for_class_files([&] { return live_->reload(); });
        choose_receiver(*next, options_);
        choice_.reset();
        if (pilot_) pilot_->give_up();
        return next;
    });
    if (!status_.is_error) watch_files();  // else the same: what is missing may come back
    return true;
}

// An Error becomes the message, and what was there stays.
void PreviewWorker::try_change(const std::function<std::shared_ptr<Scene>()>& change) {
    try {
        if (const std::shared_ptr<Scene> next = change()) {
            take_over(next);
            say("");
        }
    } catch (const Error& error) {
        if (error.code == ExitCode::device_failed) throw;
        // As they are, where a panel shows what was refused.
        status_.objects = std::make_shared<const std::vector<LiveObject>>(live_->objects());
        say(error.what(), true);
    }
}

void PreviewWorker::say(const std::string& message, bool is_error) {
    status_.message = message;
    status_.is_error = is_error;
    changed_();
}

void PreviewWorker::update_status(bool at_rest) {
    status_.passes = renderer_->passes();
    status_.step = step_;
    status_.at_rest = at_rest;
    status_.choice = renderer_->choice();
    if (algorithm_ == Algorithm::automatic && choice_ && choice_->algorithm == status_.choice.algorithm)
        status_.choice = *choice_;  // with its reason
    status_.schedule = renderer_->schedule();
    status_.seconds = renderer_->seconds();
    status_.timings = renderer_->timings();
    status_.device_bytes = device_->bytes_allocated;
    changed_();
}

}  // namespace etendue
