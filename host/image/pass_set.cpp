#include "host/image/pass_set.h"

#include <fmt/format.h>

#include <algorithm>

namespace etendue {

std::string to_text(const PassRange& range) { return fmt::format("{}:{}", range.first, range.end); }

std::string to_text(const std::vector<PassRange>& ranges) {
    std::string text;
    for (const PassRange& range : ranges) text += (text.empty() ? "" : ", ") + to_text(range);
    return text;
}

void PassSet::add(const PassRange& range) {
    if (range.count() == 0) return;
    const auto later = std::find_if(ranges_.begin(), ranges_.end(),
                                    [&](const PassRange& r) { return r.first > range.first; });
    auto at = ranges_.insert(later, range);
    if (at + 1 != ranges_.end() && at->end == (at + 1)->first) {
        at->end = (at + 1)->end;
        ranges_.erase(at + 1);
    }
    if (at != ranges_.begin() && (at - 1)->end == at->first) {
        (at - 1)->end = at->end;
        ranges_.erase(at);
    }
}

void PassSet::add(const PassSet& other) {
    for (const PassRange& range : other.ranges_) add(range);
}

uint64_t PassSet::count() const {
    uint64_t sum = 0;
    for (const PassRange& r : ranges_) sum += r.count();
    return sum;
}

uint64_t PassSet::even() const {
    uint64_t sum = 0;
    for (const PassRange& r : ranges_) sum += (r.end + 1) / 2 - (r.first + 1) / 2;
    return sum;
}

std::vector<PassRange> PassSet::missing(uint64_t first, uint64_t end) const {
    std::vector<PassRange> gaps;
    for (const PassRange& r : ranges_) {
        if (r.first >= end) break;
        if (r.first > first) gaps.push_back({first, r.first});
        first = std::max(first, r.end);
    }
    if (first < end) gaps.push_back({first, end});
    return gaps;
}

PassRange PassSet::next_missing(uint64_t first, uint64_t most) const {
    for (const PassRange& r : ranges_) {
        if (r.first > first) return {first, std::min(first + most, r.first)};
        first = std::max(first, r.end);
    }
    return {first, first + most};
}

std::optional<PassRange> PassSet::overlap(const PassSet& other) const {
    for (const PassRange& a : ranges_)
        for (const PassRange& b : other.ranges_)
            if (a.first < b.end && b.first < a.end)
                return PassRange{std::max(a.first, b.first), std::min(a.end, b.end)};
    return {};
}

nlohmann::json to_json(const PassSet& passes) {
    nlohmann::json json = nlohmann::json::array();
    for (const PassRange& range : passes.ranges()) json.push_back({range.first, range.end});
    return json;
}

PassSet passes_from_json(const nlohmann::json& json) {
    PassSet passes;
    for (const nlohmann::json& range : json) passes.add(PassRange{range.at(0), range.at(1)});
    return passes;
}

}  // namespace etendue
