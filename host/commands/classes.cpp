// etendue classes: the registered classes, as text or as a page with examples and pictures.
#include <fmt/core.h>

#include "host/commands.h"
#include "host/commands/class_page.h"
#include "host/commands/showcases.h"
#include "host/error.h"
#include "host/image/atomic_file.h"
#include "host/interrupt.h"
#include "host/scene/classes.h"

namespace etendue {
namespace {

void print_class(const ClassInfo& info) {
    fmt::print("{} {}  (tag {}, {}, record {} of {} bytes)\n", interface_info(info.interface).name, info.name,
               info.tag, info.file, info.record, info.stride);
    std::string summary = "    " + info.summary;
    for (size_t at = 0; (at = summary.find('\n', at)) != std::string::npos; at += 5)
        summary.replace(at, 1, "\n    ");
    fmt::print("{}\n", summary);
    for (const Parameter& p : info.parameters) {
        if (!p.from_scene) continue;
        std::string line = fmt::format("  {:<12} {:<26} {}", p.member.type, p.member.name, p.shown_default());
        if (const std::string range = p.range(); !range.empty()) line += " in " + range;
        if (!p.unit.empty()) line += " " + p.unit;
        fmt::print("{}\n      {}\n", line, p.text);
    }
    fmt::print("\n");
}

int write_page(const ClassesOptions& options, const ClassRegistry& registry,
               const std::vector<const ClassInfo*>& classes) {
    check_writable(options.html);
    catch_interrupts();
    Progress progress;
    progress.style = progress_style(options.quiet);
    const auto device = create_device({options.device, false});
    const std::string page =
        class_page(registry, classes, render_examples(*device, classes, options, progress));
    write_atomically(options.html, std::as_bytes(std::span(page)));
    return int(interrupted() ? ExitCode::interrupted : ExitCode::done);
}

}  // namespace

int classes_command(const ClassesOptions& options) {
    ShaderSources sources;
    sources.folder = options.shaders;
    ClassRegistry registry(sources);
    std::vector<const ClassInfo*> chosen;
    for (const InterfaceInfo& interface : all_interfaces()) {
        const auto& classes = registry.classes(interface.interface);
        const bool lists = options.name.empty() && options.html.empty();
        if (lists) fmt::print("{}{}\n", interface.name, classes.empty() ? ": none" : "");
        for (const ClassInfo& listed : classes) {
            if (!options.name.empty() && listed.name != options.name) continue;
            const ClassInfo& info = *registry.find(interface.interface, listed.name);  // compiles it
            chosen.push_back(&info);
            if (lists) fmt::print("    {:<19} {}\n", info.name, first_sentence(info.summary));
        }
    }
    if (chosen.empty()) fail_input("classes {}: no such class; `etendue classes` lists them", options.name);
    if (!options.html.empty()) return write_page(options, registry, chosen);
    if (!options.name.empty())
        for (const ClassInfo* info : chosen) print_class(*info);
    return int(ExitCode::done);
}

}  // namespace etendue
