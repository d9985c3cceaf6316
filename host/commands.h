// The commands of the executable; each returns the exit code. Errors leave as Error (host/error.h).
#pragma once
#include "host/options.h"

namespace etendue {

int render_command(const RenderOptions& options);
int measure_command(const MeasureOptions& options);
int merge_command(const MergeOptions& options);
int compare_command(const CompareOptions& options);
int bench_command(const BenchOptions& options);
int view_command(const ViewOptions& options);
int rays_command(const RaysOptions& options);
int inspect_command(const InspectOptions& options);
int lens_command(const LensOptions& options);
int classes_command(const ClassesOptions& options);
int devices_command();

}  // namespace etendue
