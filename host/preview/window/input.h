// Mouse and keys.
#pragma once
#include "host/preview/window/view_state.h"

namespace etendue {

class Input {
  public:
    // Of the window in `state`, from now on.
    explicit Input(ViewState& state);
    // Keys that are held down: to be called once a frame, `seconds` after the last. True: something moves.
    bool fly_on(double seconds);
    bool take_events();  // has anything happened since the last call?
    bool take_resize();
    bool drags() const { return drag_ != Drag::none; }

  private:
    void on_key(int key, int action, int mods);
    void on_button(int button, int action, int mods);
    void on_move(double x, double y);
    void on_scroll(double amount);
    enum class Drag { none, orbit, pan, dolly, look };
    ViewState& state_;
    Drag drag_ = Drag::none;
    double x_ = 0, y_ = 0;  // of the pointer, in the window's coordinates
    double clicked_at_ = -1e9, clicked_x_ = 0, clicked_y_ = 0;
    bool events_ = true, resized_ = false;
};

}  // namespace etendue
