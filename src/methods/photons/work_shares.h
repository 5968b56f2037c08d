// How chains and light paths share the work of photon maps that both fill.
#pragma once

namespace keyhole {

struct WorkShares {
    double chains; ///< of `mutations`; light paths get the rest of `light_paths`
    /// So many steps of a chain count as one independent sample in the weights of its photons: neighbouring states know
    /// of each other. Nothing is biased, whatever it is.
    double correlation;
};

} // namespace keyhole
