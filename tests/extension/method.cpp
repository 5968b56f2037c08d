// A new method, for the test of what it takes to add one: mlt, by another name.
#include "methods/method.h"

namespace keyhole {

constinit const Method methods::extension{.name = "extension",
                                          .help = "the method of a test",
                                          .render = [](const RenderTask& task) { return methods::mlt.render(task); }};

} // namespace keyhole
