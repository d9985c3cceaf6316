#include "host/commands/class_page.h"

#include <fmt/format.h>

#include <sstream>

#include "host/html.h"

namespace etendue {
namespace {

const char* const page_head = R"(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width">
<title>étendue: the classes</title>
<style>
:root { color-scheme: light dark; --ink: #222; --soft: #6b6b70; --line: #e2e2e6; --paper: #fff; --box: #f6f6f8; --link: #1c5fb0; }
@media (prefers-color-scheme: dark) {
    :root { --ink: #e4e4e6; --soft: #9a9aa2; --line: #34343a; --paper: #18181b; --box: #222226; --link: #8ab8f0; } }
body { font: 15px/1.5 system-ui, sans-serif; color: var(--ink); background: var(--paper);
    max-width: 1080px; margin: 2em auto; padding: 0 1em; }
a { color: var(--link); text-decoration: none; } a:hover { text-decoration: underline; }
h2 { margin: 2.5em 0 .3em; } h3 { margin: 0 0 .4em; font-family: ui-monospace, monospace; }
nav p { margin: .3em 0; } .soft { color: var(--soft); }
article { border-top: 1px solid var(--line); padding: 1.3em 0 1em; overflow: auto; }
article img { float: right; margin: 0 0 1em 1.5em; border-radius: 6px; }
p, ul { margin: .4em 0; } .formula { margin-left: 2em; }
table { clear: both; border-collapse: collapse; width: 100%; margin: .8em 0; }
th, td { text-align: left; vertical-align: top; padding: .25em .8em .25em 0; border-bottom: 1px solid var(--line); }
th { font-weight: normal; color: var(--soft); }
code, pre { font: 13px/1.45 ui-monospace, monospace; }
pre { clear: both; background: var(--box); padding: .8em 1em; border-radius: 6px; overflow-x: auto; }
</style></head><body>
<h1>étendue: the classes</h1>
<p>What scenes are made of. A scene is a glTF file; in its extension <code>ETD_optics</code> every object names its class, and
the class's parameters stand beside it. Lengths are metres, angles radians, wavelengths nanometres; a pixel of 1 is 1 cd/m².</p>
<p>Examples are parts of a scene file. The pictures were rendered from them, each in a small scene of its interface: materials,
nodes and so on follow those that are there before, which is what their numbers count.</p>
)";

// Escaped, with `code` between backticks.
std::string inline_html(const std::string& text) {
    std::string html = escaped(text);
    bool open = false;
    for (size_t at = 0; (at = html.find('`', at)) != std::string::npos; open = !open)
        html.replace(at, 1, open ? "</code>" : "<code>");
    return html;
}

// A comment: paragraphs between empty lines, lists of lines that begin with "- ", formulas of indented lines.
std::string prose(const std::string& comment) {
    std::string html, element;
    const auto enter = [&](const std::string& wanted, const std::string& opening) {
        if (!element.empty()) html += element == "li" ? "</li>\n" : "</p>\n";
        if (element == "li" && wanted != "li") html += "</ul>\n";
        if (element != "li" && wanted == "li") html += "<ul>\n";
        html += opening;
        element = wanted;
    };
    std::istringstream lines(comment);
    for (std::string line; std::getline(lines, line);) {
        if (line.empty()) {
            enter("", "");
        } else if (line.starts_with("- ")) {
            enter("li", "<li>"), line.erase(0, 2);
        } else if (line[0] == ' ') {
            if (element != "li") enter("formula", "<p class=\"formula\">");
        } else if (element != "p") {
            enter("p", "<p>");
        }
        html += inline_html(line) + '\n';
    }
    enter("", "");
    return html;
}

std::string type_name(const Parameter& p) {
    static const std::map<std::string, std::string> names = {
        {"float", "number"},
        {"uint", "whole number"},
        {"int", "whole number"},
        {"vec2", "2 numbers"},
        {"vec3", "3 numbers"},
        {"vec4", "4 numbers"},
        {"SpectrumRef", "spectral value"},
        {"TextureRef", "texture"},
        {"MediumRef", "medium"},
        {"PhaseRef", "phase function"},
        {"GridRef", "file"},
        {"EnvironmentMapRef", "file"},
        {"MeasuredRef", "file"},
        {"MuellerMatrix", "16 numbers"},
        {"MuellerTableRef", "file"},
        {"GratingOrders", "list"},
        {"MicroPlaces", "file"},
        {"CellMesh", "index"},
        {"GratingTable", "list, or file"},
        {"BezierPiece", "list"},
        {"PhotometryRef", "file"},
        {"RayFileRef", "file"},
        {"WorldPoint", "point"},
        {"Direction", "direction"},
        {"SunDirection", "direction, or place and time"}};
    if (p.default_value.is_boolean()) return "true or false";  // a bool of GLSL is a uint in a buffer
    const auto found = names.find(p.member.type);
    return found == names.end() ? p.member.type : found->second;
}

std::string parameter_table(const ClassInfo& info) {
    std::string rows;
    for (const Parameter& p : info.parameters) {
        if (!p.from_scene) continue;
        const bool is_mark = p.unit == "ior" || p.unit == "data";  // for the host, of indices and of textures
        rows += fmt::format(
            "<tr><td><code>{}</code></td><td>{}</td><td>{}</td><td>{}</td><td><code>{}</code></td><td>{}</"
            "td></tr>\n",
            p.member.name, escaped(type_name(p)), is_mark ? "" : escaped(p.unit), escaped(p.range()),
            escaped(p.shown_default()), inline_html(p.text));
    }
    if (rows.empty()) return "<p class=\"soft\">It has no parameters.</p>\n";
    return "<table><tr><th>parameter</th><th>type</th><th>unit</th><th>range</th><th>default</th><th></th></"
           "tr>\n" +
           rows + "</table>\n";
}

std::string anchor(const ClassInfo& info) {
    return fmt::format("{}-{}", interface_info(info.interface).name, info.name);
}

std::string class_article(const ClassInfo& info, const Png* picture) {
    std::string html = fmt::format("<article id=\"{}\">\n", anchor(info));
    if (picture)
        html +=
            fmt::format("<img width=\"240\" height=\"240\" alt=\"{}\" src=\"data:image/png;base64,{}\">\n",
                        info.name, base64(*picture));
    html += fmt::format("<h3>{}</h3>\n{}{}", info.name, prose(info.summary), parameter_table(info));
    if (!info.example.empty()) html += "<pre>" + escaped(info.example) + "</pre>\n";
    return html + "</article>\n";
}

}  // namespace

std::string class_page(const ClassRegistry& registry, const std::vector<const ClassInfo*>& classes,
                       const std::map<const ClassInfo*, Png>& pictures) {
    std::string links, sections;
    for (const InterfaceInfo& interface : all_interfaces()) {
        std::string names, articles;
        for (const ClassInfo* info : classes) {
            if (info->interface != interface.interface) continue;
            const auto picture = pictures.find(info);
            names += fmt::format(" <a href=\"#{}\">{}</a>", anchor(*info), info->name);
            articles += class_article(*info, picture == pictures.end() ? nullptr : &picture->second);
        }
        if (names.empty()) continue;
        links += fmt::format("<p><a href=\"#{0}\"><b>{0}</b></a>:{1}</p>\n", interface.name, names);
        sections +=
            fmt::format("<section id=\"{0}\">\n<h2>{0}</h2>\n<p class=\"soft\">{1}</p>\n{2}</section>\n",
                        interface.name, escaped(registry.summary(interface.interface)), articles);
    }
    return fmt::format("{}<nav>\n{}</nav>\n{}</body></html>\n", page_head, links, sections);
}

}  // namespace etendue
