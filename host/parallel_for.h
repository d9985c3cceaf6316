// A loop whose turns are shared out to threads.
#pragma once
#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

namespace etendue {

// Calls function(i) once for each i below `count`, in any order, on at most `threads` threads, this one among
// them. It must not throw.
template <class Function>
void parallel_for(size_t count, unsigned threads, Function function) {
    std::atomic<size_t> next = 0;
    const auto work = [&] {
        for (size_t i; (i = next.fetch_add(1)) < count;) function(i);
    };
    std::vector<std::jthread> pool;
    for (unsigned i = 1; i < std::min<size_t>(threads, count); ++i) pool.emplace_back(work);
    work();
}

}  // namespace etendue
