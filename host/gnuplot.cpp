#include "host/gnuplot.h"

#include <signal.h>
#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>

namespace etendue {

std::string run_gnuplot(const std::string& script) {
    if (std::system("command -v gnuplot >/dev/null 2>&1") != 0)
        return "no plots: gnuplot is not installed (on Debian: gnuplot-nox)";
    const auto before = signal(SIGPIPE, SIG_IGN);  // where gnuplot ends early
    // A script from its standard input gnuplot reads byte by byte.
    std::FILE* gnuplot = popen("gnuplot /dev/stdin 2>/dev/null", "w");
    const bool sent = gnuplot && std::fwrite(script.data(), 1, script.size(), gnuplot) == script.size();
    const int status = gnuplot ? pclose(gnuplot) : -1;
    signal(SIGPIPE, before);
    const bool drawn = sent && WIFEXITED(status) && WEXITSTATUS(status) == 0;
    return drawn ? "" : "no plots: gnuplot failed";
}

std::string quoted_for_gnuplot(const std::string& text) {
    std::string result = "'";
    for (char c : text) result += c == '\'' ? "''" : std::string(1, c);
    return result + "'";
}

}  // namespace etendue
