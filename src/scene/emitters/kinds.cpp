// The kinds of emitters that scene files list. A new file of this folder gets a line here.
#include "scene/load/properties.h"

#define KEYHOLE_EMITTER_FILES(FILE)                                                                                    \
    FILE(distant)                                                                                                      \
    FILE(environment)                                                                                                  \
    FILE(picture)                                                                                                      \
    FILE(point)                                                                                                        \
    FILE(spot)

namespace keyhole {

#define KEYHOLE_DECLARE(FILE) EmitterKinds FILE##_kinds();
KEYHOLE_EMITTER_FILES(KEYHOLE_DECLARE)

const EmitterKinds& emitter_kinds() {
#define KEYHOLE_LIST(FILE) FILE##_kinds(),
    static const EmitterKinds kinds = joined<EmitterPtr>({KEYHOLE_EMITTER_FILES(KEYHOLE_LIST)});
    return kinds;
}

} // namespace keyhole
