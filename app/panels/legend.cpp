#include "app/panels/legend.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "app/panels/controls.h"
#include "app/panels/widgets.h"
#include "core/base/number_text.h"

namespace lightvane {
namespace {

/// Of the picture's height, what the legend covers before it takes a second and a third column, and where
/// there is no room for these, before it leaves out how to read the overlay.
constexpr float kMostOfPicture = 0.35f;
constexpr const char* kMoreNotes = "more in the tab Vectors";

/// A step of 1, 2 or 5 times a power of ten, of which at most `most` fit in `span`.
double roundStep(double span, int most) {
  const double rough = span / most;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= rough * (1.0 - 1e-9)) return factor * power;
  }
  return 10.0 * power;
}

double fractionOf(const ViewScale& scale, double value) {
  const double low = scale.low;
  const double high = scale.high;
  return scale.logarithmic ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
}

void drawBar(const Palette& palette, const ShownView& shown, float width) {
  const float em = ImGui::GetFontSize();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float height = 0.8f * em;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const std::span<const Color8, 256> table = colorTable(shown.scale.map);
  constexpr int kParts = 64;
  for (int i = 0; i < kParts; ++i) {
    const auto color = [&](int part) {
      return toImU32(table[static_cast<std::size_t>(255 * part / kParts)]);
    };
    const float x0 = at.x + width * static_cast<float>(i) / kParts;
    const float x1 = at.x + width * static_cast<float>(i + 1) / kParts;
    list.AddRectFilledMultiColor({x0, at.y}, {x1, at.y + height}, color(i), color(i + 1), color(i + 1),
                                 color(i));
  }
  // As many numbers as there is room for, each under its mark and within the bar.
  const int most = std::max(2, static_cast<int>(width / (4.5f * em)));
  float freeFrom = at.x;
  for (const double tick : scaleTicks(shown.scale, most)) {
    const float x = at.x + width * static_cast<float>(fractionOf(shown.scale, tick));
    const std::string text = shortNumber(tick);
    const float textWidth = ImGui::CalcTextSize(text.c_str()).x;
    const float left = std::clamp(x - 0.5f * textWidth, at.x, at.x + width - textWidth);
    list.AddLine({x, at.y + height}, {x, at.y + height + 0.25f * em}, palette.text);
    if (left < freeFrom) continue;
    list.AddText({left, at.y + height + 0.25f * em}, palette.text, text.c_str());
    freeFrom = left + textWidth + 0.4f * em;
  }
  ImGui::Dummy({width, height + 1.35f * em});
  Widgets::recordItem("legend.bar");
}

/// The shape of a marker in one colour, its lines so wide.
void drawShape(ImDrawList& list, const ImVec2& centre, float r, MarkerShape shape, ImU32 color, float line) {
  const ImVec2 diamond[4] = {
      {centre.x, centre.y - r}, {centre.x + r, centre.y}, {centre.x, centre.y + r}, {centre.x - r, centre.y}};
  switch (shape) {
    case MarkerShape::Disc:
      list.AddCircleFilled(centre, r, color);
      break;
    case MarkerShape::Ring:
      list.AddCircle(centre, r, color, 0, line);
      break;
    case MarkerShape::Diamond:
      list.AddConvexPolyFilled(diamond, 4, color);
      break;
    case MarkerShape::HollowDiamond:
      list.AddPolyline(diamond, 4, color, ImDrawFlags_Closed, line);
      break;
    case MarkerShape::Triangle:
      list.AddTriangleFilled({centre.x, centre.y - r}, {centre.x - 0.87f * r, centre.y + 0.5f * r},
                             {centre.x + 0.87f * r, centre.y + 0.5f * r}, color);
      break;
    case MarkerShape::Cross: {
      const float d = 0.7f * r;
      list.AddLine({centre.x - d, centre.y - d}, {centre.x + d, centre.y + d}, color, line);
      list.AddLine({centre.x - d, centre.y + d}, {centre.x + d, centre.y - d}, color, line);
      break;
    }
    case MarkerShape::Square:
      list.AddRect({centre.x - r, centre.y - r}, {centre.x + r, centre.y + r}, color, 0.0f, 0, line);
      break;
  }
}

/// A marker as the overlay draws it, with an edge.
void drawMarker(ImDrawList& list, const ImVec2& centre, float r, MarkerShape shape, ImU32 color, ImU32 edge) {
  const float line = std::max(1.0f, 0.3f * r);
  const float edgeWidth = std::max(1.0f, 0.2f * r);
  const bool isFilled =
      shape == MarkerShape::Disc || shape == MarkerShape::Diamond || shape == MarkerShape::Triangle;
  drawShape(list, centre, isFilled ? r + edgeWidth : r, shape, edge, line + 2.0f * edgeWidth);
  drawShape(list, centre, r, shape, color, line);
}

