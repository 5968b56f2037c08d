#include "film/cryptomatte.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <map>
#include <utility>

namespace keyhole {
namespace {

std::uint32_t scrambled(std::uint32_t k) { return std::rotl(k * 0xCC9E2D51u, 15) * 0x1B873593u; }

std::uint32_t byte_at(std::string_view text, std::size_t i) { return static_cast<unsigned char>(text[i]); }

/// A name as a string of JSON.
std::string quoted(std::string_view name) {
    std::string text = "\"";
    for (const char c : name) {
        if (c == '"' || c == '\\')
            text += {'\\', c};
        else if (static_cast<unsigned char>(c) < 0x20)
            text += fmt::format("\\u{:04x}", c);
        else
            text += c;
    }
    return text + '"';
}

} // namespace

std::uint32_t murmur3_32(std::string_view text) {
    std::uint32_t h = 0;
    const std::size_t whole = text.size() / 4 * 4;
    for (std::size_t i = 0; i < whole; i += 4) {
        const std::uint32_t k =
            byte_at(text, i) | byte_at(text, i + 1) << 8 | byte_at(text, i + 2) << 16 | byte_at(text, i + 3) << 24;
        h = std::rotl(h ^ scrambled(k), 13) * 5 + 0xE6546B64u;
    }
    std::uint32_t rest = 0;
    for (std::size_t i = text.size(); i-- > whole;) rest = rest << 8 | byte_at(text, i);
    h ^= scrambled(rest);
    h ^= static_cast<std::uint32_t>(text.size());
    h = (h ^ h >> 16) * 0x85EBCA6Bu;
    h = (h ^ h >> 13) * 0xC2B2AE35u;
    return h ^ h >> 16;
}

std::uint32_t cryptomatte_id(std::string_view name) {
    const std::uint32_t hash = murmur3_32(name), exponent = hash >> 23 & 255;
    return exponent == 0 || exponent == 255 ? hash ^ 1u << 23 : hash;
}

CryptomatteLayers::CryptomatteLayers(std::string type, int width, int height)
    : type_(std::move(type)), layers_(kLayers, Image(width, height, 4)) {}

void CryptomatteLayers::set(int x, int y, std::span<std::int64_t> samples, const std::vector<std::uint32_t>& ids) {
    struct Share {
        std::size_t count;
        std::int64_t name;
    };
    std::vector<Share> shares;
    std::ranges::sort(samples);
    for (std::size_t begin = 0, end = 0; begin < samples.size(); begin = end) {
        while (end < samples.size() && samples[end] == samples[begin]) ++end;
        if (samples[begin] >= 0) shares.push_back({end - begin, samples[begin]});
    }
    std::ranges::stable_sort(shares, std::ranges::greater{}, &Share::count);
    for (std::size_t rank = 0; rank < std::min<std::size_t>(shares.size(), 2 * kLayers); ++rank) {
        float* at = layers_[rank / 2].at(x, y) + rank % 2 * 2;
        at[0] = std::bit_cast<float>(ids[static_cast<std::size_t>(shares[rank].name)]);
        at[1] = static_cast<float>(shares[rank].count) / static_cast<float>(samples.size());
    }
}

void CryptomatteLayers::add_to(Picture& picture, const std::vector<std::string>& names) && {
    for (std::size_t i = 0; i < layers_.size(); ++i)
        picture.layers[fmt::format("{}{:02}", type_, i)] = std::move(layers_[i]);
    std::map<std::string_view, std::uint32_t> ids;
    for (const std::string& name : names) ids[name] = cryptomatte_id(name);
    std::string manifest;
    for (const auto& [name, id] : ids)
        manifest += fmt::format("{}{}:\"{:08x}\"", manifest.empty() ? "" : ",", quoted(name), id);
    const std::string prefix = fmt::format("cryptomatte/{:08x}", murmur3_32(type_)).substr(0, 19) + "/";
    picture.metadata[prefix + "name"] = type_;
    picture.metadata[prefix + "hash"] = "MurmurHash3_32";
    picture.metadata[prefix + "conversion"] = "uint32_to_float32";
    picture.metadata[prefix + "manifest"] = "{" + manifest + "}";
}

bool is_mask(std::string_view layer) { return layer == "alpha" || layer.starts_with("Crypto"); }

void copy_masks(const Picture& from, Picture& picture) {
    for (const auto& [name, image] : from.layers)
        if (is_mask(name)) picture.layers[name] = image;
}

} // namespace keyhole
