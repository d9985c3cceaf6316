// etendue compare: two images, in numbers.
#include "host/image/compare.h"

#include <fmt/ranges.h>

#include <cmath>

#include "host/commands.h"
#include "host/error.h"
#include "host/image/exr.h"

namespace etendue {
namespace {

void print_z_test(const char* label, const ZTest& test) {
    fmt::print(
        "{}  {}: largest |z| {:.2f} at ({}, {}), {:.2f} % beyond 3 (0.27 % expected), rms {:.2f} (1 "
        "expected)\n",
        label, test.passes ? "equal within noise" : "DIFFERENT", test.max_z, test.x, test.y,
        100 * test.beyond_3, test.rms_z);
    fmt::print("          least p {:.3g}, limit {:.3g} for {} tests (Šidák, 1 % false alarms)\n",
               test.p_value, test.p_limit, test.tests);
}

void print_spectra(const SpectraComparison& spectra) {
    if (spectra.bins == 0) return fmt::print("spectra   not compared: the images have different bins\n");
    fmt::print("spectra   relMSE {:.6g} over {} bins, bias {:+.4f} %", spectra.relmse, spectra.bins,
               100 * spectra.bias);
    if (!spectra.worst_bin.empty())
        fmt::print(", at most {:+.4f} % in {}", 100 * spectra.worst_bias, spectra.worst_bin);
    fmt::print("\n");
}

void print_comparison(const CompareOptions& options, const Comparison& comparison) {
    fmt::print("image     {}\nreference {}\n", options.image.string(), options.reference.string());
    fmt::print("size      {} x {}, channels {}\n", comparison.width, comparison.height,
               fmt::join(comparison.channels, " "));
    fmt::print("relMSE    {:.6g}\nRMSE      {:.6g}\n", comparison.relmse, comparison.rmse);
    fmt::print("bias      {:+.4f} %", 100 * comparison.bias);
    for (size_t c = 0; c < comparison.channels.size(); ++c)
        fmt::print("  {} {:+.4f} %", comparison.channels[c], 100 * comparison.channel_bias[c]);
    fmt::print("\n");
    if (comparison.z_test) print_z_test("z, pixels", *comparison.z_test);
    if (comparison.tile_test) print_z_test("z, 16x16 ", *comparison.tile_test);
    if (comparison.stokes) {
        const StokesComparison& s = *comparison.stokes;
        for (size_t k = 0; k < 3; ++k)
            fmt::print("S{}        rms {:.4f} %, bias {:+.4f} % of the mean intensity\n", k + 1,
                       100 * s.rms[k], 100 * s.bias[k]);
        if (s.z_test) print_z_test("z, S1-S3 ", *s.z_test);
        if (s.tile_test) print_z_test("z, 16x16 ", *s.tile_test);
    }
    if (comparison.spectra) print_spectra(*comparison.spectra);
    for (const PixelDifference& pixel : comparison.worst)
        fmt::print("worst     ({}, {})  {:.4g}  image {:.5g}  reference {:.5g}\n", pixel.x, pixel.y,
                   pixel.relative_squared, fmt::join(pixel.image, " "), fmt::join(pixel.reference, " "));
    fmt::print("nonfinite {} pixel(s) in the image, {} in the reference{}\n", comparison.nonfinite_image,
               comparison.nonfinite_reference,
               comparison.nonfinite_image + comparison.nonfinite_reference ? " (left out of the rest)" : "");
}

}  // namespace

int compare_command(const CompareOptions& options) {
    Image image = read_exr(options.image), reference = read_exr(options.reference);
    Comparison comparison =
        compare_images(image, reference, options.image.string(), options.reference.string());
    print_comparison(options, comparison);
    if (!options.max_relmse) return int(ExitCode::done);
    bool finite = comparison.nonfinite_image == 0 && comparison.nonfinite_reference == 0;
    bool passes = finite && comparison.relmse <= *options.max_relmse;
    fmt::print("limit     {:.6g}: {}\n", *options.max_relmse,
               passes   ? "kept"
               : finite ? "EXCEEDED"
                        : "FAILED, not all pixels are finite");
    return int(passes ? ExitCode::done : ExitCode::target_failed);
}

}  // namespace etendue
