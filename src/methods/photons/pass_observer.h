// Who watches a pass: its photons, the paths that brought them, and what is made of them.
#pragma once

#include "methods/photons/pass_gather.h"
#include "photonmap/photons.h"

namespace keyhole {

class PassObserver : public PhotonObserver {
  public:
    /// All photons of a pass are there.
    virtual void sampled(const Photons& photons) = 0;
    /// The maps and the irradiance cache of the pass are; `gather` lasts as long as the call.
    virtual void ready(const PassGather& gather) = 0;
};

} // namespace keyhole
