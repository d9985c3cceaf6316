// Which passes of a run there are: ranges [first, end), apart from each other and in order.
#pragma once
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace etendue {

struct PassRange {
    uint64_t first = 0, end = 0;
    uint64_t count() const { return end - first; }
    bool operator==(const PassRange&) const = default;
};
std::string to_text(const PassRange& range);                // 16:32
std::string to_text(const std::vector<PassRange>& ranges);  // 0:8, 16:32

class PassSet {
  public:
    PassSet() = default;
    PassSet(uint64_t first, uint64_t end) { add(PassRange{first, end}); }

    void add(const PassRange& range);  // none of which is there yet
    void add(const PassSet& other);    // likewise
    bool empty() const { return ranges_.empty(); }
    uint64_t count() const;
    uint64_t even() const;  // of them
    uint64_t end() const { return empty() ? 0 : ranges_.back().end; }
    const std::vector<PassRange>& ranges() const { return ranges_; }
    // Of [first, end).
    std::vector<PassRange> missing(uint64_t first, uint64_t end) const;
    // The first ones from `first` on that are missing, at most `most`.
    PassRange next_missing(uint64_t first, uint64_t most) const;
    std::optional<PassRange> overlap(const PassSet& other) const;  // the first there is
    bool operator==(const PassSet&) const = default;

  private:
    std::vector<PassRange> ranges_;
};

nlohmann::json to_json(const PassSet& passes);         // [[0, 8], [16, 32]]
PassSet passes_from_json(const nlohmann::json& json);  // throws nlohmann::json::exception

}  // namespace etendue
