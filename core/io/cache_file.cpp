#include "core/io/cache_file.h"

#include <algorithm>
#include <array>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/color.h"
#include "core/base/file.h"
#include "core/image/image_format.h"
#include "core/io/record_fields.h"
#include "core/io/sections.h"
#include "core/vectors/validity.h"

namespace lightvane {

// What the files hold beside records. To be found by name look-up from archive.h, so not in the unnamed
// namespace.

/// What is said of the vectors before they come, one section each list.
struct VectorsHeader {
  std::uint32_t generation = 0;
  std::uint32_t lights = 0;
};

/// A checkpoint's numbers.
struct CheckpointNumbers {
  std::int32_t passes = 0;
  std::int32_t samples = 0;
  std::vector<double> sums;
  bool hasVectors = false;
};

template <class Archive>
void visitFields(Archive& archive, CacheIdentity& identity) {
  auto& [sceneHash, parameters, view] = identity;
  archive(sceneHash, parameters, view);
}
template <class Archive>
void visitFields(Archive& archive, VectorsHeader& header) {
  auto& [generation, lights] = header;
  archive(generation, lights);
}
template <class Archive>
void visitFields(Archive& archive, CheckpointNumbers& numbers) {
  auto& [passes, samples, sums, hasVectors] = numbers;
  archive(passes, samples, sums, hasVectors);
}

namespace {

constexpr FileKind kCacheKind{"\x89LVC\r\n\x1a\n", "a Lightvane cache"};
constexpr FileKind kCheckpointKind{"\x89LVP\r\n\x1a\n", "a Lightvane checkpoint"};

constexpr SectionKind kIdentitySection{"IDEN", "scene and parameters"};
constexpr SectionKind kHeaderSection{"VECS", "counts of vectors"};
constexpr SectionKind kIndirectSection{"ILVS", "indirect light vectors"};
constexpr SectionKind kDirectSection{"DLVS", "direct light vectors"};
constexpr SectionKind kNumbersSection{"NUMS", "sums"};

/// Parameters that say what the numbers in a vector mean.
constexpr std::array kMeaningOfVectors = {"method.rules", "ilv.store", "dlv.store", "dlv.normalise"};
/// Parameters that say how long to go on, and change nothing of what is done until then.
constexpr std::array kHowLongToGoOn = {"path.samples"};

/// A parameter that a file does not agree on with what is asked for.
struct Difference {
  std::string key;
  std::string stored;
  std::string asked;

