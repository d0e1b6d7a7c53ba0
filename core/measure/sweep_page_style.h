#pragma once

namespace lightvane {

/// Of a report: light and dark as the reader's system has it, and paper.
extern const char* const kSweepPageStyle;
/// Conveniences of a report. Without '<' and '&', which would end it for a reader of XML.
extern const char* const kSweepPageScript;

}  // namespace lightvane
