#include "host/image/exr.h"

#include <ImfChannelList.h>
#include <ImfDoubleAttribute.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfIntAttribute.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "host/error.h"
#include "host/image/atomic_file.h"

namespace etendue {
namespace {

// More than this and a header is taken for damaged: 2^31 floats, 8 GiB.
const uint64_t max_values = uint64_t(1) << 31;

// Values that a byte of a compressed file may stand for: DWA leaves two bytes of 64 equal halves, of which
// deflate makes a thousandth.
const uint64_t values_a_byte = 1 << 16;

class MemoryOutput : public Imf::OStream {
  public:
    MemoryOutput() : Imf::OStream("memory") {}
    void write(const char data[], int count) override {
        if (position_ + uint64_t(count) > bytes.size()) bytes.resize(position_ + uint64_t(count));
        std::memcpy(bytes.data() + position_, data, size_t(count));
        position_ += uint64_t(count);
    }
    uint64_t tellp() override { return position_; }
    void seekp(uint64_t position) override { position_ = position; }

    std::vector<std::byte> bytes;

  private:
    uint64_t position_ = 0;
};

class MemoryInput : public Imf::IStream {
  public:
    MemoryInput(const std::string& name, std::span<const std::byte> bytes)
        : Imf::IStream(name.c_str()), bytes_(bytes) {}
    bool read(char data[], int count) override {
        if (count < 0 || position_ > bytes_.size() || uint64_t(count) > bytes_.size() - position_)
            throw std::runtime_error("the file ends too early");
        std::memcpy(data, bytes_.data() + position_, size_t(count));
        position_ += uint64_t(count);
        return position_ < bytes_.size();
    }
    uint64_t tellg() override { return position_; }
    void seekg(uint64_t position) override { position_ = position; }

  private:
    std::span<const std::byte> bytes_;
    uint64_t position_ = 0;
};

void write_attributes(Imf::Header& header, const std::map<std::string, Attribute>& attributes) {
    for (const auto& [name, value] : attributes) {
        if (const auto* text = std::get_if<std::string>(&value))
            header.insert(name, Imf::StringAttribute(*text));
        else
            header.insert(name, Imf::DoubleAttribute(std::get<double>(value)));
    }
}

// What the colours of a picture mean: linear Rec.709, and (1, 1, 1) is 1 cd/m².
void write_photometry(Imf::Header& header, const Image& image) {
    if (find_channel(image, "R") < 0 || find_channel(image, "G") < 0 || find_channel(image, "B") < 0) return;
    Imf::addChromaticities(header, Imf::Chromaticities());  // those of Rec.709
    Imf::addWhiteLuminance(header, 1);
}

// Those that are not the format's own.
std::map<std::string, Attribute> read_attributes(const Imf::Header& header) {
    std::map<std::string, Attribute> attributes;
    const Imf::Header own;
    for (auto i = header.begin(); i != header.end(); ++i) {
        if (own.find(i.name()) != own.end() || std::string_view(i.name()) == "whiteLuminance") continue;
        const Imf::Attribute& attribute = i.attribute();
        if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&attribute))
            attributes[i.name()] = text->value();
        else if (const auto* number = dynamic_cast<const Imf::DoubleAttribute*>(&attribute))
            attributes[i.name()] = number->value();
        else if (const auto* number = dynamic_cast<const Imf::FloatAttribute*>(&attribute))
            attributes[i.name()] = double(number->value());
        else if (const auto* number = dynamic_cast<const Imf::IntAttribute*>(&attribute))
            attributes[i.name()] = double(number->value());
    }
    return attributes;
}

// OpenEXR takes memory for what a head promises, and shows what was there before where nothing was kept.
uint64_t most_values(const Imf::Header& header, uint64_t bytes) {
    const uint64_t most =
        header.compression() == Imf::NO_COMPRESSION ? bytes / sizeof(half) : bytes * values_a_byte;
    return std::min(most, max_values);
}

Image read_image(Imf::InputFile& file, uint64_t bytes, const std::string& name) {
    const Imf::Header& header = file.header();
    Imath::Box2i window = header.dataWindow();
    uint64_t width = uint64_t(int64_t(window.max.x) - window.min.x + 1);
    uint64_t height = uint64_t(int64_t(window.max.y) - window.min.y + 1);

    Image image;
    image.attributes = read_attributes(header);
    for (auto i = header.channels().begin(); i != header.channels().end(); ++i) {
        if (i.channel().xSampling != 1 || i.channel().ySampling != 1)
            fail_input("{}: channel {} is subsampled; all channels must have the size of the image", name,
                       i.name());
        image.channels.push_back(i.name());
    }
    if (image.channels.empty()) fail_input("{}: the image has no channels", name);
    const uint64_t most = most_values(header, bytes);
    if (width > most || height > most || width * height > most / image.channels.size())
        fail_input("{}: {} x {} pixels of {} channels: more than the {} values that {}", name, width, height,
                   image.channels.size(), most, most < max_values ? "its bytes can hold" : "can be read");
    image.width = uint32_t(width), image.height = uint32_t(height);
    image.values.resize(pixel_count(image) * image.channels.size());

    Imf::FrameBuffer buffer;
    for (size_t c = 0; c < image.channels.size(); ++c)
        buffer.insert(image.channels[c], Imf::Slice::Make(Imf::FLOAT, plane(image, c).data(), window));
    file.setFrameBuffer(buffer);
    file.readPixels(window.min.y, window.max.y);
    return image;
}

}  // namespace

void write_exr(const std::filesystem::path& path, const Image& image) {
    if (image.width == 0 || image.height == 0 || image.channels.empty())
        throw std::logic_error("write_exr: the image is empty");
    MemoryOutput memory;
    try {
        Imf::Header header(int(image.width), int(image.height));
        header.compression() = Imf::ZIP_COMPRESSION;
        write_attributes(header, image.attributes);
        write_photometry(header, image);
        Imf::FrameBuffer buffer;
        for (size_t c = 0; c < image.channels.size(); ++c) {
            header.channels().insert(image.channels[c], Imf::Channel(Imf::FLOAT));
            auto* data = reinterpret_cast<char*>(const_cast<float*>(plane(image, c).data()));
            buffer.insert(image.channels[c],
                          Imf::Slice(Imf::FLOAT, data, sizeof(float), sizeof(float) * image.width));
        }
        Imf::OutputFile file(memory, header);
        file.setFrameBuffer(buffer);
        file.writePixels(int(image.height));
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& e) {
        fail_input("{}: cannot be written: {}", path.string(), e.what());
    }
    write_atomically(path, memory.bytes);
}

Image read_exr(const std::filesystem::path& path) { return read_exr(read_whole_file(path), path.string()); }

Image read_exr(std::span<const std::byte> bytes, const std::string& name) {
    try {
        MemoryInput stream(name, bytes);
        Imf::InputFile file(stream);
        return read_image(file, bytes.size(), name);
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& e) {
        // OpenEXR's messages may run over several lines and repeat the file's name.
        std::string reason = e.what();
        std::replace(reason.begin(), reason.end(), '\n', ' ');
        fail_input("{}: not a readable OpenEXR image: {}", name, reason);
    }
}

}  // namespace etendue
