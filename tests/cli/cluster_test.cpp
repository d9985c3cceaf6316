// The recipe for Slurm (tools/cluster/slurm.sh): which jobs it submits, told by a stand-in for sbatch, and
// that what their tasks run makes the single run's image. No cluster is asked.
#include <filesystem>

#include "host/image/exr.h"
#include "tests/cli/program.h"
#include "tests/support/source_path.h"

using namespace etendue;

namespace {

int shell(const Executable& program, const std::string& command) {
    const std::string line =
        fmt::format("cd '{}' && export ETENDUE='{}' PATH=\"$PWD/bin:$PATH\" && {} > shell.txt 2>&1",
                    program.folder.path.string(), Executable::path(), command);
    const int status = std::system(line.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

TEST_CASE("a Slurm array job and the job that merges its parts") {
    Executable program;
    write_text(program.folder / "s.gltf", small_scene());
    std::filesystem::create_directory(program.folder / "bin");
    // Writes down its words, one call a line, and answers as sbatch --parsable does.
    write_text(program.folder / "bin/sbatch",
               "#!/bin/bash\nprintf '%s|' \"$@\" >> calls.txt\necho >> calls.txt\necho 4711\n");
    std::filesystem::permissions(program.folder / "bin/sbatch", std::filesystem::perms::owner_all);
    const std::string script = source_path("tools/cluster/slurm.sh");

    REQUIRE(shell(program, script + " s.gltf out.exr 10 3 --size 16x8 -- --partition=night --time=1:00:00") ==
            0);
    CHECK(
        read_text(program.folder / "calls.txt") ==
        fmt::format(
            "--parsable|--job-name=etendue|--array=0-2|--requeue|--export=ALL|--output=out.exr.parts/%a.log|"
            "--partition=night|--time=1:00:00|{0}|--part|10|3|out.exr.parts|s.gltf|--size|16x8|--algorithm|"
            "backward|\n"
            "--parsable|--job-name=etendue-merge|--dependency=afterany:4711|--export=ALL|"
            "--output=out.exr.parts/"
            "merge.log|--partition=night|--time=1:00:00|{0}|--merge|10|out.exr.parts|out.exr|\n",
            script));

    // What the tasks run, the last of them late.
    const auto task = [&](int number) {
        return shell(program,
                     fmt::format("SLURM_ARRAY_TASK_ID={} {} --part 10 3 out.exr.parts s.gltf --size 16x8 "
                                 "--algorithm backward",
                                 number, script));
    };
    const std::string merge = script + " --merge 10 out.exr.parts out.exr";
    CHECK(task(0) == 0);
    CHECK(task(2) == 0);
    CHECK(shell(program, merge) == 2);
    CHECK(read_text(program.folder / "shell.txt").find("passes 3:6 are missing") != std::string::npos);
    CHECK(task(1) == 0);
    CHECK(task(1) == 0);  // requeued: it goes on from what it has
    CHECK(shell(program, merge) == 0);
    REQUIRE(program.run({"render", "s.gltf", "--passes", "10", "--size", "16x8", "-o", "single.exr"}).code ==
            0);
    CHECK(read_exr(program.folder / "out.exr").values == read_exr(program.folder / "single.exr").values);
}
