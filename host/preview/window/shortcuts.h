// What the window lists under `?`.
#pragma once

namespace etendue {

struct Shortcut {
    const char *keys, *meaning;
};

inline constexpr Shortcut shortcuts[] = {
    {"left drag", "orbit"},
    {"middle drag, Shift + left drag", "pan"},
    {"wheel, Ctrl + left drag", "dolly: nearer and farther"},
    {"right drag", "look around; with W A S D Q E held: fly (Shift fast, Ctrl slow)"},
    {"F, double click", "turn around what is under the pointer"},
    {"R, Home", "the camera as the scene has it"},
    {"1 to 9, Page Up, Page Down", "cameras and receivers of the scene"},
    {"L", "layer: radiance, error, albedo, normal, depth"},
    {"T", "tone curve: none, sRGB, ACES, AgX, false colours"},
    {"+, -", "exposure, a third of a stop"},
    {"0", "exposure 0"},
    {"M", "meter the exposure"},
    {"P", "paths of light on and off"},
    {"Space", "pause and go on"},
    {"C", "copy the camera as glTF"},
    {"Ctrl + S", "save EXR and PNG"},
    {"Tab", "panels on and off"},
    {"?, F1", "this list"},
    {"Esc", "close the list; quit"},
};

}  // namespace etendue
