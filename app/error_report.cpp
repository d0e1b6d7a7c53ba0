#include "app/error_report.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/json_number.h"
#include "core/inspect/units.h"

namespace lightvane {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::pair<const char*, SourceErrors ErrorSources::*> kLayers[] = {
    {"direct", &ErrorSources::direct},
    {"indirect", &ErrorSources::indirect},
    {"picture", &ErrorSources::picture}};

std::string errorText(const SourceError& error) {
  if (error.relative == 0.0 && error.bias == 0.0) return "–";
  return fmt::format("{:.2f} ± {} %, {:+.2f} %", 100.0 * error.relative,
                     numberText(100.0 * error.standardError, 1), 100.0 * error.bias);
}

Json jsonOf(const SourceError& error) {
  return {{"relative", jsonNumber(error.relative)},
          {"standard_error", jsonNumber(error.standardError)},
          {"bias", jsonNumber(error.bias)}};
}

}  // namespace

std::vector<std::vector<std::string>> errorSourceTable(const ErrorSources& sources) {
  std::vector<std::vector<std::string>> rows = {{"source"}};
  for (const auto& [name, layer] : kLayers) rows[0].emplace_back(name);
  rows[0].emplace_back("made smaller by");
  for (const ErrorSourceInfo& info : errorSourceInfos()) {
    std::vector<std::string>& row = rows.emplace_back();
    row.emplace_back(info.label);
    for (const auto& [name, layer] : kLayers)
      row.push_back(errorText((sources.*layer).ofSource[static_cast<std::size_t>(info.source)]));
    row.emplace_back(info.remedy);
  }
  std::vector<std::string>& row = rows.emplace_back();
  row.emplace_back("together");
  for (const auto& [name, layer] : kLayers) row.push_back(errorText((sources.*layer).total));
  row.emplace_back();
  return rows;
}

Json errorSourceJson(const ErrorSources& sources) {
  Json json = {{"samples", sources.samples}, {"stride", sources.stride}, {"pixels", sources.pixels.size()}};
  for (const auto& [name, layer] : kLayers) {
    Json& of = json[name];
    for (const ErrorSourceInfo& info : errorSourceInfos())
      of[choiceName(kErrorSourceNames, info.source)] =
          jsonOf((sources.*layer).ofSource[static_cast<std::size_t>(info.source)]);
    of["together"] = jsonOf((sources.*layer).total);
  }
  return json;
}

void addErrorLayers(const ErrorSources& sources, LayeredImage& image) {
  for (const ErrorSourceInfo& info : errorSourceInfos())
    image.setRgb(std::string("error.") + choiceName(kErrorSourceNames, info.source),
                 sources.map(info.source));
  image.setRgb("truth", sources.truth);
}

}  // namespace lightvane
