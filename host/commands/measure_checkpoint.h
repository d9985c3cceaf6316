// A measurement as a checkpoint and back: for measure, which makes and goes on from them, and merge.
#pragma once
#include "host/image/checkpoint.h"
#include "host/measure/report.h"
#include "host/open_scene.h"

namespace etendue {

// Everything that passes must agree on to be parts of one measurement: `sources` (source_hashes), what was
// asked for and what was chosen.
nlohmann::json measurement_identity(const nlohmann::json& sources, const MeasureOptions& options,
                                    const Scene& scene, const MeasurementRun& run);
bool is_measurement(const Checkpoint& checkpoint);

Checkpoint to_checkpoint(const nlohmann::json& identity, const Measurement& measurement,
                         const std::vector<std::string>& devices, const MeasureOptions& options);
// Fails with one line where an array is missing or of another size.
Measurement measurement_of(Checkpoint& checkpoint, const std::filesystem::path& path);

// Adds the passes of another part of the same measurement: to one in memory, or to its checkpoint.
void add(Measurement& all, const Measurement& part);
void merge_measurement(Checkpoint& all, Checkpoint& part, const std::filesystem::path& path);

// What the report of a checkpoint says of it.
ReportOptions report_options(const Checkpoint& checkpoint, const std::filesystem::path& folder,
                             const std::string& command_line);

}  // namespace etendue
