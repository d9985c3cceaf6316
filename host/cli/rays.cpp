#include "host/cli/rays.h"

#include <CLI/CLI.hpp>

#include "host/cli/values.h"

namespace etendue {
namespace {

std::vector<std::string> names(const std::optional<std::string>& text) {
    std::vector<std::string> list;
    if (!text) return list;
    for (size_t begin = 0, end = 0; end != std::string::npos; begin = end + 1) {
        end = text->find(',', begin);
        list.push_back(text->substr(begin, end - begin));
    }
    return list;
}

}  // namespace

CLI::App* add_rays(CLI::App& app, RaysOptions& options, RaysArguments& arguments) {
    CLI::App* rays = app.add_subcommand("rays", "Paths of light as lines: where they go, what befalls them");
    rays->add_option("SCENE", options.scene, "Scene, .gltf or .glb")->required()->option_text(" ");
    rays->add_option(
            "-o,--output", options.output,
            "All that is known (.json), a row a vertex (.csv), or lines to be laid over the scene (.glb)")
        ->required()
        ->option_text("FILE.json|csv|glb");
    rays->add_option("--paths", arguments.paths, "How many are traced (default: 1000)")->option_text("N");
    rays->add_option("--from", arguments.from, "Where they start (default: lights)")
        ->option_text("lights|receiver");
    rays->add_option("--events", arguments.events,
                     "Keep paths with one of: emitted, reflected, refracted, straight, scattered, entered, "
                     "left, bent, "
                     "absorbed, escaped")
        ->option_text("E,…");
    rays->add_option("--objects", arguments.objects,
                     "Keep paths with an event at one of these: shapes, nodes, materials, media, lights")
        ->option_text("NAME,…");
    rays->add_option("--without", arguments.without, "Leave out paths that come to one of these")
        ->option_text("NAME,…");
    rays->add_flag("--inside", options.inside, "Also what happens within optical elements");
    add_shared(*rays, options, arguments.shared,
               {{"size", "Of the image, whose pixels the receiver's paths go through"},
                {"receiver"},
                {"variant"},
                {"at"},
                {"environment"},
                {"color"},
                {"polarization"},
                {"sampler"},
                {"seed"},
                {"device"},
                {"shaders"},
                {"allow-class-files"}});
    return rays;
}

void finish_rays(RaysOptions& options, const RaysArguments& arguments) {
    finish_shared(options, arguments.shared);
    options.paths = uint32_t(parse_count(arguments.paths, "--paths", 1, 1 << 24));
    options.backward = parse_choice<bool>(arguments.from, "--from", {{"lights", false}, {"receiver", true}});
    options.events = names(arguments.events);
    options.objects = names(arguments.objects);
    options.without = names(arguments.without);
    options.seed = parse_count(arguments.shared.seed, "--seed", 0, UINT32_MAX);
}

}  // namespace etendue
