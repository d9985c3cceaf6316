// Runs the built executable as a user would, in a folder of its own.
#pragma once
#include <doctest/doctest.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include "tests/support/temporary_folder.h"

namespace etendue {

struct Run {
    int code = -1;  // of exit; 128 + signal where one ended it
    std::string out, err;
    size_t error_lines() const { return size_t(std::count(err.begin(), err.end(), '\n')); }
};

struct Executable {
    TemporaryFolder folder;  // the working folder of every run
    std::map<std::string, std::string> environment;

    static std::string path() {
        const char* given = std::getenv("ETENDUE_PROGRAM");
        REQUIRE_MESSAGE(given != nullptr, "ETENDUE_PROGRAM must name the executable");
        return given;
    }

    pid_t start(const std::vector<std::string>& words) const {
        const std::string program = path();
        std::vector<char*> arguments = {const_cast<char*>(program.c_str())};
        for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
        arguments.push_back(nullptr);
        const pid_t child = fork();
        REQUIRE(child >= 0);
        if (child > 0) return child;
        for (const auto& [name, value] : environment) setenv(name.c_str(), value.c_str(), 1);
        const int out = open((folder / "stdout.txt").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
        const int err = open((folder / "stderr.txt").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
        const int in = open("/dev/null", O_RDONLY);
        if (chdir(folder.path.c_str()) != 0 || dup2(in, 0) < 0 || dup2(out, 1) < 0 || dup2(err, 2) < 0)
            _exit(127);
        execv(program.c_str(), arguments.data());
        _exit(127);
    }

    Run finish(pid_t child) const {
        int status = 0;
        REQUIRE(waitpid(child, &status, 0) == child);
        Run run;
        run.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
        run.out = read_text(folder / "stdout.txt");
        run.err = read_text(folder / "stderr.txt");
        CHECK_MESSAGE(run.err.find("validation:") == std::string::npos, run.err);
        return run;
    }

    Run run(const std::vector<std::string>& words) const { return finish(start(words)); }
};

// A sphere in a constant environment: the least that renders.
inline std::string small_scene(const std::string& surface = R"({"class": "lambertian"})",
                               const std::string& radius = "1") {
    return R"({"asset": {"version": "2.0"}, "extensionsUsed": ["ETD_optics"], "scene": 0, "scenes": [{"nodes": [0, 1]}],
"nodes": [{"name": "ball", "extensions": {"ETD_optics": {"geometry": {"class": "sphere", "radius": )" +
           radius +
           R"(, "material": 0}}}},
          {"name": "eye", "camera": 0, "translation": [0, 0, 5]}],
"materials": [{"extensions": {"ETD_optics": {"surface": )" +
           surface + R"(}}}],
"cameras": [{"type": "perspective", "perspective": {"yfov": 0.6, "aspectRatio": 2, "znear": 0.1}}],
"extensions": {"ETD_optics": {"environment": {"class": "constant", "radiance": 1}}}})";
}

}  // namespace etendue