  std::string text() const {
    return fmt::format("{} = {}, not {}", printable(key), printable(stored), asked);
  }
};

std::vector<Difference> findDifferences(const CacheIdentity& stored, const CacheIdentity& asked) {
  std::set<std::string> keys;
  for (const auto* parameters : {&stored.parameters, &asked.parameters}) {
    for (const auto& [key, value] : *parameters) keys.insert(key);
  }
  const auto valueOf = [](const CacheIdentity& identity, const std::string& key) {
    const auto found = identity.parameters.find(key);
    return found == identity.parameters.end() ? std::string("unknown") : found->second;
  };
  std::vector<Difference> differences;
  for (const std::string& key : keys) {
    const Difference difference{key, valueOf(stored, key), valueOf(asked, key)};
    if (difference.stored != difference.asked) differences.push_back(difference);
  }
  return differences;
}

template <std::size_t N>
bool isAmong(const std::string& key, const std::array<const char*, N>& keys) {
  return std::find(keys.begin(), keys.end(), key) != keys.end();
}

/// The first few, so that a message stays one that is read.
std::string listDifferences(const std::vector<Difference>& differences) {
  constexpr std::size_t kMost = 5;
  std::vector<std::string> texts;
  for (const Difference& d : differences) {
    if (texts.size() < kMost) texts.push_back(d.text());
  }
  std::string text = fmt::format("{}", fmt::join(texts, "; "));
  if (differences.size() > kMost) text += fmt::format("; and {} more", differences.size() - kMost);
  return text;
}

/// What the file belongs to; refused where that is another scene than the one asked for.
Expected<CacheIdentity> readIdentity(SectionReader& file, const CacheIdentity& asked) {
  CacheIdentity stored;
  if (auto read = file.section(kIdentitySection, [&](ByteReader& section) { section(stored); }); !read) {
    return tl::unexpected(read.error());
  }
  // The scene's own hash, and what its lights are multiplied by, stand side by side.
  const auto sceneOf = [](const std::string& hash) { return hash.substr(0, hash.find(' ')); };
  if (stored.sceneHash != asked.sceneHash && sceneOf(stored.sceneHash) == sceneOf(asked.sceneHash)) {
    return file.error("was computed with other settings of the lights",
                      "set them as they were, or compute the vectors anew");
  }
  if (stored.sceneHash != asked.sceneHash) {
    return file.error(
        fmt::format("belongs to another scene ({}, not {})", printable(stored.sceneHash), asked.sceneHash),
        "it serves only the scene that it was computed for; cameras and [render] may change");
  }
  return stored;
}

template <class Record>
void writeRecords(SectionWriter& file, const SectionKind& kind, const RecordSet<Record>& records) {
  file.section(kind, [&](ByteWriter& section) {
    section.sequence(records);
    section.sequence(records.settled());
  });
}

void writeVectors(SectionWriter& file, const Snapshot& snapshot) {
  VectorsHeader header{snapshot.generation, static_cast<std::uint32_t>(snapshot.direct.size())};
  file.section(kHeaderSection, [&](ByteWriter& section) { section(header); });
  writeRecords(file, kIndirectSection, snapshot.indirect);
  for (const auto& direct : snapshot.direct) writeRecords(file, kDirectSection, direct);
}

/// Reads a list of vectors, and refuses what trees cannot be built of: places without an order, and surfaces
/// that the scene does not have, of which there could be as many as vectors.
template <class Record>
Expected<RecordSet<Record>> readRecords(SectionReader& file, const SectionKind& kind, SurfaceKey largestKey,
                                        const VectorRadii& radii) {
  std::vector<Record> records;
  std::vector<RandomKey> settled;
  if (auto read = file.section(kind, [&](ByteReader& section) { section(records, settled); }); !read) {
    return tl::unexpected(read.error());
  }
  for (const Record& record : records) {
    if (!isFinite(record.point.position)) return file.damaged(fmt::format("its {} are nowhere", kind.name));
    if (record.point.key > largestKey) {
      return file.damaged(fmt::format("its {} are of surfaces that the scene does not have", kind.name));
    }
  }
  RecordSet<Record> set = RecordSet<Record>().with(std::move(records), radii);
  for (const RandomKey questions : settled) set = set.settling(questions);
  return set;
}

Expected<Snapshot> readVectors(SectionReader& file, const Scene& scene, const VectorParameters& parameters) {
  VectorsHeader header;
  if (auto read = file.section(kHeaderSection, [&](ByteReader& section) { section(header); }); !read) {
    return tl::unexpected(read.error());
  }
  if (header.lights != scene.lights.size()) {
    return file.damaged(fmt::format("it has vectors for {} lights, and the scene has {}", header.lights,
                                    scene.lights.size()));
  }
  SurfaceKey largestKey = kLambertKey;
  for (const Material& material : scene.materials) {
    largestKey = std::max(largestKey, brdfSurfaceKey(material.brdfKey));
  }
  Snapshot snapshot;
  snapshot.generation = header.generation;
  const VectorRadii radii(parameters, scene);
  auto indirect = readRecords<IndirectLightVector>(file, kIndirectSection, largestKey, radii);
  if (!indirect) return tl::unexpected(indirect.error());
  snapshot.indirect = std::move(*indirect);
  for (std::uint32_t light = 0; light < header.lights; ++light) {
    auto direct = readRecords<DirectLightVector>(file, kDirectSection, largestKey, radii);
    if (!direct) return tl::unexpected(direct.error());
    snapshot.direct.push_back(std::move(*direct));
  }
  return snapshot;
}

}  // namespace

Expected<void> writeCache(const std::filesystem::path& path, const Snapshot& snapshot,
                          const CacheIdentity& identity) {
  CacheIdentity ofAnyView = identity;
  ofAnyView.view.clear();
  SectionWriter file(kCacheKind);
  file.section(kIdentitySection, [&](ByteWriter& section) { section(ofAnyView); });
  writeVectors(file, snapshot);
  return writeFileAtomically(path, file.bytes());
}

Expected<CacheContent> readCache(const std::filesystem::path& path, const CacheIdentity& identity,
                                 const Scene& scene, const VectorParameters& parameters) {
  Expected<SectionReader> file = SectionReader::open(path, kCacheKind);
  if (!file) return tl::unexpected(file.error());
  Expected<CacheIdentity> stored = readIdentity(*file, identity);
  if (!stored) return tl::unexpected(stored.error());

  CacheContent content;
  const std::vector<FieldDescription> fields = describeParameters(Parameters{});
  std::vector<Difference> otherMeaning;
  for (const Difference& d : findDifferences(*stored, identity)) {
    if (isAmong(d.key, kMeaningOfVectors)) {
      otherMeaning.push_back(d);
      continue;
    }
    const auto known =
        std::find_if(fields.begin(), fields.end(), [&](const auto& row) { return d.key == row.field.key; });
    if (known != fields.end() && known->field.cost < ChangeCost::Vectors) continue;
    content.warnings.push_back(fmt::format("{}: its vectors were computed with {}", path.string(), d.text()));
  }
  if (!otherMeaning.empty()) {
    return file->error(fmt::format("its vectors store something else: {}", listDifferences(otherMeaning)),
                       "ask for the same rules, or have the vectors computed anew");
  }
  Expected<Snapshot> snapshot = readVectors(*file, scene, parameters);
  if (!snapshot) return tl::unexpected(snapshot.error());
  if (auto ended = file->end(); !ended) return tl::unexpected(ended.error());
  content.snapshot = std::move(*snapshot);
  content.parameters = std::move(stored->parameters);
  return content;
}

Expected<void> writeCheckpoint(const std::filesystem::path& path, const Checkpoint& checkpoint,
                               const CacheIdentity& identity) {
  CacheIdentity stored = identity;
  const auto& [passes, samples, sums, finished] = checkpoint;
  CheckpointNumbers numbers{passes, samples, sums, finished != nullptr};
  SectionWriter file(kCheckpointKind);
  file.section(kIdentitySection, [&](ByteWriter& section) { section(stored); });
  file.section(kNumbersSection, [&](ByteWriter& section) { section(numbers); });
  if (finished) writeVectors(file, *finished);
  return writeFileAtomically(path, file.bytes());
}

Expected<Checkpoint> readCheckpoint(const std::filesystem::path& path, const CacheIdentity& identity,
                                    const Scene& scene, const VectorParameters& parameters) {
  Expected<SectionReader> file = SectionReader::open(path, kCheckpointKind);
  if (!file) return tl::unexpected(file.error());
  const Expected<CacheIdentity> stored = readIdentity(*file, identity);
  if (!stored) return tl::unexpected(stored.error());
  if (stored->view != identity.view) {
    return file->error(
        fmt::format("belongs to another view ({}, not {})", printable(stored->view), identity.view),
        "go on with the camera, size and crop that it was stopped at");
  }
  std::vector<Difference> differences = findDifferences(*stored, identity);
  std::erase_if(differences, [](const Difference& d) { return isAmong(d.key, kHowLongToGoOn); });
  if (!differences.empty()) {
    return file->error(fmt::format("was stopped with other parameters: {}", listDifferences(differences)),
                       "go on with the same, or begin anew");
  }

  CheckpointNumbers numbers;
  if (auto read = file->section(kNumbersSection, [&](ByteReader& section) { section(numbers); }); !read) {
    return tl::unexpected(read.error());
  }
  if (numbers.passes < 0 || numbers.samples < 0) {
    return file->damaged(
        fmt::format("it has made {} passes and {} samples", numbers.passes, numbers.samples));
  }
  Checkpoint checkpoint{numbers.passes, numbers.samples, std::move(numbers.sums), nullptr};
  if (numbers.hasVectors) {
    Expected<Snapshot> snapshot = readVectors(*file, scene, parameters);
    if (!snapshot) return tl::unexpected(snapshot.error());
    checkpoint.finished = std::make_shared<const Snapshot>(std::move(*snapshot));
  }
  if (auto ended = file->end(); !ended) return tl::unexpected(ended.error());
  return checkpoint;
}

}  // namespace lightvane
