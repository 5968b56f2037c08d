// Materials in scene files.
#pragma once

#include "scene/load/mistakes.h"
#include "scene/load/yaml_tree.h"
#include "scene/material.h"

#include <map>
#include <memory>
#include <string>

namespace keyhole {

/// The named materials of a scene and its includes.
class MaterialTable {
  public:
    /// Adds the materials of a `materials:` section; notes mistakes, and names already taken.
    void read(const YamlNode& section, Mistakes& mistakes);

    /// The material that a node names, or describes in place. @throws InputError for mistakes and unknown names.
    std::shared_ptr<const Material> resolve(const YamlNode& node) const;

  private:
    void add(const YamlNode& key, const YamlNode& value);

    struct Named {
        std::shared_ptr<const Material> material;
        FilePosition position;
    };
    std::map<std::string, Named> materials_;
};

} // namespace keyhole
