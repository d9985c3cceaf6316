// Files whose changes are to be noticed: a scene with what it refers to, and a folder of shaders.
#pragma once
#include <filesystem>
#include <map>
#include <vector>

namespace etendue {

class WatchedFiles {
  public:
    // These from now on; folders with all that is below them. What has changed of those that were watched
    // before is still to be noticed.
    void watch(std::vector<std::filesystem::path> paths);
    // Has anything changed, come or gone since the last call? Once a change is seen it is waited for its end:
    // true only where two calls in a row see the same.
    bool changed();

  private:
    using Times = std::map<std::filesystem::path, std::filesystem::file_time_type>;
    Times look() const;
    std::vector<std::filesystem::path> paths_;
    Times known_, last_;
};

}  // namespace etendue
