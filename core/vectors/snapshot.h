#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "core/vectors/records.h"
#include "core/vectors/tree.h"
#include "core/vectors/validity.h"

namespace lightvane {

/// Vectors that were published together, with a tree for each key. Immutable and shared between snapshots.
template <class Record>
struct RecordChunk {
  struct KeyTree {
    SurfaceKey key;
    RecordTree tree;                     ///< over the vectors of that key, ...
    std::vector<std::uint32_t> members;  ///< ... which are these, ascending
  };

  std::vector<Record> records;
  std::vector<KeyTree> trees;  ///< ascending by key

  template <class RadiusOf>
  RecordChunk(std::vector<Record> published, const RadiusOf& radiusOf) : records(std::move(published)) {
    std::vector<SurfaceKey> keys;
    for (const Record& record : records) keys.push_back(record.point.key);
    std::sort(keys.begin(), keys.end());
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    for (const SurfaceKey key : keys) {
      KeyTree keyTree{key, {}, {}};
      std::vector<TreeEntry> entries;
      for (std::uint32_t i = 0; i < records.size(); ++i) {
        if (records[i].point.key != key) continue;
        keyTree.members.push_back(i);
        entries.push_back({records[i].point.position, radiusOf(records[i])});
      }
      keyTree.tree = RecordTree(entries);
      trees.push_back(std::move(keyTree));
    }
  }
};

/// An append-only sequence of vectors in immutable chunks. Publishing shares the old chunks and merges the
/// newest small ones, so that their number stays logarithmic. A vector's number is its place in the sequence,
/// for good.
template <class R>
class RecordSet {
 public:
  using Record = R;
  using Chunk = RecordChunk<Record>;

  std::size_t size() const { return starts_.empty() ? 0 : starts_.back() + chunks_.back()->records.size(); }
  bool empty() const { return size() == 0; }

  const Record& operator[](std::size_t number) const {
    const auto after = std::upper_bound(starts_.begin(), starts_.end(), number);
    const auto chunk = static_cast<std::size_t>(after - starts_.begin()) - 1;
    return chunks_[chunk]->records[number - starts_[chunk]];
  }

  template <class RadiusOf>
  RecordSet with(std::vector<Record> added, const RadiusOf& radiusOf) const {
    if (added.empty()) return *this;
    RecordSet next = *this;
    next.settled_.clear();
    while (!next.chunks_.empty() && next.chunks_.back()->records.size() <= 2 * added.size()) {
      const std::vector<Record>& last = next.chunks_.back()->records;
      added.insert(added.begin(), last.begin(), last.end());
      next.chunks_.pop_back();
      next.starts_.pop_back();
    }
    const std::size_t start = next.size();
    next.chunks_.push_back(std::make_shared<const Chunk>(std::move(added), radiusOf));
    next.starts_.push_back(start);
    return next;
  }

  /// The same vectors under the same numbers, in one tree for other radii.
  template <class RadiusOf>
  RecordSet rebuilt(const RadiusOf& radiusOf) const {
    std::vector<Record> all;
    all.reserve(size());
    for (const auto& chunk : chunks_) all.insert(all.end(), chunk->records.begin(), chunk->records.end());
    RecordSet next = RecordSet().with(std::move(all), radiusOf);
    next.settled_ = settled_;
    return next;
  }

  /// Whether a rendering that asked the questions of this name (core/render/questions.h) ended with these
  /// very vectors: begun with them, it asks for no more. Without this it might, where a point of an early
  /// pass would ask among the vectors of later ones: more of them may be less alike, or may have been thinned
  /// away.
  bool settles(RandomKey questions) const {
    return std::find(settled_.begin(), settled_.end(), questions) != settled_.end();
  }
  /// The same vectors, which from now on settle these questions.
  RecordSet settling(RandomKey questions) const {
    RecordSet next = *this;
    if (settles(questions)) return next;
    if (next.settled_.size() == kMostSettled) next.settled_.erase(next.settled_.begin());
    next.settled_.push_back(questions);
    return next;
  }
  /// Names of all that they settle, the oldest first.
  const std::vector<RandomKey>& settled() const { return settled_; }

  /// Numbers of the vectors of `key` whose validity may meet the ball, ascending.
  void query(SurfaceKey key, const Vec3& centre, float radius, std::vector<std::uint32_t>& found) const {
    found.clear();
    for (std::size_t c = 0; c < chunks_.size(); ++c) {
      for (const auto& keyTree : chunks_[c]->trees) {
        if (keyTree.key != key) continue;
        keyTree.tree.query(centre, radius, [&](std::uint32_t i) {
          found.push_back(static_cast<std::uint32_t>(starts_[c]) + keyTree.members[i]);
        });
      }
    }
    std::sort(found.begin(), found.end());
  }

  std::size_t chunkCount() const { return chunks_.size(); }
  std::size_t memoryBytes() const { return size() * (sizeof(Record) + 2 * sizeof(TreeEntry)); }

 private:
  static constexpr std::size_t kMostSettled = 256;

  std::vector<std::shared_ptr<const Chunk>> chunks_;
  std::vector<std::size_t> starts_;
  std::vector<RandomKey> settled_;
};

/// A frozen state of the cache: what a pass reads. Copies are cheap.
struct Snapshot {
  std::uint32_t generation = 0;  ///< rises with every publication
  RecordSet<IndirectLightVector> indirect;
  std::vector<RecordSet<DirectLightVector>> direct;  ///< one for each light of the scene

  std::size_t directCount() const {
    std::size_t count = 0;
    for (const auto& set : direct) count += set.size();
    return count;
  }
};

}  // namespace lightvane
