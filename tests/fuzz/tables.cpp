// The tables of methods and of proposals' parameters, for targets that are built of the first two layers alone: an
// entry each.
#include "core/error.h"
#include "core/settings.h"

#include <array>
#include <string>

namespace keyhole {

struct Method {
    std::string_view name;
};
constinit const Method methods::automatic{"auto"};

namespace {

constexpr std::array<const Method*, 1> kMethods{&methods::automatic};
constexpr ProposalParameter kWeight{"some_proposal.weight", 0.5, 0, 1, "relative frequency"};
constexpr std::array<const ProposalParameter*, 1> kParameters{&kWeight};

} // namespace

std::span<const Method* const> all_methods() { return kMethods; }
std::string_view name_of(const Method& method) { return method.name; }
const Method& method_named(std::string_view name) {
    if (name != methods::automatic.name) throw InputError("unknown method '" + std::string(name) + "'");
    return methods::automatic;
}
std::span<const ProposalParameter* const> proposal_parameters() { return kParameters; }

} // namespace keyhole
