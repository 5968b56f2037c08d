#include "scene/images/image.h"
#include "core/error.h"
#include "scene/load/properties.h"
#include "scene/texture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace keyhole {
namespace {

double decode(double x, const ImageOptions& options) {
    switch (options.encoding) {
    case Encoding::linear:
        return x;
    case Encoding::gamma:
        return std::pow(x, options.gamma);
    default:
        return srgb_to_linear(x);
    }
}

/// Reads texels of one type. Integers go through a table, so that no lookup needs a power.
template <class Texels> class Decoder {
  public:
    explicit Decoder(const ImageOptions& options) {
        constexpr bool integers = !std::is_same_v<Texels, TextureImage::Floats>;
        if constexpr (integers) {
            constexpr auto most = std::numeric_limits<typename Texels::value_type>::max();
            table_.resize(static_cast<std::size_t>(most) + 1);
            for (std::size_t i = 0; i < table_.size(); ++i)
                table_[i] = static_cast<float>(decode(static_cast<double>(i) / most, options));
        }
    }
    double operator()(typename Texels::value_type x) const {
        if constexpr (std::is_same_v<Texels, TextureImage::Floats>)
            return x;
        else
            return static_cast<double>(table_[x]);
    }

  private:
    std::vector<float> table_;
};

/// Row or column `i` of `n` after wrapping; -1: outside.
int wrapped(std::int64_t i, int n, Wrap wrap) {
    if (i >= 0 && i < n) return static_cast<int>(i);
    if (wrap == Wrap::clamp) return i < 0 ? 0 : n - 1;
    if (wrap == Wrap::black) return -1;
    const std::int64_t r = i % n;
    return static_cast<int>(r < 0 ? r + n : r);
}

template <class T, class Texels> class ImageTexture final : public Texture<T> {
  public:
    ImageTexture(std::shared_ptr<const TextureImage> image, const ImageOptions& options)
        : image_(std::move(image)), texels_(std::get<Texels>(image_->texels)), options_(options), decoder_(options) {}

    T value(const SurfacePoint& point) const override {
        const Imath::V2d place = options_.mapping(point);
        // Texture coordinates past all use, or not numbers, must not become indices.
        if (!(std::abs(place.x) < 1e6) || !(std::abs(place.y) < 1e6)) return T(0);
        return finish(filtered(place.x * image_->width, (1 - place.y) * image_->height));
    }

  private:
    T filtered(double x, double y) const {
        if (options_.filter == Filter::nearest) return texel(column(std::floor(x)), row(std::floor(y)));
        x -= 0.5;
        y -= 0.5;
        const double fx = std::floor(x), fy = std::floor(y), tx = x - fx, ty = y - fy;
        const int left = column(fx), right = column(fx + 1), above = row(fy), below = row(fy + 1);
        return (texel(left, above) * (1 - tx) + texel(right, above) * tx) * (1 - ty) +
               (texel(left, below) * (1 - tx) + texel(right, below) * tx) * ty;
    }

    int column(double x) const { return wrapped(static_cast<std::int64_t>(x), image_->width, options_.wrap); }
    int row(double y) const { return wrapped(static_cast<std::int64_t>(y), image_->height, options_.wrap); }

    /// At what column() and row() say.
    T texel(int x, int y) const {
        if (x < 0 || y < 0) return T(0);
        const auto pixel =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(image_->width) + static_cast<std::size_t>(x);
        const auto* t = &texels_[pixel * static_cast<std::size_t>(image_->channels)];
        if (image_->channels == 1) return T(decoder_(t[0]));
        const Rgb c(decoder_(t[0]), decoder_(t[1]), decoder_(t[2]));
        if constexpr (std::is_same_v<T, Rgb>)
            return c;
        else
            return options_.channel < 0 ? (c.x + c.y + c.z) / 3 : c[options_.channel];
    }

    T finish(T x) const {
        x = x * options_.scale;
        const auto adjust = [&](double c) {
            const double positive = std::max(0.0, c);
            return options_.invert ? 1 - positive : positive;
        };
        if constexpr (std::is_same_v<T, Rgb>)
            return {adjust(x.x), adjust(x.y), adjust(x.z)};
        else
            return adjust(x);
    }

    std::shared_ptr<const TextureImage> image_;
    const Texels& texels_;
    ImageOptions options_;
    Decoder<Texels> decoder_;
};

void read_encoding(Properties& p, ImageOptions& o) {
    if (!p.is_pbrt()) {
        const std::string word = p.choice("encoding", "an encoding", {"automatic", "srgb", "linear", "gamma"});
        if (word == "srgb") o.encoding = Encoding::srgb;
        if (word == "linear" || (word == "automatic" && p.is_normal())) o.encoding = Encoding::linear;
        if (word == "gamma") o.encoding = Encoding::gamma;
        o.gamma = p.number("gamma", {"a gamma", 0.01, 100}, o.gamma);
        return;
    }
    // The value of a gamma stands in the same word.
    const std::string word = p.word("encoding");
    if (word == "sRGB") o.encoding = Encoding::srgb;
    if (word == "linear") o.encoding = Encoding::linear;
    if (word.starts_with("gamma")) {
        o.encoding = Encoding::gamma;
        o.gamma = std::atof(word.c_str() + 5);
        if (!(o.gamma > 0)) p.fail(fmt::format("found the encoding '{}', expected a positive gamma", word));
    }
    if (!word.empty() && o.encoding == Encoding::automatic)
        p.fail(fmt::format("found the encoding '{}', expected sRGB, linear or gamma with a number", word));
    if (!p.boolean("gamma", true)) o.encoding = Encoding::linear; // v3
}

template <class T> std::shared_ptr<const Texture<T>> read_image(Properties& p) {
    const Key file{"file", "filename"};
    const std::string path = p.path(file, "an image");
    ImageOptions o;
    read_encoding(p, o);
    const std::string wrap = p.choice("wrap", "a way to wrap", {"repeat", "black", "clamp"});
    o.wrap = wrap == "black" ? Wrap::black : wrap == "clamp" ? Wrap::clamp : Wrap::repeat;
    // pbrt's other filters are finer than ours.
    const bool nearest = p.is_pbrt() ? p.word("filter") == "point"
                                     : p.choice("filter", "a filter", {"bilinear", "nearest"}) == "nearest";
    o.filter = nearest ? Filter::nearest : Filter::bilinear;
    p.ignore({"maxanisotropy", "trilinear"});
    o.scale = p.number("scale", kFactor, o.scale);
    o.invert = p.boolean("invert", false);
    if (!p.is_pbrt()) {
        constexpr std::array<std::string_view, 5> kChannels{"mean", "red", "green", "blue", "alpha"};
        const std::string channel = p.choice("channel", "a channel", {kChannels.begin(), kChannels.end()});
        o.channel = static_cast<int>(std::ranges::find(kChannels, channel) - kChannels.begin()) - 1;
        if (std::is_same_v<T, Rgb> && o.channel >= 0)
            p.fail_at("channel", "found a channel of a texture of colours, expected it where a number is wanted");
    }
    o.mapping = p.mapping();
    return p.make_at(file, [&] { return image_texture<T>(path, o); });
}

} // namespace

