// Numbers among the settings that belong to kinds of proposal, of which this layer knows no more than that.
#pragma once

#include <map>
#include <span>
#include <string_view>

namespace keyhole {

/// A number that steers a kind of proposal. Each stands in the file of its proposal.
struct ProposalParameter {
    const char* key; ///< among the settings, as in "lens_perturbation.weight"
    double usual;    ///< unless the settings have another
    double minimum, maximum;
    const char* help;
};

/// Those of all kinds, from the table in sampling/proposals/registry.cpp.
std::span<const ProposalParameter* const> proposal_parameters();

/// Their values.
class ProposalParameters {
  public:
    double operator[](const ProposalParameter& parameter) const {
        const auto found = values_.find(&parameter);
        return found == values_.end() ? parameter.usual : found->second;
    }
    double& operator[](const ProposalParameter& parameter) {
        return values_.try_emplace(&parameter, parameter.usual).first->second;
    }

  private:
    std::map<const ProposalParameter*, double> values_; // where they were asked to be written
};

} // namespace keyhole
