#pragma once

namespace lightvane {

/// Lets the process keep what it frees, up to 256 MB, for what it allocates next, in place of giving it back
/// to the system at once. Each pass allocates what the pass before it freed, and pages that come from the
/// system anew cost a fault each: a tenth of the CPU time of a moved view. For the start of a program;
/// without glibc it does nothing.
void keepFreedMemory();

/// Gives back what is kept. For when much less will be needed than before. Cost: some ten milliseconds.
void returnFreedMemory();

}  // namespace lightvane
