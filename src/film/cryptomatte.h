// Cryptomatte (Friedman and Jones 2015): which object or material covers how much of a pixel.
#pragma once

#include "film/picture.h"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace keyhole {

/// MurmurHash3 (Appleby), x86, 32 bits, seed 0.
std::uint32_t murmur3_32(std::string_view text);

/// The id of a name: its hash, changed in one bit where it would be no ordinary number as a float (specification 1.2).
std::uint32_t cryptomatte_id(std::string_view name);

/// Collects the layers TYPE00, TYPE01, ... of one kind of name, two names and their coverage in each, those that cover
/// most first.
class CryptomatteLayers {
  public:
    static constexpr int kLayers = 3; ///< pairs of names in a pixel, of which most need fewer

    /// @param type of the names, as in "CryptoObject"
    CryptomatteLayers(std::string type, int width, int height);

    /// Sets pixel (x, y): `samples` are indices of `ids`, negative where nothing is, in any order; they are sorted.
    /// Different pixels may be set at once.
    void set(int x, int y, std::span<std::int64_t> samples, const std::vector<std::uint32_t>& ids);

    /// Adds the layers, and the metadata that tell names by id. Names that come several times are one.
    void add_to(Picture& picture, const std::vector<std::string>& names) &&;

  private:
    std::string type_;
    std::vector<Image> layers_;
};

/// Whether a layer tells what covers pixels, and not how bright it is: alpha and Cryptomatte.
bool is_mask(std::string_view layer);

/// Gives `picture` the masks of another of the same scene, in the place of its own.
void copy_masks(const Picture& from, Picture& picture);

} // namespace keyhole
