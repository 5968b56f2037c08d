// Warnings of the readers of scene files.
#pragma once

#include "core/error.h"

#include <set>
#include <string>
#include <vector>

namespace keyhole {

/// Collects warnings, each kind once.
class Warnings {
  public:
    /// @param out may be null.
    explicit Warnings(std::vector<std::string>* out) : out_(out) {}
    /// Adds "file:line:column: message", unless one of this `kind` was added before.
    void add(const FilePosition& where, const std::string& kind, const std::string& message) {
        if (kinds_.insert(kind).second && out_ != nullptr) out_->push_back(where.to_string() + ": " + message);
    }

    /// Says that a mesh is left out because no ray could hit it. @param mesh in words, perhaps with its path
    void add_flat_mesh(const FilePosition& where, const std::string& mesh) {
        add(where, "mesh without area at " + where.to_string(),
            mesh + ": no triangle of the mesh has an area: it is left out");
    }

  private:
    std::vector<std::string>* out_;
    std::set<std::string> kinds_;
};

} // namespace keyhole
