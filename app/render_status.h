#pragma once

#include "app/document.h"
#include "app/panels/panel_io.h"
#include "core/render/render_frame.h"

namespace lightvane {

/// What the status bar says of a frame: how far its rendering is, and what it did. `workedSeconds`: from the
/// request to the frame; 0 where it is not known.
RenderStatus renderStatus(const RenderFrame& frame, double workedSeconds);
/// The same of a rendering that no frame shows yet.
RenderStatus renderStatus(const RenderStatistics& statistics, const RenderProgress& progress,
                          double workedSeconds);

/// What panels must know of the document's scene. `parameters` are those that it is rendered with.
SceneSummary summaryOf(const Document& document, const Parameters& parameters);

/// Bytes of memory that the process holds; 0 where the system does not tell.
std::uint64_t residentBytes();

/// What the machine has in all.
std::uint64_t memoryBytes();

}  // namespace lightvane
