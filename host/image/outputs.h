// The files that one run leaves behind: one that cannot be written does not cost the others.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "host/error.h"

namespace etendue {

// Names of files, all different, for things of these names: letters, digits, - and _.
std::vector<std::string> file_stems(const std::vector<std::string>& names);
// The files of a picture of each thing: `output` itself for a single one, else OUT.NAME.exr.
std::vector<std::filesystem::path> output_files(const std::filesystem::path& output,
                                                const std::vector<std::string>& names);

class Outputs {
  public:
    // `write` fails by an Error, which is kept. False: it did.
    template <class Write>
    bool write(Write write) {
        try {
            write();
            return true;
        } catch (const Error& error) {
            const std::string line = error.what();
            if (lines_.find(line) == std::string::npos) lines_ += (lines_.empty() ? "" : "; ") + line;
            if (code_ == ExitCode::done) code_ = error.code;
            return false;
        }
    }
    // Once all is written that can be: one line of all failures, with the code of the first.
    void finish() const {
        if (code_ != ExitCode::done) throw Error(code_, lines_);
    }

  private:
    std::string lines_;
    ExitCode code_ = ExitCode::done;
};

}  // namespace etendue
