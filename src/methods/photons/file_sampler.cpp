// Photons from a file.
#include "core/error.h"
#include "methods/photons/memory_plan.h"
#include "methods/photons/photon_file.h"
#include "methods/photons/photon_sampler.h"

#include <fmt/format.h>

namespace keyhole {
namespace {

class FileSampler final : public PhotonSampler {
  public:
    explicit FileSampler(const SamplerContext& context) : c_(context) {}

    Photons sample(std::uint64_t /*seed*/, RenderStats& stats, const RunContext& /*context*/) override {
        Photons photons = load_photons(c_.settings.load_map, photon_file_key(c_.scene, c_.settings, c_.coverage));
        if (const std::size_t held = plan_memory(c_.settings, ImportanceUse::none, 2).photons,
            found = photons.global.size() + photons.caustic.size();
            found > held && c_.settings.photons == 0)
            stats.warnings.push_back(fmt::format("{}: {} photons, where photon_memory holds {}: the map takes more "
                                                 "memory than it may",
                                                 c_.settings.load_map, found, held));
        return photons;
    }

  private:
    SamplerContext c_;
};

} // namespace

std::unique_ptr<PhotonSampler> make_file_sampler(const SamplerContext& context) {
    if (context.settings.passes != 1)
        throw InputError("a saved photon map is one pass: expected passes=1 with --load-map");
    return std::make_unique<FileSampler>(context);
}

} // namespace keyhole
