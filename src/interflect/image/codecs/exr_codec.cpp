#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfVecAttribute.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <stdexcept>
#include <utility>

#include "interflect/base/files/escapes.h"
#include "interflect/core.h"
#include "interflect/image/codecs/image_codecs.h"

namespace interflect::detail::codecs {

namespace {

constexpr std::array<const char*, 3> channel_names = {"R", "G", "B"};
constexpr const char* fov_attribute = "interflect.fov";

void insert_metadata(const ImageMetadata& metadata, Imf::Header& header) {
    const auto text = [&](const char* name, const std::string& value) {
        header.insert(name, Imf::StringAttribute(escaped(value)));
    };
    const auto number = [&](const char* name, float value) { header.insert(name, Imf::FloatAttribute(value)); };
    const auto vector = [&](const char* name, const V3f& value) { header.insert(name, Imf::V3fAttribute(value)); };
    const auto point = [&](const char* name, const Imath::V3d& value) {
        header.insert(name, Imf::V3dAttribute(value));
    };
    text("interflect.view", metadata.view.name);
    point("interflect.eye", metadata.view.eye);
    point("interflect.look_at", metadata.view.look_at);
    vector("interflect.up", metadata.view.up);
    if (metadata.view.extent > 0)
        number("interflect.extent", metadata.view.extent);
    else
        number(fov_attribute, metadata.view.fov);
    text("interflect.quantity", metadata.quantity);
    text("interflect.scene", metadata.scene);
    number("interflect.exposure", metadata.exposure);
    text("interflect.seed", std::to_string(metadata.seed));
    text("interflect.version", metadata.version);
    if (!metadata.filter.empty()) text("interflect.filter", metadata.filter);
}

/// Output stream to memory. OpenEXR seeks back to complete earlier parts.
class ByteSink : public Imf::OStream {
  public:
    ByteSink() : OStream("memory") {}
    void write(const char data[], int count) override {
        const auto size = static_cast<std::size_t>(count);
        if (position_ + size > bytes_.size()) bytes_.resize(position_ + size);
        std::copy_n(data, size, bytes_.begin() + static_cast<std::ptrdiff_t>(position_));
        position_ += size;
    }
    std::uint64_t tellp() override { return position_; }
    void seekp(std::uint64_t position) override { position_ = position; }
    std::string release() { return std::move(bytes_); }

  private:
    std::string bytes_;
    std::size_t position_ = 0;
};

Imf::FrameBuffer frame_buffer(const Image& image, const Imath::Box2i& window) {
    Imf::FrameBuffer buffer;
    const auto* first = reinterpret_cast<const float*>(image.pixels.data());
    for (std::size_t c = 0; c < channel_names.size(); ++c)
        buffer.insert(channel_names[c], Imf::Slice::Make(Imf::FLOAT, first + c, window, sizeof(Rgb),
                                                         sizeof(Rgb) * static_cast<std::size_t>(image.width)));
    return buffer;
}

std::string channel_name(const ImageLayer& layer, std::size_t channel) {
    return (layer.name.empty() ? "" : layer.name + ".") + layer.channels[channel];
}

void require_values(const ImageLayer& layer, const Image& image) {
    const std::size_t expected = image.pixels.size() * layer.channels.size();
    if (layer.values.size() != expected)
        throw InputError(fmt::format("layer '{}': {} values, but {} x {} pixels with the channels {} need {}",
                                     layer.name, layer.values.size(), image.width, image.height, layer.channels,
                                     expected));
}

void insert_layer(const ImageLayer& layer, const Image& image, Imf::FrameBuffer& buffer, Imf::Header& header) {
    require_values(layer, image);
    const std::size_t pixel = layer.channels.size() * sizeof(float),
                      row = pixel * static_cast<std::size_t>(image.width);
    for (std::size_t c = 0; c < layer.channels.size(); ++c) {
        const std::string name = channel_name(layer, c);
        header.channels().insert(name, Imf::Channel(Imf::FLOAT));
        buffer.insert(name, Imf::Slice::Make(Imf::FLOAT, layer.values.data() + c, header.dataWindow(), pixel, row));
    }
}

void require_channels(const Imf::ChannelList& channels) {
    std::string present;
    for (auto i = channels.begin(); i != channels.end(); ++i) present += std::string(" ") + i.name();
    for (const char* name : channel_names)
        if (!channels.findChannel(name))
            throw std::runtime_error(fmt::format("it has no channel {}, only{}", name, present));
}

}  // namespace

std::string encode_exr(const Image& image, const ImageMetadata& metadata, std::span<const ImageLayer> layers) {
    Imf::Header header(image.width, image.height);
    header.compression() = Imf::ZIP_COMPRESSION;
    Imf::addChromaticities(header, Imf::Chromaticities());  // Rec. 709 primaries, D65
    insert_metadata(metadata, header);
    for (const char* name : channel_names) header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    Imf::FrameBuffer buffer = frame_buffer(image, header.dataWindow());
    for (const ImageLayer& layer : layers) insert_layer(layer, image, buffer, header);
    ByteSink sink;
    {
        Imf::OutputFile file(sink, header);
        file.setFrameBuffer(buffer);
        file.writePixels(image.height);
    }  // completes the table of line offsets
    return sink.release();
}

Image read_exr(const std::filesystem::path& path, std::int64_t max_pixels) {
    Imf::InputFile file(path.c_str());
    const Imath::Box2i window = file.header().dataWindow();
    require_allowed_size(std::int64_t{window.max.x} - window.min.x + 1, std::int64_t{window.max.y} - window.min.y + 1,
                         max_pixels);
    require_channels(file.header().channels());
    Image image(window.max.x - window.min.x + 1, window.max.y - window.min.y + 1);
    file.setFrameBuffer(frame_buffer(image, window));
    file.readPixels(window.min.y, window.max.y);
    return image;
}

std::optional<float> read_exr_field_of_view(const std::filesystem::path& path) {
    const Imf::InputFile file(path.c_str());
    const auto* fov = file.header().findTypedAttribute<Imf::FloatAttribute>(fov_attribute);
    if (!fov) return std::nullopt;
    if (!(fov->value() > 0 && fov->value() < 180))
        throw std::runtime_error(
            fmt::format("its {} is {}, expected above 0 and below 180 degrees", fov_attribute, fov->value()));
    return fov->value();
}

}  // namespace interflect::detail::codecs
