#include "render/exr.hpp"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>

#include <exception>
#include <stdexcept>

namespace render {

namespace {

constexpr const char* channel_names[] = {"R", "G", "B"};

Imf::Header header_of(const Image& image) {
    Imf::Header header(image.width, image.height);
    Imf::addChromaticities(header, Imf::Chromaticities());  // Rec. 709, white D65
    Imf::addWhiteLuminance(header, 1);
    Imf::addComments(header, "R, G and B are in nt (cd/m2); luminance is 0.2126 R + 0.7152 G + 0.0722 B.");
    for (const char* name : channel_names) header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    return header;
}

/// Points into the image. OpenEXR takes no pointer to const, and does not write.
Imf::FrameBuffer frame_buffer(const Image& image) {
    Imf::FrameBuffer buffer;
    for (std::size_t channel = 0; channel < 3; ++channel) {
        char* first = reinterpret_cast<char*>(const_cast<float*>(&image.pixels.data()->at(channel)));
        buffer.insert(channel_names[channel],
                      Imf::Slice(Imf::FLOAT, first, sizeof(Rgb), sizeof(Rgb) * static_cast<std::size_t>(image.width)));
    }
    return buffer;
}

}  // namespace

void write_exr(const Image& image, const std::string& path) {
    try {
        Imf::OutputFile file(path.c_str(), header_of(image));
        file.setFrameBuffer(frame_buffer(image));
        file.writePixels(image.height);
    } catch (const std::exception& error) {
        throw std::runtime_error(path + ": " + error.what());
    }
}

}  // namespace render
