#include "methods/photons/photon_file.h"

#include "core/bytes.h"
#include "core/error.h"
#include "film/files/atomic_file.h"
#include "methods/photons/find_coverage.h"
#include "sampling/scene_hash.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <span>
#include <type_traits>

namespace keyhole {
namespace {

constexpr std::array<char, 8> kMagic{'K', 'H', 'P', 'H', 'O', 'T', 'O', 'N'};
constexpr std::uint32_t kVersion = 11; ///< raised when a map changes; blender/keyhole/photons.py reads it as well
constexpr std::uint32_t kByteOrder = 0x01020304;

constexpr std::size_t kParts = 4;
/// The parts in the order of the file.
auto parts(auto& photons) {
    return std::array{&photons.global.pilots, &photons.global.main_photons, &photons.caustic.pilots,
                      &photons.caustic.main_photons};
}

struct Header {
    std::array<char, 8> magic = kMagic;
    std::uint32_t byte_order = kByteOrder;
    std::uint32_t version = kVersion;
    std::uint64_t scene = 0;
    std::int64_t max_scatterings = 0;
    std::int64_t coverage = 0;
    std::array<std::uint64_t, kParts> photons{};
    std::uint64_t everywhere = 0; ///< Photons::everywhere, as 0 or 1
    std::int32_t width = 0, height = 0;
    std::uint64_t checksum = 0; ///< of all that stands before it and behind it
};
static_assert(std::is_trivially_copyable_v<Header> && sizeof(Header) == 96);

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
    throw InputError(fmt::format("{}: {}", path, why));
}

std::ifstream opened(const std::string& path) {
    std::ifstream file(path, std::ios::binary | std::ios::ate);
    if (!file) refuse(path, fmt::format("cannot be opened: {}", std::strerror(errno)));
    return file;
}

Header read_header(std::ifstream& file, const std::string& path) {
    Header header;
    file.seekg(0);
    if (!file.read(reinterpret_cast<char*>(&header), sizeof header) || header.magic != kMagic)
        refuse(path, "found no photon map, expected a file that --save-map wrote");
    return header;
}

/// Whether two pictures show the same of a scene, as far as sides can that are whole pixels of the smaller one.
bool have_one_shape(const Header& a, const PhotonFileKey& b) {
    const auto product = [](std::int64_t x, std::int64_t y) { return x * y; };
    const std::int64_t sides = std::max(std::int64_t{a.width} + a.height, std::int64_t{b.width} + b.height);
    return 2 * std::abs(product(a.width, b.height) - product(b.width, a.height)) <= sides;
}

void check(const std::string& path, const Header& found, const PhotonFileKey& key) {
    if (found.byte_order != kByteOrder) refuse(path, "found a photon map from a machine of another byte order");
    if (found.version != kVersion)
        refuse(path, fmt::format("found a photon map of version {}, expected version {}", found.version, kVersion));
    if (found.scene != key.scene)
        refuse(path, "found the photon map of another scene, camera included; expected that of the scene to render");
    if (found.max_scatterings != key.max_scatterings)
        refuse(path, fmt::format("found a photon map made with max_depth={}, expected max_depth={}",
                                 found.max_scatterings, key.max_scatterings));
    if (found.coverage != key.coverage)
        refuse(path,
               found.coverage == 0
                   ? "found a photon map with nothing outside the coverage of gather rays (as pm makes it), expected "
                     "one with that; set gather_coverage=false to use it"
                   : "found a photon map with light outside the coverage of gather rays, expected the settings "
                     "gather_coverage, plan and importons that it was made with");
    // Photons outside the coverage of gather rays alone lie where the eye asked for them as well.
    const bool everywhere = found.everywhere != 0 && found.coverage == 0;
    if (!everywhere && !have_one_shape(found, key))
        refuse(path, fmt::format("found the photon map of a picture of {}x{}, whose photons lie where the eye asks for "
                                 "them; expected one of the shape of {}x{}",
                                 found.width, found.height, key.width, key.height));
}

void read(std::ifstream& file, std::span<char> into, const std::string& path) {
    file.read(into.data(), static_cast<std::streamsize>(into.size()));
    if (!file) refuse(path, "cannot be read");
}

std::uint64_t checksum(Header header, const Photons& photons) {
    header.checksum = 0;
    Hash hash;
    hash.add(header); // numbers of photons among it: else some of one part may count for the next
    for (const auto* part : parts(photons)) hash.add(*part);
    return hash.value();
}

std::vector<Photon> read_photons(std::ifstream& file, const std::string& path, std::uint64_t count) {
    std::vector<Photon> photons(count, Photon({0, 0, 0}, {0, 0, 1}, {0, 0, 1}, Rgb(0.0)));
    read(file, bytes_of(photons.data(), count), path);
    return photons;
}

} // namespace

PhotonFileKey photon_file_key(const Scene& scene, const Settings& settings, const GatherCoverage* coverage) {
    const ImageWindow& window = scene.camera().window();
    return {scene_hash(scene), settings.max_depth, coverage != nullptr ? coverage_paths(settings) : 0, window.width,
            window.height};
}

void save_photons(const std::string& path, const PhotonFileKey& key, const Photons& photons) {
    Header header;
    header.scene = key.scene;
    header.max_scatterings = key.max_scatterings;
    header.coverage = key.coverage;
    header.width = key.width;
    header.height = key.height;
    for (std::size_t i = 0; i < kParts; ++i) header.photons[i] = parts(photons)[i]->size();
    header.everywhere = photons.everywhere ? 1 : 0;
    header.checksum = checksum(header, photons);
    std::vector<std::span<const char>> bytes{bytes_of(&header)};
    for (const auto* part : parts(photons)) bytes.push_back(bytes_of(part->data(), part->size()));
    write_file_atomically(path, bytes); // a copy of them all would go beyond the memory that they may take
}

void check_photon_file(const std::string& path) {
    std::ifstream file = opened(path);
    read_header(file, path);
}

Photons load_photons(const std::string& path, const PhotonFileKey& key) {
    std::ifstream file = opened(path);
    const auto size = static_cast<std::uint64_t>(file.tellg());
    const Header header = read_header(file, path);
    check(path, header, key);
    const std::uint64_t most = (size - sizeof header) / sizeof(Photon);
    std::uint64_t all = 0;
    for (const std::uint64_t n : header.photons) all += std::min(n, most + 1); // no sum may wrap around
    if (size != sizeof header + all * sizeof(Photon))
        refuse(path,
               fmt::format("found {} bytes where the header promises {} photons: the file is damaged", size, all));
    Photons photons;
    photons.everywhere = header.everywhere != 0;
    for (std::size_t i = 0; i < kParts; ++i) *parts(photons)[i] = read_photons(file, path, header.photons[i]);
    if (checksum(header, photons) != header.checksum)
        refuse(path, "the photons are not those that were saved: the file is damaged");
    return photons;
}

} // namespace keyhole
