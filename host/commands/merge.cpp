// etendue merge: parts of one render or measurement, made by several runs, to one image or report and one
// checkpoint.
#include <cmath>

#include "host/commands/film_checkpoint.h"
#include "host/commands/measure_checkpoint.h"
#include "host/error.h"
#include "host/image/atomic_file.h"
#include "host/image/exr.h"
#include "host/image/outputs.h"
#include "host/measure/report.h"

namespace etendue {
namespace {

namespace fs = std::filesystem;

// Parts are read one after the other and added to the first: two are in memory at a time.
class Merger {
  public:
    explicit Merger(const MergeOptions& options) : options_(options) {}

    void add(const fs::path& path) {
        std::optional<Checkpoint> part = read(path);
        if (!part) return;
        for (const auto& [other, passes] : added_)
            if (const auto both = passes.overlap(part->passes))
                fail_input("{}: has passes {}, and so has {}", path.string(), to_text(*both), other.string());
        added_.emplace_back(path, part->passes);
        if (!all_) {
            all_ = std::move(part);
            return;
        }
        const fs::path& first = added_.front().first;
        require_identity(path, part->identity, all_->identity, fmt::format("in {}", first.string()));
        if (is_measurement(*part))
            merge_measurement(*all_, *part, path);
        else
            merge(*all_, *part, path);
    }

    // All that were added. Fails where passes that are wanted are missing, unless they may be.
    Checkpoint& all() {
        if (!all_) fail_input("no part is left to merge");
        const uint64_t end = options_.passes ? options_.first_pass + *options_.passes : all_->passes.end();
        const std::vector<PassRange> missing = all_->passes.missing(options_.first_pass, end);
        if (missing.empty()) return *all_;
        const std::string line = fmt::format("passes {} are missing", to_text(missing));
        if (!options_.partial) fail_input("{} (--partial merges what there is)", line);
        note(line);
        return *all_;
    }
    const fs::path& first() const { return added_.front().first; }

  private:
    void note(const std::string& line) const {
        if (!options_.quiet) fmt::print(stderr, "{}\n", line);
    }
    // Nothing where the file is no whole part and may be left out.
    std::optional<Checkpoint> read(const fs::path& path) const {
        try {
            return read_checkpoint(path);
        } catch (const Error& error) {
            if (!options_.partial) throw;
            note(fmt::format("left out: {}", error.what()));
            return {};
        }
    }

    const MergeOptions& options_;
    std::optional<Checkpoint> all_;
    std::vector<std::pair<fs::path, PassSet>> added_;
};

std::string text_of(const RelativeError& error) {
    return std::isfinite(error.value())
               ? fmt::format("relative error {:.4g}, below {:.4g} with 95 % confidence", error.value(),
                             error.bound())
               : std::string("no error can be told yet");
}

struct StatedError {
    double value, bound;
};

void write_stats(const MergeOptions& options, const Checkpoint& all, const StatedError& error) {
    const auto finite_or_null = [](double x) {
        return std::isfinite(x) ? nlohmann::json(x) : nlohmann::json();
    };
    nlohmann::json json = all.identity;
    json.update(all.about);
    json.update({{"command", options.command_line},
                 {"passes", to_json(all.passes)},
                 {"pass_count", all.passes.count()},
                 {"estimated_relative_error", finite_or_null(error.value)},
                 {"relative_error_bound", finite_or_null(error.bound)}});
    const std::string text = json.dump(2) + "\n";
    write_atomically(options.stats, text);
}

void write_image(const MergeOptions& options, Checkpoint& all, const fs::path& first, Outputs& outputs,
                 std::string& told) {
    if (options.output.extension() != ".exr" && !options.output.empty())
        fail_input("--output {}: images are written as OpenEXR; the name must end in .exr",
                   options.output.string());
    if (options.output.empty() && options.stats.empty()) return;
    std::vector<Developed> developed = develop(all, first, options.aovs);
    std::vector<std::string> names;
    for (const Developed& view : developed) names.push_back(view.receiver);
    const std::vector<fs::path> files = output_files(options.output, names);
    RelativeError error = developed.front().error;
    for (size_t v = 0; v < developed.size(); ++v) {
        Developed& view = developed[v];
        if (!(view.error.value() <= error.value())) error = view.error;
        view.image.attributes["command"] = options.command_line;
        if (!options.output.empty()) outputs.write([&] { write_exr(files[v], view.image); });
    }
    told += ": " + text_of(error);
    if (!options.stats.empty())
        outputs.write([&] { write_stats(options, all, {error.value(), error.bound()}); });
}

void write_measurement(const MergeOptions& options, Checkpoint& all, const fs::path& first, Outputs& outputs,
                       std::string& told) {
    if (options.aovs) fail_input("--aovs: {} is a measurement, which has no such layers", first.string());
    const Measurement measurement = measurement_of(all, first);
    const double error = relative_error(measurement, false);
    told += fmt::format(": half the 95 % intervals of the means is at most {:.4g} of them", error);
    if (!options.stats.empty()) outputs.write([&] { write_stats(options, all, {error, error}); });
    if (options.output.empty()) return;
    prepare_output_folder(options.output, "figures.csv", "measurement");
    const ReportOptions report = report_options(all, options.output, options.command_line);
    for (const std::string& note :
         write_report(report, measurement, all_figures(report, measurement), outputs))
        if (!options.quiet) fmt::print(stderr, "{}\n", note);
}

}  // namespace

int merge_command(const MergeOptions& options) {
    for (const fs::path& path : {options.checkpoint, options.stats})
        if (!path.empty()) check_writable(path);
    Merger merger(options);
    for (const fs::path& part : options.parts) merger.add(part);
    Checkpoint& all = merger.all();
    if (!options.output.empty() && !is_measurement(all)) check_writable(options.output);
    Outputs outputs;
    std::string told =
        fmt::format("passes {} of {} parts", to_text(all.passes.ranges()), options.parts.size());
    if (is_measurement(all))
        write_measurement(options, all, merger.first(), outputs, told);
    else
        write_image(options, all, merger.first(), outputs, told);
    if (!options.checkpoint.empty()) outputs.write([&] { write_checkpoint(options.checkpoint, all); });
    outputs.finish();
    if (!options.quiet) fmt::print("{}\n", told);
    return int(ExitCode::done);
}

}  // namespace etendue
