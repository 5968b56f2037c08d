// What the program is handed by its caller.
#pragma once

namespace keyhole {

/// Makes the standard streams safe to write to: those that are closed become empty ones, for else a picture could get
/// their number and messages would go into it. And where nobody reads a stream any more, or a file may not grow,
/// writing is to fail, and not to end the program.
void secure_standard_streams();

} // namespace keyhole
