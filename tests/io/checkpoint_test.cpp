#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/io/test_vectors.h"

namespace lightvane {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

class CheckpointFile : public testing::Test {
 protected:
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "a.lvp";
  const Scene& scene = *test::cornellScene().scene;
  Parameters parameters;

  CacheIdentity identity() const { return test::identityOf(parameters); }
  std::string write(const Checkpoint& checkpoint) const {
    const Expected<void> written = writeCheckpoint(path, checkpoint, identity());
    if (!written) throw std::runtime_error(written.error().message());
    return readFile(path).value();
  }
  Expected<Checkpoint> read(const CacheIdentity& asked) const {
    return readCheckpoint(path, asked, scene, parameters.vectors);
  }
  std::string refusal(const CacheIdentity& asked) const {
    const Expected<Checkpoint> checkpoint = read(asked);
    return checkpoint ? std::string() : checkpoint.error().message();
  }
};

Checkpoint anyCheckpoint() {
  test::RandomVectors vectors(1);
  Checkpoint checkpoint;
  checkpoint.passes = 3;
  checkpoint.samples = 48;
  for (int i = 0; i < 100; ++i) checkpoint.sums.push_back(vectors.number() * 1e-100);
  checkpoint.finished = std::make_shared<const Snapshot>(vectors.snapshot(5));
  return checkpoint;
}

TEST_F(CheckpointFile, KeepsEveryBit) {
  const Checkpoint written = anyCheckpoint();
  write(written);
  const Expected<Checkpoint> checkpoint = read(identity());
  ASSERT_TRUE(checkpoint) << checkpoint.error().message();
  EXPECT_EQ(checkpoint->passes, 3);
  EXPECT_EQ(checkpoint->samples, 48);
  const auto bits = [](const std::vector<double>& sums) {
    std::vector<std::uint64_t> all;
    for (const double sum : sums) all.push_back(std::bit_cast<std::uint64_t>(sum));
    return all;
  };
  EXPECT_EQ(bits(checkpoint->sums), bits(written.sums));
  ASSERT_TRUE(checkpoint->finished);
  EXPECT_EQ(test::bitsOf(*checkpoint->finished), test::bitsOf(*written.finished));
}

TEST_F(CheckpointFile, HasNoVectorsWhereTheMethodHasNone) {
  Checkpoint checkpoint = anyCheckpoint();
  checkpoint.finished = nullptr;
  write(checkpoint);
  const Expected<Checkpoint> back = read(identity());
  ASSERT_TRUE(back) << back.error().message();
  EXPECT_FALSE(back->finished);
}

TEST_F(CheckpointFile, IsRefusedForAnotherSceneOrView) {
  write(anyCheckpoint());
  CacheIdentity other = identity();
  other.view = "camera 64x64";
  EXPECT_THAT(refusal(other), AllOf(StartsWith(path.string() + ": "),
                                    HasSubstr("another view (camera 48x48, not camera 64x64)")));
  other = identity();
  other.sceneHash = "0123456789abcdef";
  EXPECT_THAT(refusal(other), HasSubstr("belongs to another scene"));
}

TEST_F(CheckpointFile, IsRefusedForParametersThatDifferEvenIfVectorsDoNot) {
  write(anyCheckpoint());
  parameters.vectors.ilv.nMin = 7;
  parameters.picture.seed = 2;
  EXPECT_THAT(refusal(identity()), HasSubstr("other parameters: ilv.n_min = 4, not 7; seed = 1, not 2 ("));
  applyRules(parameters.vectors, Rules::Printed);
  EXPECT_THAT(refusal(identity()), HasSubstr(" more ("));
}

TEST_F(CheckpointFile, GoesOnForLongerThanWasAskedFor) {
  write(anyCheckpoint());
  parameters.picture.pathSamples = 1000;
  EXPECT_EQ(refusal(identity()), "");
}

TEST_F(CheckpointFile, IsRefusedWhereCutOrFlipped) {
  const std::string bytes = write(anyCheckpoint());
  // Every place is tried with caches, which have the same container: some places do here.
  for (std::size_t i = 0; i < bytes.size(); i += 101) {
    folder.write("a.lvp", bytes.substr(0, i));
    EXPECT_THAT(refusal(identity()), HasSubstr("is cut short")) << "after " << i << " bytes";
    std::string flipped = bytes;
    flipped[i] = static_cast<char>(flipped[i] ^ 0x10);
    folder.write("a.lvp", flipped);
    EXPECT_THAT(refusal(identity()), StartsWith(path.string() + ": ")) << "byte " << i;
  }
}

TEST_F(CheckpointFile, IsRefusedWithNegativeCounts) {
  Checkpoint checkpoint;
  checkpoint.samples = -1;
  write(checkpoint);
  EXPECT_THAT(refusal(identity()), HasSubstr("0 passes and -1 samples"));
}

TEST_F(CheckpointFile, IsNoCache) {
  ASSERT_TRUE(writeCache(path, *anyCheckpoint().finished, identity()));
  EXPECT_THAT(refusal(identity()), HasSubstr("is not a Lightvane checkpoint"));
}

}  // namespace
}  // namespace lightvane
