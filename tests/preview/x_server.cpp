#include "tests/preview/x_server.h"

#include <doctest/doctest.h>  // before X11, whose macros it does not bear

#include <X11/Xlib.h>
#include <X11/Xutil.h>
#include <X11/Xatom.h>
#include <X11/extensions/XTest.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <thread>

namespace etendue {
namespace {

void sleep_milliseconds(int count) { std::this_thread::sleep_for(std::chrono::milliseconds(count)); }

// The windows of programs that come and go: asking for one that has gone is no failure of the test.
int ignore_error(Display*, XErrorEvent*) { return 0; }

}  // namespace

XServer::XServer(int dots_per_inch) {
    int pipe_ends[2];
    REQUIRE(pipe(pipe_ends) == 0);
    process_ = fork();
    REQUIRE(process_ >= 0);
    if (process_ == 0) {
        close(pipe_ends[0]);
        const std::string descriptor = std::to_string(pipe_ends[1]);
        if (!freopen("/dev/null", "w", stderr)) _exit(127);
        execlp("Xvfb", "Xvfb", "-displayfd", descriptor.c_str(), "-screen", "0", "1400x900x24", "-nolisten",
               "tcp", static_cast<char*>(nullptr));
        _exit(127);
    }
    close(pipe_ends[1]);
    std::string number;
    for (char c; read(pipe_ends[0], &c, 1) == 1 && c != '\n';) number += c;
    close(pipe_ends[0]);
    REQUIRE_MESSAGE(!number.empty(), "Xvfb does not start (tools/setup.sh installs it)");
    name_ = ":" + number;
    XSetErrorHandler(ignore_error);
    display_ = XOpenDisplay(name_.c_str());
    REQUIRE(display_ != nullptr);
    const std::string resources = fmt::format("Xft.dpi:\t{}\n", dots_per_inch);
    XChangeProperty(display_, DefaultRootWindow(display_), XA_RESOURCE_MANAGER, XA_STRING, 8, PropModeReplace,
                    reinterpret_cast<const unsigned char*>(resources.data()), int(resources.size()));
    flush();
}

XServer::~XServer() {
    if (display_) XCloseDisplay(display_);
    if (process_ > 0) {
        kill(process_, SIGTERM);
        waitpid(process_, nullptr, 0);
    }
}

void XServer::flush() { XSync(display_, False); }

void XServer::wait_for_window() {
    for (int i = 0; i < 1200; ++i, sleep_milliseconds(50)) {
        Window root, parent, *children = nullptr;
        unsigned count = 0;
        XQueryTree(display_, DefaultRootWindow(display_), &root, &parent, &children, &count);
        window_ = 0;
        for (unsigned c = 0; c < count; ++c) {
            XWindowAttributes attributes;
            if (XGetWindowAttributes(display_, children[c], &attributes) &&
                attributes.map_state == IsViewable && attributes.c_class == InputOutput)
                window_ = children[c];
        }
        if (children) XFree(children);
        if (!window_) continue;
        move(5, 5);  // keys go to the window under the pointer
        return;
    }
    FAIL("no window came up");
}

bool XServer::wait_for_event(int type) {
    for (int i = 0; i < 1200; ++i, sleep_milliseconds(50)) {
        XEvent event;
        if (XCheckTypedWindowEvent(display_, own_window_, type, &event)) return true;
    }
    return false;
}

std::string XServer::copied(const std::function<void()>& copy) {
    const Atom clipboard = XInternAtom(display_, "CLIPBOARD", False),
               text = XInternAtom(display_, "UTF8_STRING", False),
               property = XInternAtom(display_, "COPIED", False);
    if (!own_window_)
        own_window_ = XCreateSimpleWindow(display_, DefaultRootWindow(display_), 0, 0, 1, 1, 0, 0, 0);
    XSetSelectionOwner(display_, clipboard, own_window_, CurrentTime);  // until the program takes it
    flush();
    copy();
    REQUIRE_MESSAGE(wait_for_event(SelectionClear), "nothing was copied");
    XConvertSelection(display_, clipboard, text, property, own_window_, CurrentTime);
    REQUIRE_MESSAGE(wait_for_event(SelectionNotify), "the clipboard does not answer");
    Atom type;
    int format;
    unsigned long count, left;
    unsigned char* data = nullptr;
    XGetWindowProperty(display_, own_window_, property, 0, 1 << 16, True, AnyPropertyType, &type, &format,
                       &count, &left, &data);
    REQUIRE(data != nullptr);
    const std::string result(reinterpret_cast<const char*>(data), count);
    XFree(data);
    return result;
}

void XServer::resize(int width, int height) {
    XResizeWindow(display_, window_, unsigned(width), unsigned(height));
    flush();
}

void XServer::set_minimised(bool minimised) {
    const Atom state = XInternAtom(display_, "WM_STATE", False);
    const long values[2] = {minimised ? IconicState : NormalState, None};
    if (minimised) XUnmapWindow(display_, window_);
    XChangeProperty(display_, window_, state, state, 32, PropModeReplace,
                    reinterpret_cast<const unsigned char*>(values), 2);
    if (!minimised) XMapWindow(display_, window_);
    flush();
}

void XServer::hold(const char* name, bool down) {
    const KeySym symbol = XStringToKeysym(name);
    REQUIRE_MESSAGE(symbol != NoSymbol, name);
    XTestFakeKeyEvent(display_, XKeysymToKeycode(display_, symbol), down, CurrentTime);
    flush();
}

void XServer::key(const char* name, bool shift) {
    if (shift) hold("Shift_L", true);
    sleep_milliseconds(2);  // GLFW takes presses of a key within one millisecond for one
    hold(name, true);
    hold(name, false);
    if (shift) hold("Shift_L", false);
}

void XServer::move(int x, int y) {
    XTestFakeMotionEvent(display_, -1, x, y, CurrentTime);
    flush();
}

void XServer::button(int number, bool down) {
    XTestFakeButtonEvent(display_, unsigned(number), down, CurrentTime);
    flush();
}

Screenshot XServer::screenshot() {
    XWindowAttributes attributes;
    if (!XGetWindowAttributes(display_, window_, &attributes)) return {};
    XImage* image = XGetImage(display_, window_, 0, 0, unsigned(attributes.width),
                              unsigned(attributes.height), AllPlanes, ZPixmap);
    if (!image) return {};
    Screenshot shot{image->width, image->height, {}};
    for (int y = 0; y < image->height; ++y)
        for (int x = 0; x < image->width; ++x) {
            const unsigned long pixel = XGetPixel(image, x, y);
            for (const unsigned long mask : {image->red_mask, image->green_mask, image->blue_mask})
                shot.rgb.push_back(uint8_t((pixel & mask) / (mask & -mask)));
        }
    XDestroyImage(image);
    return shot;
}

bool XServer::wait_until(const std::function<bool(const Screenshot&)>& is_right, double seconds) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    while (true) {
        const Screenshot shot = screenshot();
        if (shot.width > 0 && is_right(shot)) return true;
        if (std::chrono::steady_clock::now() > end) return false;
        sleep_milliseconds(50);
    }
}

}  // namespace etendue
