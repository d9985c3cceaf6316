// A worker on a thread of its own, which owns device, scene and renderer: nothing that a window does waits
// for it but the destructor.
#pragma once
#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>

#include "host/preview/worker.h"

namespace etendue {

class PreviewSession {
  public:
    // `notify` is called from the thread where there is news.
    PreviewSession(const ViewOptions& options, std::function<void()> notify);
    ~PreviewSession();
    PreviewSession(const PreviewSession&) = delete;

    void request(const PreviewRequest& request);  // the last one counts
    // Runs on the thread between two slices of work, in turn, once there is a film.
    void post(std::function<void(PreviewScene&)> task);
    std::shared_ptr<const PreviewPicture> picture() const;  // null = none yet
    PreviewStatus status() const;
    void answer(bool yes);         // to the status' question
    void rethrow_failure() const;  // of a scene that did not open, or a device that failed

  private:
    void run();
    void loop();
    bool work();
    std::function<void(PreviewScene&)> next_task();
    void share();
    bool is_stale();
    bool ask(const std::string& question);
    const std::function<void()> notify_;
    PreviewWorker worker_;  // the thread's own
    PreviewRequest at_work_;
    std::chrono::steady_clock::time_point next_watch_;
    mutable std::mutex mutex_;
    std::condition_variable wake_;
    // Behind the mutex:
    PreviewRequest wanted_;
    std::deque<std::function<void(PreviewScene&)>> tasks_;
    std::shared_ptr<const PreviewPicture> picture_;
    PreviewStatus status_;
    std::exception_ptr failure_;
    std::optional<bool> answer_;
    bool stop_ = false;
    std::thread thread_;
};

}  // namespace etendue