/// A line with a mark before it.
void drawEntry(const std::string& text, ImU32 color, const std::optional<MarkerShape>& shape, float width) {
  const float em = ImGui::GetFontSize();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  if (shape) {
    const ImVec2 centre{at.x + 0.5f * em, at.y + 0.5f * em};
    // With a dark edge, as in the picture: light marks are seen on a light ground.
    drawMarker(list, centre, 0.35f * em, *shape, color, IM_COL32(0, 0, 0, 160));
  } else {
    list.AddRectFilled({at.x + 0.1f * em, at.y + 0.1f * em}, {at.x + 0.9f * em, at.y + 0.9f * em}, color,
                       0.15f * em);
  }
  ImGui::Indent(1.3f * em);
  ImGui::TextUnformatted(wrapped(text, width - 1.3f * em).c_str());
  ImGui::Unindent(1.3f * em);
}

bool hasSomethingToSay(const PanelInput& input) {
  const bool ofView = input.shown && !input.shown->isEmpty &&
                      (input.shown->kind == ViewKind::Scalar || !input.shown->categories.empty());
  const bool ofOverlay =
      input.overlay != nullptr && (!input.overlay->legend.empty() || !input.overlay->counts.empty() ||
                                   !input.overlay->scales.empty() || !input.overlay->notes.empty());
  return ofView || ofOverlay;
}

float heightOf(const std::string& text, float width) {
  return ImGui::CalcTextSize(wrapped(text, width).c_str()).y + ImGui::GetStyle().ItemSpacing.y;
}

float viewHeight(const PanelInput& input) {
  if (!input.shown || input.shown->isEmpty) return 0.0f;
  if (input.shown->kind == ViewKind::Scalar) return 3.0f * ImGui::GetTextLineHeightWithSpacing();
  const std::vector<ViewCategory>& categories = input.shown->categories;
  if (categories.empty()) return 0.0f;
  const auto lines = std::count_if(categories.begin(), categories.end(),
                                   [](const ViewCategory& category) { return category.occurs; });
  return static_cast<float>(1 + lines) * ImGui::GetTextLineHeightWithSpacing();
}

float entriesHeight(const OverlayBatch& overlay, float width) {
  float height = 0.0f;
  for (const OverlayLegendEntry& entry : overlay.legend)
    height += heightOf(entry.text, width - 1.3f * ImGui::GetFontSize());
  return height;
}

float heightOfAll(std::span<const std::string> texts, float width) {
  float height = 0.0f;
  for (const std::string& text : texts) height += heightOf(text, width);
  return height;
}

void drawEntries(const OverlayBatch& overlay, float width) {
  for (const OverlayLegendEntry& entry : overlay.legend)
    drawEntry(entry.text, toImU32(entry.color), entry.shape, width);
  if (!overlay.legend.empty()) Widgets::recordItem("legend.last_entry");
}

void drawNotes(const Palette& palette, std::span<const std::string> notes, float width) {
  ImGui::PushStyleColor(ImGuiCol_Text, palette.dim);
  for (const std::string& note : notes) ImGui::TextUnformatted(wrapped(note, width).c_str());
  if (!notes.empty()) Widgets::recordItem("legend.last_note");
  ImGui::PopStyleColor();
}

/// Before which parts of the legend a new column begins: the view's colours, the overlay's colours, its
/// notes.
struct Columns {
  bool beforeEntries;
  bool beforeNotes;

  int count() const { return 1 + (beforeEntries ? 1 : 0) + (beforeNotes ? 1 : 0); }
  float height(float view, float entries, float notes) const {
    if (beforeEntries) return std::max(view, beforeNotes ? std::max(entries, notes) : entries + notes);
    return beforeNotes ? std::max(view + entries, notes) : view + entries + notes;
  }
};

/// As few columns as keep the legend low, of the `most` that there is room for; else the lowest of these.
Columns chooseColumns(int most, float limit, float view, float entries, float notes) {
  static constexpr Columns kByCount[] = {{false, false}, {true, false}, {false, true}, {true, true}};
  const auto height = [&](const Columns& columns) { return columns.height(view, entries, notes); };
  Columns chosen = kByCount[0];
  for (const Columns& columns : kByCount) {
    const bool isLowEnough = height(chosen) <= limit;
    if (columns.count() > most || (isLowEnough && columns.count() > chosen.count())) break;
    if (height(columns) < height(chosen)) chosen = columns;
  }
  return chosen;
}

void drawViewPart(const Palette& palette, const ShownView& shown, float width) {
  if (shown.kind == ViewKind::Scalar) {
    const std::string title =
        shown.unit.empty() ? shown.title : fmt::format("{} [{}]", shown.title, shown.unit);
    ImGui::TextUnformatted(wrapped(title, width).c_str());
    drawBar(palette, shown, width);
  } else if (!shown.categories.empty()) {
    ImGui::TextUnformatted(shown.title.c_str());
    for (const ViewCategory& category : shown.categories) {
      if (!category.occurs) continue;
      drawEntry(category.name, toImU32(category.color), std::nullopt, width);
    }
  }
}

}  // namespace