template <class T> TextureKinds<T> image_kinds() {
    return {{{"image", "imagemap"},
             "an image",
             {"file", "channel", "encoding", "gamma", "wrap", "filter", "scale", "invert", "mapping", "transform",
              "repeat", "rotate", "shift"},
             read_image<T>}};
}
template TextureKinds<Rgb> image_kinds();
template TextureKinds<double> image_kinds();

template <class T>
std::shared_ptr<const Texture<T>> image_texture(const std::string& path, const ImageOptions& options) {
    ImageOptions o = options;
    const bool alpha = o.channel == 3;
    if (alpha) o.encoding = Encoding::linear;
    const auto image = load_image(path, alpha ? ImagePart::alpha : ImagePart::colors);
    return std::visit(
        [&](const auto& texels) -> std::shared_ptr<const Texture<T>> {
            using Texels = std::decay_t<decltype(texels)>;
            // As the alpha of pictures without any: the same wherever it is asked, and with no border to fade to.
            if (texels.size() == 1 && o.wrap == Wrap::black) o.filter = Filter::nearest;
            if (texels.size() == 1 && o.wrap != Wrap::black) {
                o.mapping = {};
                return constant_texture(ImageTexture<T, Texels>(image, o).value({}));
            }
            return std::make_shared<ImageTexture<T, Texels>>(image, o);
        },
        image->texels);
}

template ColorTexture image_texture<Rgb>(const std::string&, const ImageOptions&);
template FloatTexture image_texture<double>(const std::string&, const ImageOptions&);

} // namespace keyhole
