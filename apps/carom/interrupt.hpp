/// \file
/// Ctrl-C and SIGTERM: finish the step, save, and end.
#pragma once

namespace carom::cli {

/// From now on the first SIGINT or SIGTERM is only noted; the second one, of either kind, ends the program at once.
void note_interrupts();

/// The number of the signal that asked the program to end, or 0.
int interrupted_by() noexcept;

} // namespace carom::cli