std::vector<double> scaleTicks(const ViewScale& scale, int most) {
  std::vector<double> ticks;
  const double low = scale.low;
  const double high = scale.high;
  if (!(low < high) || !std::isfinite(low) || !std::isfinite(high)) return ticks;
  if (scale.logarithmic && low > 0.0) {
    const int first = static_cast<int>(std::ceil(std::log10(low) - 1e-6));
    const int last = static_cast<int>(std::floor(std::log10(high) + 1e-6));
    const int step = std::max(1, (last - first + most) / most);
    for (int e = first; e <= last; e += step) ticks.push_back(std::pow(10.0, e));
    // Within one power of ten there may be none to mark: the ends then.
    if (ticks.size() < 2) ticks = {low, high};
    return ticks;
  }
  const double step = roundStep(high - low, most);
  const double first = std::ceil(low / step - 1e-6);
  for (double i = first; i * step <= high + 1e-6 * step; i += 1.0) ticks.push_back(i == 0.0 ? 0.0 : i * step);
  return ticks;
}

void drawLegend(const Workspace& workspace, const PanelInput& input, const ImVec2& pictureMin,
                const ImVec2& pictureMax) {
  const Palette& palette = paletteOf(workspace.display.theme);
  const float em = ImGui::GetFontSize();
  if (input.shown && input.shown->isEmpty) {
    // In place of a picture: an empty one would look like a fault.
    const std::string text = wrapped(input.shown->title, 0.8f * (pictureMax.x - pictureMin.x));
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    ImGui::GetBackgroundDrawList()->AddText(
        {0.5f * (pictureMin.x + pictureMax.x - size.x), 0.5f * (pictureMin.y + pictureMax.y - size.y)},
        palette.text, text.c_str());
  }
  if (!workspace.display.legend || !hasSomethingToSay(input)) return;
  const float width = std::min(16.0f * em, pictureMax.x - pictureMin.x - 3.0f * em);
  if (width < 6.0f * em) return;
  ImGui::SetNextWindowPos({pictureMin.x + 0.5f * em, pictureMax.y - 0.5f * em}, ImGuiCond_Always,
                          {0.0f, 1.0f});
  const ImVec2 room{pictureMax.x - pictureMin.x - em, pictureMax.y - pictureMin.y - em};
  ImGui::SetNextWindowSizeConstraints({0.0f, 0.0f}, room);
  // So that the picture is seen through it a little, and its own text is read all the same.
  ImGui::PushStyleColor(ImGuiCol_WindowBg, withAlpha(palette.popup, 0.9f));
  // Over the picture and in nobody's way: the mouse goes through it.
  ImGui::Begin("##legend", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
                   ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_AlwaysAutoResize);
  const OverlayBatch none;
  const OverlayBatch& overlay = input.overlay != nullptr ? *input.overlay : none;
  const int most = std::max(1, static_cast<int>((room.x + em) / (width + em)));
  const float view = viewHeight(input);
  const float entries = entriesHeight(overlay, width);
  const float limit = kMostOfPicture * room.y;
  std::vector<std::string> facts = overlay.counts;
  facts.insert(facts.end(), overlay.scales.begin(), overlay.scales.end());
  std::vector<std::string> notes = facts;
  notes.insert(notes.end(), overlay.notes.begin(), overlay.notes.end());
  float notesHeight = heightOfAll(notes, width);
  Columns columns = chooseColumns(most, limit, view, entries, notesHeight);
  if (!overlay.notes.empty() && columns.height(view, entries, notesHeight) > limit) {
    notes = std::move(facts);
    notes.emplace_back(kMoreNotes);
    notesHeight = heightOfAll(notes, width);
    columns = chooseColumns(most, limit, view, entries, notesHeight);
  }
  const auto beginPart = [&](bool inNewColumn) {
    if (!inNewColumn) return;
    ImGui::EndGroup();
    ImGui::SameLine(0.0f, em);
    ImGui::BeginGroup();
  };
  ImGui::BeginGroup();
  if (input.shown) drawViewPart(palette, *input.shown, width);
  beginPart(columns.beforeEntries && view > 0.0f && entries > 0.0f);
  drawEntries(overlay, width);
  beginPart(columns.beforeNotes && view + entries > 0.0f && !notes.empty());
  drawNotes(palette, notes, width);
  ImGui::EndGroup();
  Widgets::recordWindow("legend");
  ImGui::End();
  ImGui::PopStyleColor();
}

void drawCursorTooltip(const Workspace& workspace, const PanelInput& input) {
  if (!input.cursor || input.cursor->lines.empty() || ImGui::GetIO().WantCaptureMouse) return;
  const Palette& palette = paletteOf(workspace.display.theme);
  ImGui::BeginTooltip();
  ImGui::PushStyleColor(ImGuiCol_Text, palette.dim);
  ImGui::TextUnformatted(fmt::format("{}, {}", input.cursor->pixel.x, input.cursor->pixel.y).c_str());
  ImGui::PopStyleColor();
  for (const std::string& line : input.cursor->lines) ImGui::TextUnformatted(line.c_str());
  Widgets::recordWindow("cursor");
  ImGui::EndTooltip();
}

}  // namespace lightvane
