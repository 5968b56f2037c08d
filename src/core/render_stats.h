// What a render tells about itself.
#pragma once

#include "core/settings.h"

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace keyhole {

/// A kind of stage. Its time in all passes is about proportional to what a setting says, and to a power of the number
/// of pixels, from one render of a scene to another by the same method.
struct Stage {
    /// What takes the time.
    enum class Work { other, brightness, chains, gather };

    const char* name;
    std::int64_t Settings::*setting = nullptr; ///< null: the settings have no say
    double pixel_power = 0;
    Work work = Work::other;
    /// Bounds of the setting, beyond which the time follows it no more.
    std::int64_t least = 1, most = std::numeric_limits<std::int64_t>::max();
    bool once = false; ///< for all passes
};

/// Those that several methods have.
namespace stages {
inline constexpr Stage brightness{"brightness", &Settings::brightness_samples, 0, Stage::Work::brightness};
inline constexpr Stage seeds{"seeds"};
inline constexpr Stage importance{"importance", &Settings::importons};
inline constexpr Stage tuning{"tuning"};
inline constexpr Stage chains{"chains", &Settings::mutations, 0, Stage::Work::chains};
inline constexpr Stage photons_of_chains{"photons", &Settings::mutations, 0, Stage::Work::chains};
inline constexpr Stage photons_of_light_paths{"photons", &Settings::light_paths};
/// Of precomputed irradiance: it is estimated at a part of the photons.
inline constexpr Stage irradiance{"irradiance", &Settings::photons, 0, Stage::Work::gather};
// Larger pictures have more cached irradiances, for these may lie as close as a few pixels; in rooms most of them
// don't. Where everything is small they do: PhotonQuality::Cache::growth.
inline constexpr Stage cache{"cache", &Settings::cache_rays, 0.25, Stage::Work::gather};
inline constexpr Stage gather{"gather", &Settings::spp, 1, Stage::Work::gather};
inline constexpr Stage direct_light{"direct light", &Settings::spp, 1};
inline constexpr Stage loading{"loading"};
inline constexpr Stage trials{"trials"};
inline constexpr Stage others{"other renders"};
inline constexpr Stage between{"between stages"};
} // namespace stages

struct StageStats {
    const Stage* stage;
    double wall_seconds = 0, cpu_seconds = 0; ///< CPU time of all threads
    std::uint64_t rays = 0;
};

/// The ledger of one kind of proposal: proposed = failed + zero + nan + rejected + accepted.
struct ProposalStats {
    std::string name;
    std::uint64_t proposed = 0, zero = 0, nan = 0, rejected = 0, accepted = 0;
    std::map<std::string, std::uint64_t> failed; ///< by reason
    double seconds = 0;
    double deposited = 0; ///< share of all deposits that were left by states of its making
};

/// How far independent groups of chains agree.
struct ChainAgreement {
    double r_hat; ///< split R-hat
    double error; ///< relative standard error of the brightness of a block of pixels
};

/// What tells whether the photons of a pass can be trusted. Figures that a pass doesn't have stay as they are here.
struct PhotonQuality {
    std::optional<double> of_brightest; ///< share of the power that the brightest 0.1 % carry
    std::optional<double> cut_off;      ///< share of the power that outliers lost, of the map where that is more
    struct Lookups {
        double found;     ///< photons, on average
        double effective; ///< equal ones that would be as good
        double share;     ///< found, of those asked for
    };
    std::optional<Lookups> lookups;
    struct Cache {
        double records;
        double noise;      ///< of their light, in one pass
        double starving;   ///< share of visible points that no record serves
        double growth = 0; ///< power of the number of pixels that the number of records is proportional to
    };
    std::optional<Cache> cache;
    std::optional<double> unconfirmed; ///< share of the picture with caustics that pilot photons don't confirm
    /// Squared errors relative to the picture, on average over it.
    struct Noise {
        double samples;  ///< of a picture of one sample a pixel, from where in the pixel it lies and all that it draws
        double records;  ///< from the rays that records of the irradiance cache had at first
        double rays = 0; ///< gather rays that a sample takes, on average
    };
    std::optional<Noise> noise;
};

/// What a warning is about: where to look for what it says.
enum class Doubt {
    render,       ///< all of it
    scene,        ///< the scene's file, which isn't read as it is meant
    samples,      ///< of pixels
    direct_light, ///< straight from emitters
    caustics,     ///< light by the caustic map
    photons,      ///< their number or power
    lookups,      ///< how many photons are found where they are asked for
    records,      ///< of the irradiance cache
};

struct RenderStats {
    std::string method; ///< the setting's, or what `auto` stood for
    std::vector<StageStats> stages;
    double samples = 0; ///< of a pixel, or mutations by pixel of methods that only run chains; of whole units of work
    double brightness = 0, brightness_error = 0; ///< B_eye and its standard error [W/(m^2 sr)]
    std::vector<ProposalStats> proposals;
    std::uint64_t photons_global = 0, photons_caustic = 0, photon_bytes = 0, importons = 0, importon_bytes = 0;
    std::optional<std::int64_t> passes;
    std::optional<double> effort;            ///< with_effort()'s, where it was set by the time
    std::optional<std::uint64_t> no_samples; ///< pixels without any, where the method counts them
    std::optional<ChainAgreement> agreement;
    PhotonQuality photon_quality;
    std::map<std::string, double> values; ///< further figures, which nothing but reports reads
    std::vector<std::string> remarks;     ///< choices that were made, in words
    std::vector<std::string> warnings;    ///< in words
    std::map<std::string, Doubt> doubts;  ///< what warnings are about; those that aren't here: the render
    std::optional<std::string> unsaved;   ///< why photons that were to be kept weren't
    std::optional<std::string> cut_map;   ///< what is to be said of them where a stop came before all were there
    bool has_saved_map = false;           ///< whether they were asked for and kept, or that failed
    bool complete = true;                 ///< false after a stop

    void warn(Doubt about, std::string warning) {
        doubts[warning] = about;
        warnings.push_back(std::move(warning));
    }

    /// What became of photons that another render was to keep.
    void take_word_of_map(const RenderStats& other) {
        if (other.unsaved) unsaved = other.unsaved;
        if (other.cut_map) cut_map = other.cut_map;
        has_saved_map = has_saved_map || other.has_saved_map;
    }

    /// Adds what a stage before the render took, and what it found.
    void begin_with(const RenderStats& before) {
        stages.insert(stages.begin(), before.stages.begin(), before.stages.end());
        values.insert(before.values.begin(), before.values.end());
        remarks.insert(remarks.end(), before.remarks.begin(), before.remarks.end());
    }
};

} // namespace keyhole
