// Progress on stderr: a bar on a terminal, plain lines now and then elsewhere, nothing when quiet.
#pragma once
#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>

namespace etendue {

// Where a render stands. What it runs towards is one of the three goals; without any it runs until stopped.
struct RenderStatus {
    uint64_t passes = 0;          // done
    uint64_t passes_before = 0;   // of them, those of earlier runs (--resume)
    double seconds = 0;           // since the first pass of this run began
    double rays = 0;              // traced in this run
    std::optional<double> error;  // estimated, once it can be
    std::optional<uint64_t> passes_goal;
    std::optional<double> seconds_goal, error_goal;
    std::optional<uint64_t> even_passes;  // that it goes on to, the goal being reached: see passes_to_end_at()
};

// Sobol' samples pay off at powers of two passes. Where a render may end after `passes`, of which this run made those
// after `before`: the next power of two if that takes less than a tenth more time, else `passes`.
uint64_t passes_to_end_at(uint64_t passes, uint64_t before);

double fraction_done(const RenderStatus& status);  // 0 to 1; 0 where it cannot be told
std::optional<double> seconds_left(
    const RenderStatus& status);                        // by the rate so far; error falls as 1/sqrt(passes)
std::string progress_line(const RenderStatus& status);  // "64/256 passes · error 0.0123 · 1.20 Mrays/s · …"
std::string progress_bar(const RenderStatus& status,
                         int columns);  // the line behind a bar, at most that wide

enum class ProgressStyle { quiet, lines, bar };

// The style for stderr: quiet if asked, a bar on a terminal that can show one, else lines.
ProgressStyle progress_style(bool quiet);

// Time is taken from RenderStatus::seconds. A bar is redrawn at most 10 times a second; a line is printed
// when 5 seconds have passed since the last, or 1 second at powers of two passes.
struct Progress {
    ProgressStyle style = ProgressStyle::quiet;
    std::FILE* stream = stderr;
    double last_shown = -1e9;  // RenderStatus::seconds of the last output
    uint64_t last_passes = 0;
    bool bar_stands = false;  // the bar is on the terminal's current line
};

void show_progress(Progress& progress, const RenderStatus& status);
void finish_progress(Progress& progress,
                     const RenderStatus& status);             // the last state, and a line end behind it
void show_note(Progress& progress, const std::string& line);  // a line above the bar; not when quiet

}  // namespace etendue
