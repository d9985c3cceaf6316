// The executable: runs one command and turns errors into one line and an exit code.
#include <algorithm>
#include <cstdio>
#include <fmt/core.h>
#include <new>
#include <string>
#include <variant>

#include "host/cli/cli.h"
#include "host/error.h"

using namespace etendue;

namespace {

template <class... Cases>
struct Overloaded : Cases... {
    using Cases::operator()...;
};
template <class... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;

int run(int argc, char** argv) {
    return std::visit(Overloaded{[](const TextAnswer& answer) {
                                     fmt::print("{}", answer.text);
                                     return 0;
                                 },
                                 [](const RenderOptions& o) { return render_command(o); },
                                 [](const MeasureOptions& o) { return measure_command(o); },
                                 [](const MergeOptions& o) { return merge_command(o); },
                                 [](const CompareOptions& o) { return compare_command(o); },
                                 [](const BenchOptions& o) { return bench_command(o); },
                                 [](const ViewOptions& o) { return view_command(o); },
                                 [](const RaysOptions& o) { return rays_command(o); },
                                 [](const InspectOptions& o) { return inspect_command(o); },
                                 [](const LensOptions& o) { return lens_command(o); },
                                 [](const ClassesOptions& o) { return classes_command(o); },
                                 [](const DevicesOptions&) { return devices_command(); }},
                      parse_command_line(argc, argv));
}

int report(ExitCode code, std::string line) {
    while (!line.empty() && line.back() == '\n') line.pop_back();
    std::replace(line.begin(), line.end(), '\n', ' ');
    std::fflush(stdout);
    fmt::print(stderr, "etendue: {}\n", line);
    return int(code);
}

}  // namespace

int main(int argc, char** argv) {
    try {
        const int code = run(argc, argv);
        if (std::fflush(stdout) != 0) fail_input("standard output cannot be written");
        return code;
    } catch (const Error& error) {
        return report(error.code, error.what());
    } catch (const std::bad_alloc&) {
        return report(ExitCode::device_failed, "out of memory");
    } catch (const std::exception& error) {
        return report(ExitCode::bad_input, error.what());
    }
}
