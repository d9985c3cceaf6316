// An X server without a screen (Xvfb), and what a user does and sees there.
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

struct _XDisplay;

namespace etendue {

struct Screenshot {
    int width = 0, height = 0;
    std::vector<uint8_t> rgb;  // rows from the top
    const uint8_t* at(int x, int y) const { return &rgb[3 * (size_t(y) * size_t(width) + size_t(x))]; }
};

class XServer {
  public:
    explicit XServer(int dots_per_inch = 96);
    ~XServer();
    XServer(const XServer&) = delete;

    std::string name() const { return name_; }  // for DISPLAY
    // The window of the only program there, once it is on the screen; fails the test after a minute.
    void wait_for_window();
    void resize(int width, int height);
    void set_minimised(bool minimised);              // as a window manager does it
    void key(const char* name, bool shift = false);  // X11's name of the key
    void hold(const char* name, bool down);
    void move(int x, int y);
    void button(int number, bool down);
    void press(int button) { this->button(button, true), this->button(button, false); }
    // Does `copy` and waits for what a program then offers on the clipboard; fails the test after a minute.
    std::string copied(const std::function<void()>& copy);
    Screenshot screenshot();
    // Until what the window shows is as wanted; false after so many seconds.
    bool wait_until(const std::function<bool(const Screenshot&)>& is_right, double seconds = 60);

  private:
    void flush();
    bool wait_for_event(int type);
    int process_ = -1;
    std::string name_;
    _XDisplay* display_ = nullptr;
    unsigned long window_ = 0, own_window_ = 0;  // the program's; one that is never shown
};

}  // namespace etendue
