#pragma once

#include <string>

namespace lightvane {

/// What gathers cost and how sure they are, by scene and number of cells: the CPU time of one, the standard
/// deviation of its irradiance and of what its gradient makes of a step, over `seeds` gathers at each point,
/// and the time that a standard deviation of 1 % would take at that rate. Markdown; one thread.
std::string gathersTable(int rounds, int seeds);

}  // namespace lightvane
