// `MakeNamedMedium`.
#include "scene/load/pbrt/properties.h"
#include "scene/materials/measured_media.h"

#include <fmt/format.h>

#include <array>
#include <string>
#include <vector>

namespace keyhole::pbrt {
namespace {

constexpr int kMostCells = 1 << 27;

void read_coefficients(Parameters& p, Rgb absorption, Rgb scattering, Medium& medium) {
    if (const std::string preset = p.string("preset", ""); !preset.empty()) {
        const auto found = measured_media().find(preset);
        if (found == measured_media().end()) p.fail(unknown_name("medium", preset, measured_media()));
        absorption = found->second.absorption;
        scattering = found->second.reduced_scattering;
    }
    // v3 and v4 measure in inverse units of the scene; v4 calls the factor 'scale'.
    const double scale = p.number("scale", 1, kNotNegative);
    medium.absorption = p.spectrum("sigma_a", absorption, ColorUse::index) * scale;
    medium.scattering = p.spectrum("sigma_s", scattering, ColorUse::index) * scale;
    medium.anisotropy = static_cast<float>(p.number("g", 0, {-0.9999, 0.9999}));
}

std::shared_ptr<const DensityGrid> read_density(Parameters& p, const Transform& to_world) {
    DensityGrid::Values values;
    std::int64_t cells = 1;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::int64_t n = p.integer(std::array{"nx", "ny", "nz"}[i], 1, 1, kMostCells);
        values.size[i] = static_cast<int>(n);
        cells *= n;
        if (cells > kMostCells) p.fail(fmt::format("found more than {} densities, expected fewer", kMostCells));
    }
    const std::vector<double> given = p.numbers("density", {"float"});
    if (static_cast<std::int64_t>(given.size()) != cells)
        p.fail(fmt::format("found {} numbers in 'density', expected nx ny nz = {}", given.size(), cells));
    values.density.reserve(given.size());
    for (const double d : given) {
        if (!(d >= 0 && d <= 1e30)) p.fail(fmt::format("found the density {}, expected 0 to 1e30", d));
        values.density.push_back(static_cast<float>(d));
    }
    const Imath::Box3d box(p.point("p0", Imath::V3d(0.0)), p.point("p1", Imath::V3d(1.0)));
    const Imath::V3d extent = box.size();
    if (!(extent.x > 0 && extent.y > 0 && extent.z > 0)) p.fail("expected 'p1' to be beyond 'p0' along each axis");
    try {
        return std::make_shared<const DensityGrid>(std::move(values), box, to_world);
    } catch (const InputError& e) {
        p.fail(e.what());
    }
}

} // namespace

void define_medium(Parameters& p, Library& library, const Transform& to_world) {
    const std::string type = p.string("type", "");
    MediumEntry entry;
    Medium medium;
    // v3 calls the latter heterogeneous.
    const bool grid = type == "uniformgrid" || type == "heterogeneous";
    if (grid || type == "homogeneous") {
        if (grid) medium.density = read_density(p, to_world);
        if (type == "uniformgrid")
            read_coefficients(p, Rgb(1.0), Rgb(1.0), medium);
        else // pbrt's own
            read_coefficients(p, {0.0011, 0.0024, 0.014}, {2.55, 3.21, 3.77}, medium);
        if (!is_black(p.spectrum("Le", Rgb(0.0), ColorUse::light)) || p.has("temperature"))
            entry.refusal = "found a medium that emits, expected one that doesn't";
        p.ignore({"Lescale", "Legrid", "temperaturescale", "temperatureoffset"});
        p.warn_of_the_rest();
    } else {
        entry.refusal = fmt::format("found a medium of type '{}', expected homogeneous or uniformgrid", type);
    }
    if (!is_black(medium.extinction())) entry.medium = std::make_shared<const Medium>(std::move(medium));
    library.media[p.directive().words[0]] = entry;
}

std::shared_ptr<const Medium> find_medium(const Library& library, const std::string& name, const Directive& user) {
    if (name.empty()) return nullptr;
    const MediumEntry& entry = user.look_up(library.media, "medium", name);
    if (!entry.refusal.empty()) user.fail(entry.refusal);
    return entry.medium;
}

} // namespace keyhole::pbrt
