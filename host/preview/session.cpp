#include "host/preview/session.h"

#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <utility>

namespace etendue {
namespace {

constexpr int render_niceness = 5;
constexpr std::chrono::milliseconds watch_interval(250);  // between two looks at the scene's files

}  // namespace

PreviewSession::PreviewSession(const ViewOptions& options, std::function<void()> notify)
    : notify_(std::move(notify)),
      worker_(
          options, [this] { return is_stale(); }, [this] { share(); },
          [this](const std::string& question) { return ask(question); }),
      thread_([this] { run(); }) {}

PreviewSession::~PreviewSession() {
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
    }
    wake_.notify_one();
    thread_.join();
}

void PreviewSession::request(const PreviewRequest& request) {
    {
        const std::lock_guard lock(mutex_);
        if (wanted_ == request) return;
        wanted_ = request;
    }
    wake_.notify_one();
}

void PreviewSession::post(std::function<void(PreviewScene&)> task) {
    {
        const std::lock_guard lock(mutex_);
        tasks_.push_back(std::move(task));
    }
    wake_.notify_one();
}

std::shared_ptr<const PreviewPicture> PreviewSession::picture() const {
    const std::lock_guard lock(mutex_);
    return picture_;
}

PreviewStatus PreviewSession::status() const {
    const std::lock_guard lock(mutex_);
    return status_;
}

// Waits for the answer. A window that closes says no.
bool PreviewSession::ask(const std::string& question) {
    std::unique_lock lock(mutex_);
    answer_.reset();
    status_.question = question;
    lock.unlock();
    notify_();
    lock.lock();
    wake_.wait(lock, [&] { return stop_ || answer_; });
    status_.question.clear();
    return answer_.value_or(false);
}

void PreviewSession::answer(bool yes) {
    {
        const std::lock_guard lock(mutex_);
        answer_ = yes;
    }
    wake_.notify_one();
}

void PreviewSession::rethrow_failure() const {
    const std::lock_guard lock(mutex_);
    if (failure_) std::rethrow_exception(failure_);
}

bool PreviewSession::is_stale() {
    const std::lock_guard lock(mutex_);
    return stop_ || at_work_.is_overtaken_by(wanted_);
}

void PreviewSession::share() {
    {
        const std::lock_guard lock(mutex_);
        picture_ = worker_.picture();
        status_ = worker_.status();
    }
    notify_();
}

void PreviewSession::run() {
    // Where the device is a CPU its threads are started from here, and give way to those that draw the
    // window.
    const auto thread = id_t(gettid());
    setpriority(PRIO_PROCESS, thread, getpriority(PRIO_PROCESS, thread) + render_niceness);
    try {
        worker_.open();
        share();
        loop();
    } catch (...) {
        const std::lock_guard lock(mutex_);
        failure_ = std::current_exception();
    }
    notify_();
}

// Null: there is none, or it has to wait for a film.
std::function<void(PreviewScene&)> PreviewSession::next_task() {
    const std::lock_guard lock(mutex_);
    if (tasks_.empty() || !worker_.takes_tasks()) return nullptr;
    auto task = std::move(tasks_.front());
    tasks_.pop_front();
    return task;
}

// A slice; false: nothing is left to do.
bool PreviewSession::work() {
    while (const auto task = next_task()) worker_.run_task(task);
    if (std::chrono::steady_clock::now() >= next_watch_) {
        worker_.reload_changed();
        next_watch_ = std::chrono::steady_clock::now() + watch_interval;
    }
    return worker_.work(at_work_);
}

void PreviewSession::loop() {
    bool busy = true;
    next_watch_ = std::chrono::steady_clock::now() + watch_interval;
    while (true) {
        {
            std::unique_lock lock(mutex_);
            const auto has_news = [&] {
                return stop_ || (worker_.takes_tasks() && !tasks_.empty()) || wanted_ != at_work_;
            };
            if (!busy) wake_.wait_until(lock, next_watch_, has_news);
            if (stop_) return;
            at_work_ = wanted_;
        }
        try {
            busy = work();
        } catch (const DeviceLost&) {
            if (!worker_.replace_device()) throw;
            busy = true;
        }
    }
}

}  // namespace etendue
