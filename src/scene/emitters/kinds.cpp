// The kinds of emitters that scene files list. A new file of this folder gets its function here.
#include "scene/load/properties.h"

namespace keyhole {

EmitterKinds infinite_kinds(), picture_kinds(), point_kinds();

const EmitterKinds& emitter_kinds() {
    static const EmitterKinds kinds = joined<EmitterPtr>({infinite_kinds(), picture_kinds(), point_kinds()});
    return kinds;
}

} // namespace keyhole
