#include "app/sweep_files.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <set>

#include <fcntl.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "app/json_number.h"
#include "core/base/file.h"

namespace lightvane {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Json settingsJson(const SweepSettings& settings) {
  Json object = Json::object();
  for (const auto& [key, value] : settings) object[key] = value;
  return object;
}

Json runJson(const SweepRun& run) {
  Json json = {{"seed", run.seed},
               {"cpu_seconds", run.cpuSeconds},
               {"wall_seconds", run.wallSeconds},
               {"rays",
                {{"camera", run.rays.camera},
                 {"gather", run.rays.gather},
                 {"bounce", run.rays.bounce},
                 {"shadow", run.rays.shadow},
                 {"visibility", run.rays.visibility}}},
               {"ilv_records", run.ilvRecords},
               {"dlv_records", run.dlvRecords},
               {"full_indirect", run.fullIndirect},
               {"full_direct", run.fullDirect},
               {"memory_bytes", run.memoryBytes}};
  for (const auto& [name, value] : run.metrics) json["metrics"][name] = jsonNumber(value);
  return json;
}

SweepRun runOf(const Json& json) {
  SweepRun run;
  run.seed = json.at("seed");
  run.cpuSeconds = json.at("cpu_seconds");
  run.wallSeconds = json.at("wall_seconds");
  const Json& rays = json.at("rays");
  run.rays = {rays.at("camera"), rays.at("gather"), rays.at("bounce"), rays.at("shadow"),
              rays.at("visibility")};
  run.ilvRecords = json.at("ilv_records");
  run.dlvRecords = json.at("dlv_records");
  run.fullIndirect = json.at("full_indirect");
  run.fullDirect = json.at("full_direct");
  run.memoryBytes = json.at("memory_bytes");
  for (const auto& [name, value] : json.at("metrics").items()) run.metrics[name] = numberOfJson(value);
  return run;
}

std::string lineOf(const KeptRun& kept) {
  Json json = {
      {"key", kept.key},         {"method", kept.method},   {"settings", settingsJson(kept.settings)},
      {"command", kept.command}, {"picture", kept.picture}, {"error_map", kept.errorMap},
      {"run", runJson(kept.run)}};
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::optional<KeptRun> keptOf(std::string_view line) {
  try {
    const Json json = Json::parse(line);
    KeptRun kept;
    kept.key = json.at("key");
    kept.method = json.at("method");
    for (const auto& [key, value] : json.at("settings").items()) kept.settings.emplace_back(key, value);
    kept.command = json.at("command");
    kept.picture = json.at("picture");
    kept.errorMap = json.at("error_map");
    kept.run = runOf(json.at("run"));
    return kept;
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

std::string csvCell(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

}  // namespace

Expected<RunLog> RunLog::open(const fs::path& file) {
  RunLog log;
  log.file_ = file;
  std::error_code error;
  if (!fs::exists(file, error)) return log;
  const Expected<std::string> text = readFile(file);
  if (!text) return tl::unexpected(text.error());
  std::string_view rest = *text;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    if (auto kept = keptOf(rest.substr(0, end))) {
      log.keep(std::move(*kept));
    } else if (log.runs_.empty() && end < rest.size()) {
      // The first line is whole, and is none of ours.
      return makeError(file.string(), "is no list of a sweep's runs", "give another folder with -o");
    }
    rest.remove_prefix(std::min(rest.size(), end + 1));
  }
  return log;
}

const KeptRun* RunLog::find(const std::string& key) const {
  const auto found = places_.find(key);
  return found == places_.end() ? nullptr : &runs_[found->second];
}

void RunLog::keep(KeptRun run) {
  places_.try_emplace(run.key, runs_.size());
  runs_.push_back(std::move(run));
}

Expected<void> RunLog::add(const KeptRun& run) {
  const auto wrong = [&] {
    return makeError(file_.string(), fmt::format("cannot be written: {}", std::strerror(errno)));
  };
  const int file = ::open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (file < 0) return wrong();
  // A line that was cut ends here, or what follows would be part of it.
  std::string line = lineOf(run);
  const off_t size = lseek(file, 0, SEEK_END);
  char last = '\n';
  if (size > 0 && pread(file, &last, 1, size - 1) == 1 && last != '\n') line.insert(0, 1, '\n');
  bool isWritten = size >= 0;
  for (std::size_t done = 0; isWritten && done < line.size();) {
    const ssize_t count = write(file, line.data() + done, line.size() - done);
    if (count < 0 && errno == EINTR) continue;
    isWritten = count > 0;
    done += isWritten ? static_cast<std::size_t>(count) : 0;
  }
  isWritten = isWritten && fsync(file) == 0;
  Expected<void> result = isWritten ? Expected<void>() : wrong();
  close(file);
  if (result) keep(run);
  return result;
}

std::string sweepCsv(const Sweep& sweep) {
  std::vector<std::string> keys;
  std::set<std::string> metrics;
  for (const SweepPoint& point : sweep.points) {
    for (const auto& [key, value] : point.settings) {
      if (std::find(keys.begin(), keys.end(), key) == keys.end()) keys.push_back(key);
    }
    for (const SweepRun& run : point.runs) {
      for (const auto& [name, value] : run.metrics) metrics.insert(name);
    }
  }
  // Of the points of a study.
  const bool hasLabels =
      std::ranges::any_of(sweep.points, [](const SweepPoint& point) { return !point.label.empty(); });
  std::string text = hasLabels ? "point,method" : "method";
  for (const std::string& key : keys) text += "," + csvCell(key);
  text +=
      ",seed,cpu_seconds,wall_seconds,rays_camera,rays_gather,rays_bounce,rays_shadow,rays_visibility,ilv_"
      "records,"
      "dlv_records,full_indirect,full_direct,memory_bytes";
  for (const std::string& metric : metrics) text += "," + metric;
  text += ",picture,error_map,command\n";
  for (const SweepPoint& point : sweep.points) {
    for (const SweepRun& run : point.runs) {
      text += (hasLabels ? csvCell(point.label) + "," : "") + point.method;
      for (const std::string& key : keys) {
        const auto found = std::find_if(point.settings.begin(), point.settings.end(),
                                        [&](const auto& setting) { return setting.first == key; });
        text += "," + (found == point.settings.end() ? std::string() : csvCell(found->second));
      }
      text +=
          fmt::format(",{},{},{},{},{},{},{},{},{},{},{},{},{}", run.seed, run.cpuSeconds, run.wallSeconds,
                      run.rays.camera, run.rays.gather, run.rays.bounce, run.rays.shadow, run.rays.visibility,
                      run.ilvRecords, run.dlvRecords, run.fullIndirect, run.fullDirect, run.memoryBytes);
      for (const std::string& metric : metrics) {
        const auto found = run.metrics.find(metric);
        text += "," + (found == run.metrics.end() ? std::string() : fmt::format("{}", found->second));
      }
      text +=
          "," + csvCell(point.picture) + "," + csvCell(point.errorMap) + "," + csvCell(point.command) + "\n";
    }
  }
  return text;
}

std::string sweepJson(const Sweep& sweep) {
  Json json = {{"scene", sweep.scene},     {"scene_hash", sweep.sceneHash}, {"width", sweep.width},
               {"height", sweep.height},   {"machine", sweep.machine},      {"threads", sweep.threads},
               {"version", sweep.version}, {"reference", sweep.reference}};
  if (sweep.referenceNoise) json["reference_noise"] = jsonNumber(*sweep.referenceNoise);
  for (const auto& [layer, noise] : sweep.layerNoise) json["layer_noise"][layer] = jsonNumber(noise);
  json["varied"] = Json::object();
  for (const VariedParameter& varied : sweep.varied) json["varied"][varied.key] = varied.values;
  json["points"] = Json::array();
  for (const SweepPoint& point : sweep.points) {
    Json entry = {{"method", point.method},
                  {"settings", settingsJson(point.settings)},
                  {"command", point.command},
                  {"picture", point.picture},
                  {"error_map", point.errorMap}};
    if (!point.label.empty()) entry["label"] = point.label;
    entry["runs"] = Json::array();
    for (const SweepRun& run : point.runs) entry["runs"].push_back(runJson(run));
    json["points"].push_back(std::move(entry));
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace lightvane
