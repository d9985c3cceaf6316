// Damaged files for every reader but the importer's own (import_mutations.h): a sound file of each kind, and
// what must hold for whatever comes of its mutations.
#pragma once
#include <functional>

#include "host/image/checkpoint.h"
#include "host/image/exr.h"
#include "host/lens/drawing.h"
#include "host/measured/measured_bsdf.h"
#include "host/measured/mueller_table.h"
#include "host/photometry/photometric_table.h"
#include "host/photometry/ray_set.h"
#include "host/scene/density_bricks.h"
#include "host/scene/spectral_value.h"
#include "tests/fuzz/import_mutations.h"
#include "tests/support/bsdf_files.h"
#include "tests/support/density_field.h"
#include "tests/support/source_path.h"
#include "tests/support/temporary_folder.h"

namespace etendue {

struct FuzzedReader {
    std::string file;                                        // its name; the extension may tell the kind
    std::string sound;                                       // bytes of a file that is read
    std::function<void(const std::filesystem::path&)> read;  // throws where a promise is broken
    std::function<void(std::string&)> seal = [](std::string&) {};  // makes mutated bytes pass a checksum
};

inline void require_finite(std::span<const float> values, const char* what) {
    for (const float v : values)
        if (!std::isfinite(v)) throw std::logic_error(what);
}

inline void check_densities(const std::filesystem::path& file) {
    const DensityLattice lattice = read_density_file(file, "");
    DensityBricks bricks;
    add_bricks(bricks, lattice, file.string());
    require_finite(bricks.values, "densities are finite");
    for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r)
            if (!std::isfinite(lattice.world_from_lattice[c][r]))
                throw std::logic_error("a placement is finite");
}

inline void check_measured(const std::filesystem::path& file) {
    const MeasuredBsdf bsdf = read_measured_bsdf(file);
    require_finite({&bsdf.points.front().x, 2 * bsdf.points.size()}, "points are finite");
    require_finite(bsdf.colors, "colours are finite");
    require_finite(bsdf.spectra, "spectra are finite");
}

inline void check_mueller(const std::filesystem::path& file) {
    MuellerTables lists;
    const MuellerFile read = read_mueller_file(file, 1, lists);
    require_finite(lists.numbers, "nodes are finite");
    require_finite(lists.intensities, "intensities are finite");
    const glm::uvec3 nodes = read.table.nodes;
    if (lists.intensities.size() != size_t(nodes.x) * nodes.y * nodes.z * read.table.wavelengths ||
        lists.ratios.size() != 2 * lists.intensities.size())
        throw std::logic_error("a table has its matrices");
}

inline void check_spectrum(const std::filesystem::path& file) {
    SceneDescription scene;
    scene.file = file;
    scene.folder = file.parent_path();
    const SpectralValue value =
        spectral_value({{"file", file.filename().string()}}, scene, "/x", SpectralKind::factor);
    require_finite({&value.rgb.x, 3}, "colours of spectra are finite");
    if (value.table) require_finite(value.table->values, "spectra are finite");
}

inline void check_checkpoint(const std::filesystem::path& file) {
    const Checkpoint checkpoint = read_checkpoint(file);
    if (checkpoint.arrays.size() > 1000) throw std::logic_error("a checkpoint has its few arrays");
}

inline void check_image(const std::filesystem::path& file) {
    const ImageDescription image = read_image_file(file);
    if (image.rgba32f.size() != 4 * size_t(image.width) * image.height)
        throw std::logic_error("an image has its texels");
    require_finite(image.rgba32f, "texels are finite");
}

inline void check_lamp(const std::filesystem::path& file) {
    const IntensityDistribution lamp = read_photometric_file(file);
    if (lamp.candela.size() != lamp.planes.size() * lamp.angles.size())
        throw std::logic_error("a table has a value for each plane and angle");
    for (const double v : lamp.candela)
        if (!(v >= 0 && v < 1e60)) throw std::logic_error("intensities are finite and not negative");
    for (const auto* angles : {&lamp.planes, &lamp.angles})
        for (size_t i = 1; i < angles->size(); ++i)
            if (!((*angles)[i] > (*angles)[i - 1])) throw std::logic_error("angles rise");
    if (!(lamp.flux() >= 0 && lamp.intensity(33, 44) >= 0)) throw std::logic_error("lamps send light");
    std::vector<float> values;
    append_photometric_table(values, lamp);
    require_finite(values, "tables are finite");
}

