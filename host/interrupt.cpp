#include "host/interrupt.h"

#include <signal.h>
#include <unistd.h>

#include <atomic>

namespace etendue {
namespace {

std::atomic<bool> requested{false};
static_assert(std::atomic<bool>::is_always_lock_free);  // signal handlers may touch nothing else

extern "C" void note_interrupt(int signal_number) {
    requested = true;
    signal(signal_number, SIG_DFL);  // the second one kills
    const char text[] = "\netendue: stopping after this pass; again to stop at once\n";
    if (write(STDERR_FILENO, text, sizeof text - 1) < 0) return;
}

}  // namespace

void catch_interrupts() {
    struct sigaction action {};
    action.sa_handler = note_interrupt;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
}

bool interrupted() { return requested; }

}  // namespace etendue
