// The panels, one a file.
#pragma once
#include "host/preview/window/view_state.h"

namespace etendue {

void draw_panels(ViewState& state);  // all that are open

void draw_scene_panel(ViewState& state);  // of scenes with variants or animations
void draw_camera_panel(ViewState& state);
void draw_film_panel(ViewState& state);
void draw_statistics_panel(ViewState& state);
void draw_objects_panel(ViewState& state);
void draw_probe_panel(ViewState& state);
void draw_rays_panel(ViewState& state);
void draw_rays(ViewState& state);  // the lines themselves
void draw_help(ViewState& state);
void draw_messages(ViewState& state);
void draw_question(ViewState& state);  // that the session asks
void draw_color_scale(ViewState& state, double lowest, double highest, const char* unit);
void draw_isolines(ViewState& state);  // at the marks of the scale
void draw_polarization_scale(ViewState& state, Layer layer);  // of a layer that shows polarization

}  // namespace etendue
