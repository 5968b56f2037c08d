// Photon maps in files.
#pragma once

#include "core/settings.h"
#include "photonmap/photons.h"
#include "sampling/paths/gather_coverage.h"
#include "scene/scene.h"

#include <cstdint>
#include <string>

namespace keyhole {

/// What a map was made from: it fits no other scene and no other rule of what it holds.
struct PhotonFileKey {
    std::uint64_t scene;          ///< scene_hash()
    std::int64_t max_scatterings; ///< of the paths
    std::int64_t coverage;        ///< coverage_paths() of the coverage that the global map stops at; 0: none
    std::int32_t width, height;   ///< of the picture [pixels]: its shape decides what the eye sees
};

/// The key of maps for this scene. Traces some light. @param coverage of gather rays; null: they come everywhere
PhotonFileKey photon_file_key(const Scene& scene, const Settings& settings, const GatherCoverage* coverage);

/// Writes the photons of a pass, as a whole or not at all. @throws InputError if it can't be written.
void save_photons(const std::string& path, const PhotonFileKey& key, const Photons& photons);

/// @throws InputError if there is no such file, or none that begins as these do.
void check_photon_file(const std::string& path);

/// @throws InputError, with what was found and expected, if there is no such file, or it is none of these, of another
///     version, of another scene or depth, or damaged; or if its photons lie only where the eye asked for them, and the
///     picture that it asked for is of another shape.
Photons load_photons(const std::string& path, const PhotonFileKey& key);

} // namespace keyhole
