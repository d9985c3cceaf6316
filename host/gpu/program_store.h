// The programs of a device by what they were compiled from, so that the same is never compiled twice while
// somebody may ask for it again. Of programs that no kernel has the oldest go when there are many.
#pragma once
#include <condition_variable>
#include <deque>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "host/gpu/kernel.h"

namespace etendue {

// A program that will be asked for, as far as one knows.
struct ExpectedProgram {
    uint64_t key = 0;
    std::filesystem::path spirv;  // CompiledShader::file
};

class ProgramStore {
  public:
    ProgramStore() = default;
    ~ProgramStore();
    ProgramStore(const ProgramStore&) = delete;

    // Makes programs on a thread of its own, since drivers take tenths of a second for the large ones; those
    // with the most code first. What cannot be made is left to those who ask for it. Not while it is making
    // some.
    void expect(Device& device, std::vector<ExpectedProgram> programs);
    bool is_making();
    // null = none: the caller makes it. Waits for one that is being made; one that is not begun is the
    // caller's.
    std::shared_ptr<const Program> find(uint64_t key);
    void add(uint64_t key, std::shared_ptr<const Program> program);

  private:
    struct Entry {
        std::shared_ptr<const Program> program;
        uint64_t last_use = 0;
    };
    void make_expected(Device& device);
    void begin_next();
    std::mutex mutex_;
    std::condition_variable made_;
    // Behind the mutex:
    std::map<uint64_t, Entry> programs_;
    uint64_t uses_ = 0;
    std::deque<ExpectedProgram> expected_;
    std::optional<ExpectedProgram> being_made_;
    std::thread thread_;
};

}  // namespace etendue
