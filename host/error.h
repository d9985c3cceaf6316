// Errors that a user meets: one clear line, and the exit code that the program ends with.
#pragma once
#include <fmt/format.h>

#include <stdexcept>
#include <string>

namespace etendue {

enum class ExitCode {
    done = 0,
    target_failed = 1,  // a comparison or an accuracy target was missed
    bad_input = 2,      // bad usage, or a bad scene
    device_failed = 3,  // no usable device, or the device failed
    interrupted = 130,  // stopped by the user; what was made so far is written
};

// What files say is repeated in messages: one line whatever they hold. Control characters, marks that turn
// the direction of text, and bytes that are no UTF-8 become \x1b, byte by byte; a line feed becomes a space.
std::string printable(const std::string& text);

// `what()` is the whole line to print, printable. For scenes it reads "FILE: JSON POINTER: what is wrong;
// what is allowed".
class Error : public std::runtime_error {
  public:
    Error(ExitCode code, const std::string& line) : std::runtime_error(printable(line)), code(code) {}
    ExitCode code;
};

template <class... Args>
[[noreturn]] void fail_input(fmt::format_string<Args...> format, Args&&... args) {
    throw Error(ExitCode::bad_input, fmt::format(format, std::forward<Args>(args)...));
}

template <class... Args>
[[noreturn]] void fail_device(fmt::format_string<Args...> format, Args&&... args) {
    throw Error(ExitCode::device_failed, fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace etendue
