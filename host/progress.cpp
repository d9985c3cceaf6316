#include "host/progress.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <string_view>

#include "host/error.h"

namespace etendue {
namespace {

std::string duration(double seconds) {
    if (seconds < 9.95) return fmt::format("{:.1f} s", seconds);
    if (seconds >= 1e9) return "ages";
    auto s = int64_t(std::llround(seconds));
    if (s < 60) return fmt::format("{} s", s);
    if (s < 3600) return fmt::format("{}:{:02}", s / 60, s % 60);
    return fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
}

std::string rate(double rays_per_second) {
    if (rays_per_second >= 1e9) return fmt::format("{:.2f} Grays/s", rays_per_second * 1e-9);
    if (rays_per_second >= 1e6) return fmt::format("{:.2f} Mrays/s", rays_per_second * 1e-6);
    return fmt::format("{:.1f} krays/s", rays_per_second * 1e-3);
}

// Columns of UTF-8 text whose characters are one column wide each.
int columns_of(std::string_view text) {
    return int(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

int terminal_columns(std::FILE* stream) {
    winsize size{};
    return ioctl(fileno(stream), TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

}  // namespace

uint64_t passes_to_end_at(uint64_t passes, uint64_t before) {
    const uint64_t even = std::bit_ceil(passes);
    return double(even - passes) < 0.1 * double(passes - before) ? even : passes;
}

double fraction_done(const RenderStatus& status) {
    double fraction = 0;
    if (status.even_passes) return double(status.passes) / double(*status.even_passes);
    if (status.passes_goal && *status.passes_goal > 0)
        fraction = double(status.passes) / double(*status.passes_goal);
    if (status.seconds_goal && *status.seconds_goal > 0) fraction = status.seconds / *status.seconds_goal;
    if (status.error_goal && status.error && *status.error > 0)
        fraction = std::pow(*status.error_goal / *status.error, 2);
    return std::isfinite(fraction) ? std::clamp(fraction, 0.0, 1.0) : 0.0;
}

std::optional<double> seconds_left(const RenderStatus& status) {
    if (status.seconds_goal && !status.even_passes)
        return std::max(0.0, *status.seconds_goal - status.seconds);
    double fraction = fraction_done(status);
    if (fraction <= 0 || status.seconds <= 0 || status.passes <= status.passes_before) return std::nullopt;
    double passes_left = double(status.passes) * (1 - fraction) / fraction;
    return passes_left * status.seconds / double(status.passes - status.passes_before);
}

std::string progress_line(const RenderStatus& status) {
    std::string line = status.passes_goal
                           ? fmt::format("{}/{} passes", status.passes, *status.passes_goal)
                           : fmt::format("{} {}", status.passes, status.passes == 1 ? "pass" : "passes");
    if (status.even_passes) line += fmt::format(" (on to {}, a power of two)", *status.even_passes);
    if (status.error) line += fmt::format(" · error {:.3g}", *status.error);
    if (status.error_goal) line += fmt::format(" (to {:.3g})", *status.error_goal);
    if (status.seconds > 0) line += " · " + rate(status.rays / status.seconds);
    line += " · " + duration(status.seconds);
    if (auto left = seconds_left(status); left && *left > 0)
        line += fmt::format(" · {} left", duration(*left));
    return line;
}

std::string progress_bar(const RenderStatus& status, int columns) {
    std::string line = progress_line(status);
    int room = columns - 1 - columns_of(line) - 3;  // the last column stays free: some terminals wrap there
    if (room >= 5) {
        int width = std::min(room, 30), filled = int(std::lround(fraction_done(status) * width));
        return fmt::format("[{}{}] {}", std::string(size_t(filled), '#'),
                           std::string(size_t(width - filled), '-'), line);
    }
    size_t end = 0;
    for (int shown = 0; end < line.size(); ++end) {
        shown += (line[end] & 0xC0) != 0x80;
        if (shown > std::max(0, columns - 1)) break;
    }
    return line.substr(0, end);
}

ProgressStyle progress_style(bool quiet) {
    if (quiet) return ProgressStyle::quiet;
    const char* terminal = std::getenv("TERM");
    bool can_redraw = isatty(STDERR_FILENO) && terminal && std::string_view(terminal) != "dumb";
    return can_redraw ? ProgressStyle::bar : ProgressStyle::lines;
}

namespace {

void draw(Progress& progress, const RenderStatus& status) {
    if (progress.style == ProgressStyle::bar)
        fmt::print(progress.stream, "\r{}\x1b[K", progress_bar(status, terminal_columns(progress.stream)));
    else
        fmt::print(progress.stream, "{}\n", progress_line(status));
    std::fflush(progress.stream);
    progress.bar_stands = progress.style == ProgressStyle::bar;
    progress.last_shown = status.seconds;
    progress.last_passes = status.passes;
}

}  // namespace

void show_progress(Progress& progress, const RenderStatus& status) {
    if (progress.style == ProgressStyle::quiet) return;
    double since = status.seconds - progress.last_shown;
    bool due = progress.style == ProgressStyle::bar
                   ? since >= 0.1
                   : since >= 5 || (since >= 1 && std::has_single_bit(status.passes));
    if (due) draw(progress, status);
}

void finish_progress(Progress& progress, const RenderStatus& status) {
    if (progress.style == ProgressStyle::quiet) return;
    bool shown = progress.last_passes == status.passes && progress.style == ProgressStyle::lines;
    if (!shown) draw(progress, status);
    if (progress.bar_stands) fmt::print(progress.stream, "\n");
    std::fflush(progress.stream);
    progress.bar_stands = false;
}

void show_note(Progress& progress, const std::string& line) {
    if (progress.style == ProgressStyle::quiet) return;
    fmt::print(progress.stream, "{}{}\n", progress.bar_stands ? "\r\x1b[K" : "", printable(line));
    std::fflush(progress.stream);
    progress.bar_stands = false;
}

}  // namespace etendue
