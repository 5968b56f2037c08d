// Participating media of pbrt's format: those that only absorb.
#pragma once

#include "scene/medium.h"
#include "scene/pbrt/parameters.h"

#include <map>
#include <memory>
#include <string>

namespace keyhole::pbrt {

/// The named media of a scene. The empty name is the vacuum.
class MediumTable {
  public:
    /// Reads a `MakeNamedMedium` directive of kind homogeneous. A medium that scatters, emits or varies is noted, and
    /// refused only where something is put into it.
    void define(Parameters& parameters);

    /// The same object for the same name, so that shapes can tell media apart; null for the vacuum.
    /// @throws InputError with the position of `user` for an unknown name, and for media that do more than absorb.
    std::shared_ptr<const Medium> look_up(const std::string& name, const Directive& user) const;

  private:
    struct Entry {
        std::shared_ptr<const Medium> medium;
        std::string refusal; ///< why it can't be rendered; empty: it can
    };
    std::map<std::string, Entry> media_;
};

} // namespace keyhole::pbrt
