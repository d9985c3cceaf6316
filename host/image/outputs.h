// The files that one run leaves behind: one that cannot be written does not cost the others.
#pragma once
#include <string>

#include "host/error.h"

namespace etendue {

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
