#include "host/gpu/program_store.h"

#include <algorithm>

#include "host/error.h"

namespace etendue {
namespace {

constexpr size_t most_programs = 128;  // kept, beside those in use

uint64_t size_of(const ExpectedProgram& program) {
    std::error_code error;
    const uint64_t size = std::filesystem::file_size(program.spirv, error);
    return error ? 0 : size;
}

}  // namespace

ProgramStore::~ProgramStore() {
    {
        const std::lock_guard lock(mutex_);
        expected_.clear();
    }
    if (thread_.joinable()) thread_.join();
}

void ProgramStore::expect(Device& device, std::vector<ExpectedProgram> programs) {
    if (thread_.joinable()) thread_.join();
    std::erase_if(programs, [&](const ExpectedProgram& p) { return programs_.contains(p.key); });
    std::sort(programs.begin(), programs.end(),
              [](const auto& a, const auto& b) { return size_of(a) > size_of(b); });
    expected_.assign(programs.begin(), programs.end());
    begin_next();
    thread_ = std::thread([this, &device] { make_expected(device); });
}

bool ProgramStore::is_making() {
    const std::lock_guard lock(mutex_);
    return being_made_.has_value();
}

void ProgramStore::make_expected(Device& device) {
    std::unique_lock lock(mutex_);
    while (being_made_) {
        const ExpectedProgram next = *being_made_;
        lock.unlock();
        std::shared_ptr<const Program> program;
        try {
            if (const auto shader = read_cached_shader(next.spirv))
                program = std::make_shared<const Program>(device, *shader);
        } catch (const Error&) {
        }
        lock.lock();
        if (program) programs_[next.key] = {std::move(program), ++uses_};
        begin_next();
        made_.notify_all();
    }
}

void ProgramStore::begin_next() {
    being_made_.reset();
    if (expected_.empty()) return;
    being_made_ = expected_.front();
    expected_.pop_front();
}

std::shared_ptr<const Program> ProgramStore::find(uint64_t key) {
    std::unique_lock lock(mutex_);
    std::erase_if(expected_, [&](const ExpectedProgram& p) { return p.key == key; });
    made_.wait(lock, [&] { return !being_made_ || being_made_->key != key; });
    const auto found = programs_.find(key);
    if (found == programs_.end()) return nullptr;
    found->second.last_use = ++uses_;
    return found->second.program;
}

void ProgramStore::add(uint64_t key, std::shared_ptr<const Program> program) {
    const std::lock_guard lock(mutex_);
    programs_[key] = {std::move(program), ++uses_};
    while (programs_.size() > most_programs) {
        auto oldest = programs_.end();
        for (auto i = programs_.begin(); i != programs_.end(); ++i)
            if (i->second.program.use_count() == 1 &&
                (oldest == programs_.end() || i->second.last_use < oldest->second.last_use))
                oldest = i;
        if (oldest == programs_.end()) return;
        programs_.erase(oldest);
    }
}

}  // namespace etendue
