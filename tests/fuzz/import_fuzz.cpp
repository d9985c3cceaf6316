// Fuzz target of the scene importer and of the other readers of files. With clang: -DETENDUE_LIBFUZZER
// -fsanitize=fuzzer,address,undefined. With other compilers, a program of its own that mutates a built-in
// scene and the files that it is given:
//
//     import_fuzz SECONDS [SEED [FILE…]]
//
// An input that breaks a promise is written to fuzz_failure.glb before the program ends.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "tests/fuzz/reader_mutations.h"

using namespace etendue;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    try_import({data, size});
    return 0;
}

#ifndef ETENDUE_LIBFUZZER
namespace {

// Written before the import: a crash leaves it behind.
void keep(const std::vector<uint8_t>& bytes) {
    std::ofstream("fuzz_failure.glb", std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
}

std::vector<uint8_t> read(const char* path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 2) return std::fprintf(stderr, "usage: import_fuzz SECONDS [SEED [FILE...]]\n"), 2;
    double seconds = std::atof(argv[1]);
    Random random(argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1);
    std::vector<std::vector<uint8_t>> seeds;
    for (int i = 3; i < argc; ++i) seeds.push_back(read(argv[i]));
    GltfBuilder scene = rich_scene();
    if (!try_import(scene.glb())) return std::fprintf(stderr, "the built-in scene is refused\n"), 1;

    const TemporaryFolder folder;
    const std::vector<FuzzedReader> readers = fuzzed_readers(folder);
    auto start = std::chrono::steady_clock::now();
    size_t runs = 0, scenes = 0;
    while (std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() < seconds) {
        if (runs % 3 == 0) {
            const FuzzedReader& reader = readers[below(random, readers.size())];
            const std::string file = mutated_file(reader, random);
            keep({file.begin(), file.end()});
            scenes += try_read(reader, folder, file);
            ++runs;
            continue;
        }
        bool from_file = !seeds.empty() && runs % 4 == 0;
        std::vector<uint8_t> bytes = from_file ? mutate_bytes(seeds[below(random, seeds.size())], random)
                                               : mutated_scene(scene, random);
        keep(bytes);
        scenes += try_import(bytes);
        ++runs;
    }
    std::remove("fuzz_failure.glb");
    std::printf("%zu inputs, %zu of them sound\n", runs, scenes);
}
#endif