inline void check_rays(const std::filesystem::path& file) {
    const RayFile rays = read_ray_file(file);
    for (const SourceRay& ray : rays.rays) {
        require_finite({&ray.position.x, 3}, "rays start somewhere");
        if (!(std::abs(glm::length(ray.direction) - 1) < 1e-5f))
            throw std::logic_error("directions are unit vectors");
        if (!(ray.flux >= 0 && ray.flux < 1e31f))
            throw std::logic_error("fluxes are finite and not negative");
    }
    for (const auto* each : {&rays.lumens, &rays.wavelengths})
        if (!each->empty() && each->size() != rays.rays.size())
            throw std::logic_error("each ray has its numbers");
    std::vector<uint32_t> words;
    const RaySet set = append_ray_set(words, rays);
    if (!(set.ref.flux >= 0 && set.ref.flux < 1e38f)) throw std::logic_error("a flux is finite");
    for (const SpectralValue& color : set.colors) {
        require_finite({&color.rgb.x, 3}, "colours of rays are finite");
        if (color.table) require_finite(color.table->values, "spectra of rays are finite");
    }
    if (set.ref.uneven)
        for (size_t i = 0; i < set.ref.count; ++i)
            if (words[2 * i] > 1u << 24 || words[2 * i + 1] >= set.ref.count)
                throw std::logic_error("an alias table leads to rays");
}

inline void check_lens(const std::filesystem::path& file) {
    const Prescription p = read_prescription(file);
    for (const LensSurface& s : p.surfaces)
        if (!std::isfinite(s.shape.curvature + s.shape.conic + s.thickness + s.glass.index(p.primary_nm())))
            throw std::logic_error("surfaces are finite");
    lens_drawing(p, paraxial_figures(p, p.primary_nm()), 3);
}

inline std::string ray_bytes(const std::string& name) {
    return read_text(source_path("tests/host/rays/" + name));
}

inline std::string photometric_bytes(const std::string& name) {
    return read_text(source_path("tests/host/photometry/" + name));
}

// An image of 16 x 3 texels, rows by components.
inline std::string radiance_bytes() {
    std::string bytes = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 3 +X 16\n";
    for (int row = 0; row < 3; ++row) {
        bytes += std::string("\2\2\0\20", 4);
        for (int component = 0; component < 4; ++component)
            bytes += std::string("\210\200\4abcd\204\201", 9);  // 8 alike, 4 different, 4 alike
    }
    return bytes;
}

// A picture of 20 x 18 pixels, of two pieces that are compressed each for itself.
inline std::string exr_bytes(const TemporaryFolder& folder) {
    Image image;
    image.width = 20, image.height = 18, image.channels = {"R", "G", "B", "depth"};
    for (size_t i = 0; i < 4 * pixel_count(image); ++i) image.values.push_back(float(i % 7));
    image.attributes["unit"] = "W";
    write_exr(folder / "sound", image);
    return read_text(folder / "sound");
}

inline std::string checkpoint_bytes(const TemporaryFolder& folder) {
    Checkpoint checkpoint;
    checkpoint.identity = {{"scene", "s"}, {"seed", 7}};
    checkpoint.passes = PassSet(0, 3);
    checkpoint.about = {{"rays", 5}, {"choice", {{"reason", "because"}}}};
    checkpoint.arrays = {{"film", std::vector<std::byte>(40, std::byte{1})}, {"bins", {}}};
    write_checkpoint(folder / "sound", checkpoint);
    return read_text(folder / "sound");
}

inline void seal_checkpoint(std::string& bytes) {
    if (bytes.size() < sizeof(uint64_t)) return;
    const size_t body = bytes.size() - sizeof(uint64_t);
    uint32_t header = 0;
    if (body >= 16) std::memcpy(&header, bytes.data() + 12, sizeof header);
    const auto all = std::as_bytes(std::span(bytes.data(), body));
    const size_t head = std::min<size_t>(16 + size_t(header), body);
    uint64_t hash = hash_bytes(all.first(head));  // what is hashed piece by piece: head,
    hash = hash_bytes(all.subspan(head), hash);   // "film",
    hash = hash_bytes(all.subspan(body), hash);   // and "bins", which is empty
    std::memcpy(bytes.data() + body, &hash, sizeof hash);
}

