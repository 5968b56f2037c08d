#include "film/files/exr.h"

#include "core/bytes.h"
#include "core/error.h"
#include "film/files/atomic_file.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace keyhole {
namespace {

constexpr std::string_view kSums = "sums.";

std::string_view last_part(std::string_view channel) {
    const auto dot = channel.rfind('.');
    return dot == std::string_view::npos ? channel : channel.substr(dot + 1);
}

std::string_view letters(std::string_view layer, int channels) {
    if (layer.starts_with("noise.")) layer.remove_prefix(6); // has the channels of what it is the noise of
    switch (channels) {
    case 1:
        if (layer == "alpha") return "A";
        return layer == "depth" ? "Z" : "Y";
    case 3:
        return layer == "normal" ? "XYZ" : "RGB";
    case 4:
        return "RGBA";
    default:
        return "";
    }
}

/// The channels of a layer of `channels` channels, in order; empty for a number that has no names.
std::vector<std::string> exr_channel_names(const std::string& layer, int channels) {
    const std::string prefix = layer == "beauty" || layer == "alpha" ? "" : layer + ".";
    std::vector<std::string> names;
    for (const char letter : letters(layer, channels)) names.push_back(prefix + letter);
    return names;
}

/// The layer that a channel of a file belongs to: what stands before the last dot; "beauty" for R, G, B, A and Y
/// without one, the name itself for other channels without one.
std::string exr_layer_of(const std::string& channel) {
    const auto dot = channel.rfind('.');
    if (dot != std::string::npos) return channel.substr(0, dot);
    return channel.size() == 1 && std::string_view("RGBAY").find(channel[0]) != std::string_view::npos ? "beauty"
                                                                                                       : channel;
}

/// Sorts channels of one layer as they are stored in an Image: R, G, B, A or X, Y, Z; others by name.
void sort_exr_channels(std::vector<std::string>& channels) {
    constexpr std::string_view kOrder = "RGBAXYZ";
    std::ranges::sort(channels, {}, [&](const std::string& channel) {
        const std::string_view part = last_part(channel);
        return std::pair(part.size() == 1 ? kOrder.find(part[0]) : std::string_view::npos, channel);
    });
}

/// The channel of word `w` of sums (Picture::sums), whether a channel is one, and of which kind.
std::string exr_sum_name(const std::string& kind, int w) { return fmt::format("{}{}.{:03}", kSums, kind, w); }

bool is_exr_sum(std::string_view channel) { return channel.starts_with(kSums); }

std::string exr_sum_kind(const std::string& channel) {
    return channel.substr(kSums.size(), channel.rfind('.') - kSums.size());
}

/// The most pixels that a picture may have; scene files have the same bound.
constexpr std::int64_t kMostPixels = std::int64_t{1} << 28;

/// OpenEXR writes to memory, so that all that can fail on a disk lies in write_file_atomically().
class MemoryStream final : public Imf::OStream {
  public:
    MemoryStream() : OStream("memory") {}
    void write(const char c[], int n) override {
        const auto end = position_ + static_cast<std::size_t>(n);
        if (end > bytes_.size()) bytes_.resize(end);
        std::memcpy(bytes_.data() + position_, c, static_cast<std::size_t>(n));
        position_ = end;
    }
    uint64_t tellp() override { return position_; }
    void seekp(uint64_t position) override { position_ = position; }
    const std::string& bytes() const { return bytes_; }

