// Media in scene files.
#pragma once

#include "scene/load/mistakes.h"
#include "scene/load/yaml_tree.h"
#include "scene/medium.h"

#include <map>
#include <memory>
#include <string>

namespace keyhole {

/// The named media of a scene and its includes.
class MediumTable {
  public:
    /// Adds the media of a `media:` section; notes mistakes, and names already taken.
    void read(const YamlNode& section, Mistakes& mistakes);

    /// The medium that a node names; the same object for the same name, so that shapes can tell media apart.
    /// @throws InputError for unknown names.
    std::shared_ptr<const Medium> resolve(const YamlNode& node) const;

  private:
    void add(const YamlNode& key, const YamlNode& value);

    struct Named {
        std::shared_ptr<const Medium> medium;
        FilePosition position;
    };
    std::map<std::string, Named> media_;
};

} // namespace keyhole