inline std::vector<FuzzedReader> fuzzed_readers(const TemporaryFolder& folder) {
    const DensityField field({6, 5, 4}, {-1, 0, 2}, {1, 3, 4}, [](glm::dvec3 p) { return 2 + p.x; });
    field.write(folder / "sound");
    const std::string floats = read_text(folder / "sound");
    const std::string bytes =
        "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 3 2 2\nencoding: raw\nspacings: 0.5 1 2\n\nabcdefghijkl";
    RglResolution small;
    small.theta_i = {0, 0.8, 1.5};
    small.points = small.value_points = 4;
    const GgxMetal metal{0.4, 0.4, [](double, size_t) { return 0.5; }};
    const std::string table = R"({"theta_i": [0, 60], "theta_r": [0, 45, 90], "phi": [0, 180],
"wavelengths": [400, 700], "reflection": [[[[0.1, 0.2], [0.1, 0.2]], [[0.1, 0.2], [0.1, 0.2]], [[0, 0], [0, 0]]],
[[[0.1, 0.2], [0.1, 0.2]], [[0.1, 0.2], [0.1, 0.3]], [[0, 0], [0, 0]]]]})";
    const TensorFields mueller =
        mueller_fields(even_nodes(3, 3, 3), {450, 600}, [](double, const glm::dvec3&, const glm::dvec3&) {
            return std::array<double, 16>{0.5, 0.1};
        });
    return {{"floats.nrrd", floats, check_densities},
            {"bytes.nrrd", bytes, check_densities},
            {"colors.bsdf", tensor_file_bytes(rgl_fields(metal, {}, small)), check_measured},
            {"spectra.bsdf", tensor_file_bytes(rgl_fields(metal, {400, 550, 700}, small)), check_measured},
            {"table.json", table, check_measured},
            {"mueller.pbsdf", tensor_file_bytes(mueller), check_mueller},
            {"spectrum.csv", "nm,value\n# measured\n400, 0.5\n500;0.25\n\n600\t1e-1\n", check_spectrum},
            {"sky.hdr", radiance_bytes(), check_image},
            {"sky.exr", exr_bytes(folder), check_image},
            {"lamp.ies", photometric_bytes("own_lambert_1986_commas_feet.ies"), check_lamp},
            {"floodlight.ies", photometric_bytes("own_lambert_type_b_quarter.ies"), check_lamp},
            {"lamp.ldt", photometric_bytes("own_isym4_asym.ldt"), check_lamp},
            {"table.tm25ray", ray_bytes("own_3rays_two_spectra.tm25ray"), check_rays},
            {"lines.tm25ray", ray_bytes("own_3rays_wavelength.tm25ray"), check_rays},
            {"led.sdf", ray_bytes("own_3rays_zemax_spectral.sdf"), check_rays},
            {"led.txt", "2 4\n1 2 3 0 0.6 0.8 0.5 0.55\n0 0 0 0 0 -1 1 0.45\n", check_rays},
            {"lighttools.ray", ray_bytes("own_3rays_lighttools_watt.ray"), check_rays},
            {"speos.ray", ray_bytes("own_3rays_speos.ray"), check_rays},
            {"lens.zmx",
             "MODE SEQ\nUNIT CM X\nENPD 1\nFTYP 3 0 2 1\nYFLN 0 1\nVCYN 0 0.1\nWAVM 1 0.55 1\nSURF 0\n DISZ INFINITY\n"
             "SURF 1\n STOP\n TYPE EVENASPH\n CURV 0.2\n PARM 2 1e-3\n DISZ 0.5\n GLAS N-BK7 0 0 1.5 40\n DIAM 0.7 1\n"
             "SURF 2\n TYPE COORDBRK\n PARM 3 5\nSURF 3\n CURV -0.2\n CONI -2\n DISZ 5\nSURF 4\n",
             check_lens},
            {"lens.seq",
             "RDM; EPD 10; YRI 0 3\nWL 600 500\nSO 0 200\nS 50 5 517642\nASP; A 1e-6\nCIR 6\nS -50 45\nYDE 1; ADE 5; "
             "DAR\nSTO\nSI 0 0\n",
             check_lens},
            {"lens.txt", "fields 0 5\n50 10 N-SF2 30 -0.5 1e-7\n0 20 1 30\n0 5 1 20 stop\n-80 -50 mirror 60\n", check_lens},
            {"state", checkpoint_bytes(folder), check_checkpoint, seal_checkpoint}};
}

// Whether the file was read. Anything but a one-line, printable input error that names the file passes
// through.
inline bool try_read(const FuzzedReader& reader, const TemporaryFolder& folder, std::string bytes) {
    reader.seal(bytes);
    const std::filesystem::path file = folder / reader.file;
    write_text(file, bytes);
    try {
        reader.read(file);
        return true;
    } catch (const Error& e) {
        if (e.code != ExitCode::bad_input) throw;
        const std::string line = e.what();
        if (line != printable(line)) throw std::logic_error("an error is not printable: " + line);
        if (line.find(reader.file) == std::string::npos)
            throw std::logic_error("an error does not name the file: " + line);
        return false;
    }
}

inline std::string mutated_file(const FuzzedReader& reader, Random& random) {
    const std::vector<uint8_t> bytes = mutate_bytes({reader.sound.begin(), reader.sound.end()}, random);
    return {bytes.begin(), bytes.end()};
}

}  // namespace etendue