  private:
    std::string bytes_;
    std::size_t position_ = 0;
};

/// Channel `c` of an image whose first pixel lies at (x0, y0) of the file.
Imf::Slice slice(Image& image, std::size_t c, int x0, int y0) {
    const auto stride = static_cast<std::size_t>(image.channels) * sizeof(float);
    const std::size_t row = stride * static_cast<std::size_t>(image.width);
    char* base = reinterpret_cast<char*>(image.data.data() + c);
    // Signed, because a data window may start anywhere.
    base -= static_cast<std::ptrdiff_t>(stride) * x0 + static_cast<std::ptrdiff_t>(row) * y0;
    return {Imf::FLOAT, base, stride, row};
}

constexpr const char* kSumsHash = "hash of sums";

std::string hash_of(const std::map<std::string, AccumulatorState>& sums) {
    Hash hash;
    for (const auto& [kind, words] : sums) hash.add(words.data);
    return fmt::format("{:016x}", hash.value());
}

/// Word `w` of sums, in a file whose first pixel lies at the origin.
Imf::Slice word_slice(AccumulatorState& sums, int w, int width) {
    const auto stride = static_cast<std::size_t>(sums.words) * sizeof(std::uint32_t);
    return {Imf::UINT, reinterpret_cast<char*>(sums.data.data() + w), stride, stride * static_cast<std::size_t>(width)};
}

void encode(Imf::OStream& stream, const Picture& picture) {
    Imf::Header header(picture.width, picture.height);
    // Sums compress badly by any means, and there are many of them.
    header.compression() = picture.sums.empty() ? Imf::ZIP_COMPRESSION : Imf::RLE_COMPRESSION;
    for (const auto& [key, value] : picture.metadata) header.insert(key, Imf::StringAttribute(value));
    Imf::FrameBuffer buffer;
    for (const auto& [layer, image] : picture.layers) {
        const auto names = exr_channel_names(layer, image.channels);
        if (names.empty() || image.width != picture.width || image.height != picture.height)
            throw std::invalid_argument(
                fmt::format("layer '{}' has {} channels of {} x {}", layer, image.channels, image.width, image.height));
        for (std::size_t c = 0; c < names.size(); ++c) {
            header.channels().insert(names[c], Imf::Channel(Imf::FLOAT));
            // OpenEXR has one kind of slice for reading and writing; it does not write to this one.
            buffer.insert(names[c], slice(const_cast<Image&>(image), c, 0, 0));
        }
    }
    if (!picture.sums.empty()) header.insert(kSumsHash, Imf::StringAttribute(hash_of(picture.sums)));
    for (const auto& [kind, sums] : picture.sums) {
        for (int w = 0; w < sums.words; ++w) {
            header.channels().insert(exr_sum_name(kind, w), Imf::Channel(Imf::UINT));
            buffer.insert(exr_sum_name(kind, w), word_slice(const_cast<AccumulatorState&>(sums), w, picture.width));
        }
    }
    Imf::OutputFile file(stream, header);
    file.setFrameBuffer(buffer);
    file.writePixels(picture.height);
}

std::map<std::string, std::vector<std::string>> layers_of(const Imf::ChannelList& channels) {
    std::map<std::string, std::vector<std::string>> layers;
    for (auto c = channels.begin(); c != channels.end(); ++c) {
        if (c.channel().xSampling != 1 || c.channel().ySampling != 1)
            throw InputError(
                fmt::format("found the subsampled channel '{}', expected all at full resolution", c.name()));
        if (!is_exr_sum(c.name())) layers[exr_layer_of(c.name())].emplace_back(c.name());
    }
    if (auto& beauty = layers["beauty"]; beauty.size() > 1 && std::erase(beauty, "A") > 0) layers["alpha"] = {"A"};
    std::erase_if(layers, [](const auto& layer) { return layer.second.empty(); });
    for (auto& [layer, names] : layers) sort_exr_channels(names);
    return layers;
}

/// Makes room for the sums of a file and has them read to it.
void expect_sums(const Imf::Header& header, Picture& picture, Imf::FrameBuffer& buffer) {
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c)
        if (is_exr_sum(c.name())) ++picture.sums[exr_sum_kind(c.name())].words;
    for (auto& [kind, sums] : picture.sums) {
        sums.data.resize(static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height) *
                         static_cast<std::size_t>(sums.words));
        for (int w = 0; w < sums.words; ++w) buffer.insert(exr_sum_name(kind, w), word_slice(sums, w, picture.width));
    }
}

std::map<std::string, std::string> metadata_of(const Imf::Header& header) {
    std::map<std::string, std::string> metadata;
    for (auto a = header.begin(); a != header.end(); ++a)
        if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&a.attribute()))
            metadata[a.name()] = text->value();
    return metadata;
}

Picture decode(Imf::InputFile& file) {
    const Imf::Header& header = file.header();
    const auto& window = header.dataWindow();
    const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1,
                       height = std::int64_t{window.max.y} - window.min.y + 1;
    if (width < 1 || height < 1 || width > kMostPixels / height)
        throw InputError(fmt::format("found {} x {} pixels, expected at most 2^28", width, height));
    Picture picture;
    picture.width = static_cast<int>(width);
    picture.height = static_cast<int>(height);
    Imf::FrameBuffer buffer;
    for (const auto& [layer, names] : layers_of(header.channels())) {
        Image& image = picture.layers[layer] = Image(picture.width, picture.height, static_cast<int>(names.size()));
        for (std::size_t c = 0; c < names.size(); ++c)
            buffer.insert(names[c], slice(image, c, window.min.x, window.min.y));
    }
    // Only what write_exr() wrote starts at the origin and has sums.
    if (window.min.x == 0 && window.min.y == 0) expect_sums(header, picture, buffer);
    picture.metadata = metadata_of(header);
    file.setFrameBuffer(buffer);
    file.readPixels(window.min.y, window.max.y);
    if (!picture.sums.empty() && !picture.metadata.contains(kSumsHash))
        throw InputError("found sums that another version of the program wrote, expected those of this version");
    if (!picture.sums.empty() && picture.metadata[kSumsHash] != hash_of(picture.sums))
        throw InputError("found sums that are not those that were written: the file is damaged");
    picture.metadata.erase(kSumsHash);
    return picture;
}

/// What OpenEXR says, without the file's name, on one line.
std::string reason(const std::exception& e) {
    std::string text = e.what();
    if (const auto end = text.find("\". "); end != std::string::npos) text.erase(0, end + 3);
    for (char& c : text)
        if (c == '\n') c = ' ';
    return text;
}

/// What `take` makes of a file.
template <class Take> auto read(const std::string& path, const Take& take) {
    // Asked first because the system knows better words for it than OpenEXR.
    if (errno = 0; !std::ifstream(path).good())
        throw InputError(fmt::format("{}: cannot read: {}", path, std::strerror(errno)));
    try {
        Imf::InputFile file(path.c_str());
        return take(file);
    } catch (const std::exception& e) {
        throw InputError(fmt::format("{}: cannot read: {}", path, reason(e)));
    }
}

} // namespace

void write_exr(const std::string& path, const Picture& picture) {
    MemoryStream stream;
    try {
        encode(stream, picture);
    } catch (const std::exception& e) {
        throw InputError(fmt::format("{}: cannot write: {}", path, reason(e)));
    }
    write_file_atomically(path, stream.bytes());
}

Picture read_exr(const std::string& path) {
    return read(path, [](Imf::InputFile& file) { return decode(file); });
}

std::map<std::string, std::string> read_exr_metadata(const std::string& path) {
    return read(path, [](Imf::InputFile& file) { return metadata_of(file.header()); });
}

} // namespace keyhole
