// OpenEXR and PNG files, and files that are whole or not there.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfRgbaFile.h>
#include <doctest/doctest.h>
#include <half.h>
#include <sys/stat.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "host/error.h"
#include "host/image/atomic_file.h"
#include "host/image/exr.h"
#include "host/image/png.h"
#include "tests/support/temporary_folder.h"

using namespace etendue;

namespace {

Image small_image() {
    Image image{.width = 5, .height = 3};
    std::vector<float> pixels;
    for (int i = 0; i < 15; ++i)
        for (int c = 0; c < 4; ++c) pixels.push_back(float(i) * 1.1f + float(c) * 1e-6f);
    add_channels(image, {"R", "G", "B"}, pixels, 4);
    add_channels(image, {"normal.X", "normal.Y", "normal.Z"}, pixels, 4);
    add_channels(image, {"depth.Z"}, pixels, 4);
    image.attributes = {{"scene", "box.gltf"}, {"passes", 64.0}, {"rays", 123456789012.0}, {"seconds", 1.25}};
    return image;
}

std::string message_of(const std::filesystem::path& path) {
    try {
        read_exr(path);
    } catch (const Error& e) {
        CHECK(e.code == ExitCode::bad_input);
        return e.what();
    }
    return "no error";
}

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("an OpenEXR file gives back every channel and attribute bit for bit") {
    TemporaryFolder folder;
    Image image = small_image();
    plane(image, 0)[3] = std::numeric_limits<float>::infinity();
    write_exr(folder / "a.exr", image);
    Image back = read_exr(folder / "a.exr");
    CHECK(back.width == 5);
    CHECK(back.height == 3);
    REQUIRE(back.channels.size() == image.channels.size());
    for (size_t c = 0; c < image.channels.size(); ++c) {
        int found = find_channel(back, image.channels[c]);
        REQUIRE(found >= 0);
        CHECK(std::ranges::equal(plane(image, c), plane(back, size_t(found))));
    }
    CHECK(back.attributes == image.attributes);
    write_exr(folder / "b.exr", back);
    CHECK(read_exr(folder / "b.exr").attributes == image.attributes);
}

TEST_CASE("half, integer and cropped OpenEXR images are read as float") {
    TemporaryFolder folder;
    std::string path = (folder / "mixed.exr").string();
    {
        Imath::Box2i display({0, 0}, {9, 9}), data({2, 3}, {4, 4});
        Imf::Header header(display, data);
        header.channels().insert("Y", Imf::Channel(Imf::HALF));
        header.channels().insert("id", Imf::Channel(Imf::UINT));
        half y[6];
        unsigned id[6];
        for (unsigned i = 0; i < 6; ++i) y[i] = half(0.5f * float(i)), id[i] = 100 + i;
        Imf::FrameBuffer buffer;
        buffer.insert("Y", Imf::Slice::Make(Imf::HALF, y, data));
        buffer.insert("id", Imf::Slice::Make(Imf::UINT, id, data));
        Imf::OutputFile file(path.c_str(), header);
        file.setFrameBuffer(buffer);
        file.writePixels(2);
    }
    Image image = read_exr(path);
    CHECK(image.width == 3);
    CHECK(image.height == 2);
    CHECK(plane(image, size_t(find_channel(image, "Y")))[5] == 2.5f);
    CHECK(plane(image, size_t(find_channel(image, "id")))[4] == 104.0f);
}

TEST_CASE("subsampled channels are an error with the channel's name") {
    TemporaryFolder folder;
    std::string path = (folder / "yc.exr").string();
    {
        Imf::RgbaOutputFile file(path.c_str(), 4, 4, Imf::WRITE_YC);
        std::vector<Imf::Rgba> pixels(16);
        file.setFrameBuffer(pixels.data(), 1, 4);
        file.writePixels(4);
    }
    CHECK(contains(message_of(path), "yc.exr: channel BY is subsampled"));
}

TEST_CASE("a file cut short anywhere or altered in its head fails with one line and no crash") {
    TemporaryFolder folder;
    write_exr(folder / "whole.exr", small_image());
    std::string whole = read_text(folder / "whole.exr");
    for (size_t length = 0; length < whole.size(); length += 7) {
        write_text(folder / "cut.exr", whole.substr(0, length));
        std::string message = message_of(folder / "cut.exr");
        CHECK(contains(message, "cut.exr: not a readable OpenEXR image"));
        CHECK(!contains(message, "\n"));
    }
    for (size_t at = 0; at < whole.size(); at += 3) {
        std::string altered = whole;
        altered[at] = char(altered[at] ^ 0x5A);
        write_text(folder / "altered.exr", altered);
        CHECK(!contains(message_of(folder / "altered.exr"), "\n"));
    }
}

TEST_CASE("a small file that promises a large image is refused before there is room for it") {
    TemporaryFolder folder;
    const std::string path = (folder / "a.exr").string(), before = std::string("dataWindow\0box2i\0", 17);
    for (const Imf::Compression compression : {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION}) {
        CAPTURE(int(compression));
        {
            Imf::Header header(16, 1);
            header.compression() = compression;
            header.channels().insert("Y", Imf::Channel(Imf::HALF));
            const std::vector<half> pixels(16);
            Imf::FrameBuffer buffer;
            buffer.insert("Y", Imf::Slice::Make(Imf::HALF, pixels.data(), header.dataWindow()));
            Imf::OutputFile file(path.c_str(), header);
            file.setFrameBuffer(buffer);
            file.writePixels(1);
        }
        CHECK(read_exr(path).width == 16);
        std::string bytes = read_text(path);
        const int32_t last_column = 49999999;
        const size_t at = bytes.find(before);
        REQUIRE(at != std::string::npos);
        std::memcpy(bytes.data() + at + before.size() + 4 + 8, &last_column, sizeof last_column);
        write_text(path, bytes);
        CHECK(contains(message_of(path), "a.exr: 50000000 x 1 pixels of 1 channels: more than the"));
    }
}

TEST_CASE("a missing image and a folder in its place are told apart") {
    TemporaryFolder folder;
    CHECK(contains(message_of(folder / "none.exr"), "none.exr: cannot be read: No such file or directory"));
    CHECK(contains(message_of(folder.path), "it is a folder"));
}

TEST_CASE("an unwritable output is found before anything is written") {
    TemporaryFolder folder;
    CHECK_NOTHROW(check_writable(folder / "a.exr"));
    CHECK(std::filesystem::is_empty(folder.path));
    CHECK_THROWS_AS(check_writable(folder / "none/a.exr"), Error);
    CHECK_THROWS_AS(check_writable(folder.path), Error);
    CHECK_THROWS_AS(check_writable(""), Error);
    write_text(folder / "file", "x");
    CHECK_THROWS_AS(check_writable(folder / "file/a.exr"), Error);
    CHECK_THROWS_AS(check_writable("/proc/a.exr"), Error);
    CHECK_NOTHROW(check_writable("/dev/null"));
}

TEST_CASE("a write that fails leaves the former file and nothing beside it") {
    TemporaryFolder folder;
    write_text(folder / "a.exr", "former");
    Image broken = small_image();
    broken.channels[1] = "";  // OpenEXR refuses a channel without a name
    CHECK_THROWS_AS(write_exr(folder / "a.exr", broken), Error);
    CHECK(read_text(folder / "a.exr") == "former");
    CHECK(std::distance(std::filesystem::directory_iterator(folder.path), {}) == 1);
    const std::byte data[4]{};
    CHECK_THROWS_AS(write_atomically("/dev/full", data), Error);
}

TEST_CASE("replacing a file keeps its permissions and the link that leads to it") {
    TemporaryFolder folder;
    write_text(folder / "target", "former");
    chmod((folder / "target").c_str(), 0640);
    std::filesystem::create_symlink("target", folder / "link");
    const char text[] = "new";
    write_atomically(folder / "link", std::as_bytes(std::span(text, 3)));
    CHECK(std::filesystem::is_symlink(folder / "link"));
    CHECK(read_text(folder / "target") == "new");
    CHECK(std::filesystem::status(folder / "target").permissions() == std::filesystem::perms(0640));
}

TEST_CASE("previews are sRGB with exposure, clipped, and show pixels that are not finite as magenta") {
    TemporaryFolder folder;
    Image image{.width = 4, .height = 1};
    add_channels(image, {"R", "G", "B"},
                 std::vector<float>{0.5f, 0.0f, 4.0f, 0.0015f, -1.0f, 0.25f, NAN, 0, 0, 1, 1, 1}, 3);
    auto decoded = [&](float exposure) {
        write_png(folder / "a.png", image, exposure);
        return read_text(folder / "a.png");
    };
    CHECK(decoded(0).substr(1, 3) == "PNG");
    CHECK(decoded(0) != decoded(1));
    CHECK(decoded(0).size() < 200);
}
