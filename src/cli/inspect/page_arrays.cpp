#include "cli/inspect/page_arrays.h"

#include "core/base64.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <new>

namespace keyhole {
namespace {

/// A non-negative number in 16 bits, by its logarithm: 0, or 2^(code / 1024 - 32) to 0.04 %.
std::uint16_t logarithmic(double value) {
    if (!(value > 0)) return 0;
    return static_cast<std::uint16_t>(std::clamp(std::lround(1024 * (std::log2(value) + 32)), 1L, 65535L));
}

std::vector<std::uint8_t> bytes_of_colours(const SurfaceMesh& mesh) {
    std::vector<std::uint8_t> bytes;
    for (const auto& colour : mesh.colours) bytes.insert(bytes.end(), colour.begin(), colour.end());
    return bytes;
}

void add_surface(const SurfaceMesh& mesh, const PlaceCode& code, BinaryData& data) {
    // Openings snap to corners of meshes: a page that isn't crowded has them as they are.
    constexpr std::size_t kCrowd = 100'000;
    std::vector<std::uint16_t> coded;
    std::vector<float> exact;
    for (const Vec3& p : mesh.positions)
        if (mesh.positions.size() > kCrowd)
            code.encode(p, coded);
        else
            exact.insert(exact.end(), {p.x, p.y, p.z});
    std::vector<std::uint32_t> indices;
    for (const auto& t : mesh.triangles) indices.insert(indices.end(), t.begin(), t.end());
    if (exact.empty())
        data.add("surface", coded);
    else
        data.add("surface", exact);
    data.add("surfaceColours", bytes_of_colours(mesh));
    data.add("triangles", indices);
}

/// As they stand in the maps, bit by bit: places and power.
void add_photons(const PhotonSample& sample, BinaryData& data) {
    std::vector<float> places, powers;
    std::vector<std::int16_t> directions;
    std::vector<std::int8_t> normals;
    std::vector<std::int32_t> trails;
    std::vector<std::uint16_t> emitters;
    std::vector<std::uint8_t> scatterings, kinds;
    for (const PhotonShown& p : sample.photons) {
        const Vec3 at = p.photon.position(), w = p.photon.direction();
        const Rgb power = p.photon.power();
        const Vec3 n = p.photon.normal().decode();
        for (int i = 0; i < 3; ++i) {
            places.push_back(at[i]);
            powers.push_back(static_cast<float>(power[i]));
            normals.push_back(static_cast<std::int8_t>(std::lround(127 * std::clamp(n[i], -1.0f, 1.0f))));
            directions.push_back(static_cast<std::int16_t>(std::lround(32767 * std::clamp(w[i], -1.0f, 1.0f))));
        }
        trails.push_back(p.trail);
        emitters.push_back(static_cast<std::uint16_t>(std::min<std::uint32_t>(p.emitter, 65535)));
        scatterings.push_back(static_cast<std::uint8_t>(p.scatterings < 0 ? 255 : std::min(p.scatterings, 254)));
        kinds.push_back(static_cast<std::uint8_t>((p.caustic ? 1 : 0) | (p.guided ? 2 : 0) | (p.gathered ? 0 : 4)));
    }
    data.add("photons", places);
    data.add("photonPowers", powers);
    data.add("photonDirections", directions);
    data.add("photonNormals", normals);
    data.add("photonTrails", trails);
    data.add("photonEmitters", emitters);
    data.add("photonScatterings", scatterings);
    data.add("photonKinds", kinds);
}

void add_trails(const std::vector<PhotonTrail>& trails, const PlaceCode& code, float far, BinaryData& data) {
    std::vector<std::uint32_t> starts{0};
    std::vector<std::uint16_t> points;
    std::vector<std::uint8_t> flags, photons;
    for (const PhotonTrail& trail : trails) {
        for (std::size_t i = 0; i < trail.points.size(); ++i) {
            const TrailPoint& point = trail.points[i];
            const bool away = point.infinite && i + 1 < trail.points.size();
            code.encode(away ? trail.points[i + 1].p + point.p * far : point.p, points);
            flags.push_back(static_cast<std::uint8_t>((point.specular ? 1 : 0) | (point.infinite ? 2 : 0)));
        }
        photons.push_back(static_cast<std::uint8_t>(std::min<std::size_t>(trail.photon, 255)));
        starts.push_back(static_cast<std::uint32_t>(flags.size()));
    }
    data.add("trailStarts", starts);
    data.add("trailPoints", points);
    data.add("trailFlags", flags);
    data.add("trailPhotons", photons);
}

void add_sources(const std::vector<PixelLight::Source>& sources, const PlaceCode& code, std::size_t count,
                 std::vector<std::uint16_t>& to) {
    for (std::size_t i = 0; i < count; ++i) {
        const bool any = i < sources.size();
        code.encode(any ? sources[i].p : code.lower, to);
        to.push_back(any ? logarithmic(sources[i].value) : std::uint16_t{0});
    }
}

void add_ends(const std::vector<PixelLight::GatherEnd>& ends, const PlaceCode& code, std::size_t count,
              std::vector<std::uint16_t>& to) {
    for (std::size_t i = 0; i < count; ++i) {
        const PixelLight::GatherEnd end = i < ends.size() ? ends[i] : PixelLight::GatherEnd{{code.lower, 0}};
        code.encode(end.p, to);
        to.push_back(logarithmic(end.value));
        code.encode(end.lamp, to);
        to.push_back(logarithmic(end.from_lamp));
        to.push_back(static_cast<std::uint16_t>(std::min<std::uint32_t>(end.emitter, 65535)));
    }
}

/// Of each pixel as many lamps as any has, and as many directions of each.
void add_lamps(const std::vector<PixelLight>& pixels, BinaryData& data) {
    std::size_t lamps = 0, directions = 0;
    for (const PixelLight& pixel : pixels) {
        lamps = std::max(lamps, pixel.lamps.size());
        for (const EmitterChance& lamp : pixel.lamps) directions = std::max(directions, lamp.towards.size());
    }
    std::vector<std::uint16_t> chances;
    std::vector<std::int8_t> towards;
    for (const PixelLight& pixel : pixels)
        for (std::size_t i = 0; i < lamps; ++i) {
            const EmitterChance lamp = i < pixel.lamps.size() ? pixel.lamps[i] : EmitterChance{65535, 0};
            chances.push_back(static_cast<std::uint16_t>(std::min<std::uint32_t>(lamp.emitter, 65535)));
            chances.push_back(static_cast<std::uint16_t>(std::lround(65535 * std::clamp(lamp.probability, 0.0, 1.0))));
            for (std::size_t k = 0; k < directions; ++k) {
                const Vec3 w = k < lamp.towards.size() ? lamp.towards[k] : Vec3(0);
                for (int axis = 0; axis < 3; ++axis)
                    towards.push_back(static_cast<std::int8_t>(std::lround(127 * std::clamp(w[axis], -1.0f, 1.0f))));
            }
        }
    data.add("pixelLamps", chances);
    data.add("pixelTowards", towards);
}

void add_pixels(const std::vector<PixelLight>& pixels, const PlaceCode& code, BinaryData& data) {
    std::vector<std::uint32_t> starts{0};
    std::vector<std::uint16_t> trails, gather, direct;
    std::vector<std::uint8_t> seen;
    std::vector<float> reach;
    std::size_t of_gather = 0, of_direct = 0;
    for (const PixelLight& pixel : pixels) {
        of_gather = std::max(of_gather, pixel.gather.size());
        of_direct = std::max(of_direct, pixel.direct.size());
    }
    for (const PixelLight& pixel : pixels) {
        for (const Vec3& p : pixel.trail) code.encode(p, trails);
        starts.push_back(static_cast<std::uint32_t>(trails.size() / 3));
        add_ends(pixel.gather, code, of_gather, gather);
        add_sources(pixel.direct, code, of_direct, direct);
        seen.push_back(pixel.seen ? 1 : 0);
        reach.push_back(pixel.reach);
    }
    data.add("pixelStarts", starts);
    data.add("pixelTrails", trails);
    data.add("pixelGather", gather);
    data.add("pixelDirect", direct);
    data.add("pixelSeen", seen);
    data.add("pixelReach", reach);
    add_lamps(pixels, data);
}

void add_places(const Inspection& inspection, const PlaceCode& surface, BinaryData& data) {
    std::vector<std::uint16_t> importons, records, refused;
    std::vector<float> figures;
    for (const Inspection::Importon& p : inspection.importons) {
        surface.encode(p.p, importons);
        importons.push_back(logarithmic(p.value));
    }
    for (const Inspection::Record& r : inspection.records) {
        surface.encode(r.p, records);
        surface.encode(r.p + r.n * r.radius, records);
        for (const float x : {r.radius, r.noise, r.irradiance}) figures.push_back(std::isfinite(x) ? x : 0);
    }
    for (const Vec3& p : inspection.photons.refused_at) surface.encode(p, refused);
    data.add("importons", importons);
    data.add("records", records);
    data.add("recordFigures", figures);
    data.add("refused", refused);
}

/// Luminance of the layers that the picture is the sum of, of both renders, and its colour.
void add_layers(const Inspection& inspection, BinaryData& data) {
    for (const auto& [render, end] : {std::pair(&inspection.render, "A"), {&inspection.again, "B"}})
        for (const char* name : {"direct", "indirect", "caustic"}) {
            const Image& layer = render->picture.layers.at(name);
            std::vector<float> values;
            for (std::size_t i = 0; i < layer.data.size(); i += 3)
                values.push_back(static_cast<float>(luminance({layer.data[i], layer.data[i + 1], layer.data[i + 2]})));
            data.add(std::string(name) + end, values);
        }
}

} // namespace

nlohmann::ordered_json BinaryData::json() const {
    uLongf size = compressBound(bytes_.size());
    std::string small(size, '\0');
    if (compress2(reinterpret_cast<Bytef*>(small.data()), &size, reinterpret_cast<const Bytef*>(bytes_.data()),
                  bytes_.size(), 9) != Z_OK)
        throw std::bad_alloc();
    small.resize(size);
    return {{"arrays", directory_}, {"deflated", to_base64(small)}};
}

void PlaceCode::encode(const Vec3& p, std::vector<std::uint16_t>& to) const {
    for (int i = 0; i < 3; ++i) {
        const float width = upper[i] - lower[i], t = width > 0 ? (p[i] - lower[i]) / width : 0;
        to.push_back(static_cast<std::uint16_t>(std::lround(65535 * std::clamp(t, 0.0f, 1.0f))));
    }
}

nlohmann::ordered_json PlaceCode::json() const {
    return {{"lower", {lower.x, lower.y, lower.z}}, {"upper", {upper.x, upper.y, upper.z}}};
}

void add_arrays(const Inspection& inspection, const PlaceCode& surface, const PlaceCode& air, float far,
                BinaryData& data) {
    add_surface(inspection.surface, surface, data);
    add_photons(inspection.photons, data);
    add_trails(inspection.photons.trails, air, far, data);
    add_pixels(inspection.pixels, air, data);
    add_places(inspection, surface, data);
    add_layers(inspection, data);
}

} // namespace keyhole
