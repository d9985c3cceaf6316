// Progress: what is shown, how often, and the estimate of the time left; the first interrupt.
#include "host/progress.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>

#include "host/interrupt.h"

using namespace etendue;

namespace {

// What Progress writes, as text.
struct Recorder {
    char* text = nullptr;
    size_t size = 0;
    std::FILE* stream = open_memstream(&text, &size);
    ~Recorder() {
        std::fclose(stream);
        std::free(text);
    }
    std::string read() const {
        std::fflush(stream);
        return {text, size};
    }
};

size_t count(const std::string& text, char c) { return size_t(std::count(text.begin(), text.end(), c)); }

}  // namespace

TEST_CASE("the time left follows from passes, from time, and from error squared") {
    CHECK(*seconds_left({.passes = 25, .seconds = 10, .passes_goal = 100}) == doctest::Approx(30));
    CHECK(*seconds_left({.passes = 3, .seconds = 4, .seconds_goal = 10}) == doctest::Approx(6));
    CHECK(*seconds_left({.passes = 9, .seconds = 5, .error = 0.02, .error_goal = 0.01}) ==
          doctest::Approx(15));
    CHECK(!seconds_left({.passes = 9, .seconds = 5, .error_goal = 0.01}));
    CHECK(*seconds_left({.passes = 50, .passes_before = 40, .seconds = 5, .passes_goal = 100}) ==
          doctest::Approx(25));
    CHECK(*seconds_left({.passes = 3, .seconds = 14, .seconds_goal = 10}) == 0);
}

TEST_CASE("a line tells passes, error, rays a second, elapsed and left") {
    RenderStatus status{.passes = 64, .seconds = 75, .rays = 90e6, .error = 0.01234, .passes_goal = 256};
    CHECK(progress_line(status) == "64/256 passes · error 0.0123 · 1.20 Mrays/s · 1:15 · 3:45 left");
    CHECK(progress_line({.passes = 1}) == "1 pass · 0.0 s");
}

TEST_CASE(
    "a render that may end goes on to a power of two passes where that takes less than a tenth more time") {
    CHECK(passes_to_end_at(59, 0) == 64);
    CHECK(passes_to_end_at(58, 0) == 58);  // six more are more than a tenth
    CHECK(passes_to_end_at(64, 0) == 64);
    CHECK(passes_to_end_at(65, 0) == 65);
    CHECK(passes_to_end_at(59, 40) == 59);  // this run made but 19 of them
    CHECK(passes_to_end_at(1, 0) == 1);
    const RenderStatus status{.passes = 60, .seconds = 5, .seconds_goal = 5, .even_passes = 64};
    CHECK(progress_line(status).starts_with("60 passes (on to 64, a power of two)"));
    CHECK(fraction_done(status) == doctest::Approx(60.0 / 64));
    CHECK(*seconds_left(status) == doctest::Approx(5 * 4.0 / 60));
}

TEST_CASE("a bar never fills more than the columns of the terminal") {
    RenderStatus status{.passes = 64, .seconds = 75, .rays = 90e6, .error = 0.01234, .passes_goal = 128};
    CHECK(progress_bar(status, 120).starts_with("[###############---------------] 64/128 passes"));
    for (int columns = 1; columns < 130; ++columns) {
        std::string bar = progress_bar(status, columns);
        auto shown = std::count_if(bar.begin(), bar.end(), [](char c) { return (c & 0xC0) != 0x80; });
        CHECK(shown <= std::max(columns - 1, 0));
    }
}

TEST_CASE("a bar is redrawn at most 10 times a second") {
    Recorder recorder;
    Progress progress{.style = ProgressStyle::bar, .stream = recorder.stream};
    for (uint64_t pass = 1; pass <= 1000; ++pass)
        show_progress(progress, {.passes = pass, .seconds = double(pass) * 1e-3});
    finish_progress(progress, {.passes = 1000, .seconds = 1.0});
    CHECK(count(recorder.read(), '\r') <= 12);
    CHECK(count(recorder.read(), '\r') >= 9);
    CHECK(recorder.read().ends_with("\n"));
}

TEST_CASE("without a terminal a line comes every few seconds and the last state always") {
    Recorder recorder;
    Progress progress{.style = ProgressStyle::lines, .stream = recorder.stream};
    for (uint64_t pass = 1; pass <= 3000; ++pass)
        show_progress(progress, {.passes = pass, .seconds = double(pass) * 1e-2});
    finish_progress(progress, {.passes = 3000, .seconds = 30});
    std::string text = recorder.read();
    CHECK(count(text, '\n') >= 7);
    CHECK(count(text, '\n') <= 14);
    CHECK(count(text, '\r') == 0);
    CHECK(text.find("3000 passes") != std::string::npos);
}

TEST_CASE("without a terminal powers of two passes have their line") {
    Recorder recorder;
    Progress progress{.style = ProgressStyle::lines, .stream = recorder.stream};
    for (uint64_t pass = 1; pass <= 4; ++pass)
        show_progress(progress, {.passes = pass, .seconds = double(pass) * 1.5});
    CHECK(recorder.read().find("2 passes") != std::string::npos);
    CHECK(recorder.read().find("3 passes") == std::string::npos);
    CHECK(recorder.read().find("4 passes") != std::string::npos);
}

TEST_CASE("quiet shows nothing") {
    Recorder recorder;
    Progress progress{.style = ProgressStyle::quiet, .stream = recorder.stream};
    show_progress(progress, {.passes = 1});
    show_note(progress, "a note");
    finish_progress(progress, {.passes = 1});
    CHECK(recorder.read().empty());
}

TEST_CASE("the first interrupt is a request to stop") {
    catch_interrupts();
    CHECK(!interrupted());
    std::raise(SIGINT);
    CHECK(interrupted());
}
