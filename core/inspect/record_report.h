#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/inspect/record_ref.h"
#include "core/render/render_frame.h"
#include "core/vectors/gather.h"

namespace lightvane {

/// A line of a table: "radius", "0.12 m".
struct ReportRow {
  std::string label;
  std::string text;
};

/// What came of computing a vector again, from nothing but its point, the parameters and the seed.
enum class Recomputation : std::uint8_t {
  Same,       ///< to the bit, as it has to be
  Different,  ///< `note` says why: other parameters, or its point is no point of this view
  Impossible  ///< no surface is where the vector was computed
};

/// All that is known of a vector.
struct RecordReport {
  RecordRef record;
  std::string title;            ///< "ILV 12"; "no such vector"
  std::vector<ReportRow> rows;  ///< every field, with units
  Recomputation recomputation = Recomputation::Impossible;
  std::string note;
  /// What an ILV's gather saw, seen again: directions local to `frame`, radiances in the scene's units,
  /// distances in normalised ones. Empty for DLVs and for lobes, whose samples lie on no grid, and where it
  /// is not what the vector was made of.
  Hemisphere hemisphere;
  Frame frame;  ///< of the vector's point, world space
};

/// Any thread. Cost: the full computation of one vector, about a millisecond.
RecordReport recordReport(const RenderFrame& frame, const RecordRef& record);

/// The point at which a vector was computed: the frame's own visible point, or one put together from the
/// vector and the surface beneath it. Nothing where no surface is there.
std::optional<VisiblePoint> pointOfVector(const RenderFrame& frame, const VectorPoint& place,
                                          const Birth& birth);

/// 1 for every pixel of the region's picture in which the vector has a share, by way of mirrors too; else 0.
/// Any thread. Cost: some 10 us for each visible point within the vector's radius.
Image<std::uint8_t> servedPixels(const RenderFrame& frame, const RecordRef& record);

}  // namespace lightvane
