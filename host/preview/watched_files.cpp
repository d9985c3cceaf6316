#include "host/preview/watched_files.h"

namespace etendue {

void WatchedFiles::watch(std::vector<std::filesystem::path> paths) {
    paths_ = std::move(paths);
    Times known = look();
    for (auto& [path, time] : known)
        if (const auto before = known_.find(path); before != known_.end()) time = before->second;
    known_ = std::move(known);
}

WatchedFiles::Times WatchedFiles::look() const {
    Times times;
    std::error_code error;
    const auto note = [&](const std::filesystem::path& path) {
        const auto time = std::filesystem::last_write_time(path, error);
        if (!error) times[path] = time;
    };
    for (const std::filesystem::path& path : paths_) {
        note(path);
        if (!std::filesystem::is_directory(path, error)) continue;
        for (std::filesystem::recursive_directory_iterator i(path, error), end; !error && i != end;
             i.increment(error))
            note(i->path());
    }
    return times;
}

bool WatchedFiles::changed() {
    Times now = look();
    const bool settled = now == last_, differs = now != known_;
    last_ = std::move(now);
    if (!settled || !differs) return false;
    known_ = last_;
    return true;
}

}  // namespace etendue
