#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "core/image/image.h"
#include "core/inspect/error_sources.h"

namespace lightvane {

// What errorSources found, as a table, as JSON and as layers of a picture file.

/// A row for each source and one for the whole, a column for each layer; a row of heads first.
std::vector<std::vector<std::string>> errorSourceTable(const ErrorSources& sources);
nlohmann::ordered_json errorSourceJson(const ErrorSources& sources);
/// Adds a layer for each source, "error.noise", and "truth".
void addErrorLayers(const ErrorSources& sources, LayeredImage& image);

}  // namespace lightvane
