#pragma once

#include <string>

namespace lightvane {

/// How soon the previewer's session answers, as Markdown: rows of docs/performance.md. `rounds` of each in
/// turn, pictures of `size` x `size` pixels; medians.
std::string previewTable(int size, int rounds);

}  // namespace lightvane
