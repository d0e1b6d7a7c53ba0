#include "core/io/cache_file.h"

#include <fstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/io/sections.h"
#include "tests/io/test_vectors.h"

namespace lightvane {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;
using testing::StartsWith;

/// One message in one line that begins with the file's name and says more than that.
auto isMessageAbout(const std::filesystem::path& path) {
  return AllOf(StartsWith(path.string() + ": "), Not(HasSubstr("\n")),
               SizeIs(testing::Ge(path.string().size() + 10)));
}

class CacheFile : public testing::Test {
 protected:
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "a.lvc";
  const Scene& scene = *test::cornellScene().scene;
  Parameters parameters;

  CacheIdentity identity() const { return test::identityOf(parameters); }
  std::string write(const Snapshot& snapshot) const {
    const Expected<void> written = writeCache(path, snapshot, identity());
    if (!written) throw std::runtime_error(written.error().message());
    return readFile(path).value();
  }
  Expected<CacheContent> read() const { return readCache(path, identity(), scene, parameters.vectors); }
  Expected<CacheContent> read(const std::string& bytes) const {
    // Over the old file: some file systems flush one that is truncated or replaced, for thousands of them.
    if (!std::filesystem::exists(path)) folder.write(path.filename().string(), bytes);
    std::fstream(path, std::ios::in | std::ios::out | std::ios::binary)
        .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    std::filesystem::resize_file(path, bytes.size());
    return read();
  }
  /// The message that refuses the bytes, or an empty string where they are read.
  std::string refusal(const std::string& bytes) const {
    const Expected<CacheContent> content = read(bytes);
    return content ? std::string() : content.error().message();
  }
  std::string refusal() const {
    const Expected<CacheContent> content = read();
    return content ? std::string() : content.error().message();
  }
};

TEST_F(CacheFile, KeepsEveryBit) {
  Snapshot snapshot = test::RandomVectors(1).snapshot(50);
  snapshot.indirect = snapshot.indirect.settling({1, 2}).settling({0x01234567U, 0x89abcdefU});
  snapshot.direct[0] = snapshot.direct[0].settling({3, 4});
  write(snapshot);
  const Expected<CacheContent> content = read();
  ASSERT_TRUE(content) << content.error().message();
  EXPECT_EQ(test::bitsOf(content->snapshot), test::bitsOf(snapshot));
  EXPECT_EQ(content->snapshot.generation, 7u);
  EXPECT_EQ(content->snapshot.indirect.settled(), snapshot.indirect.settled());
  EXPECT_EQ(content->snapshot.direct[0].settled(), snapshot.direct[0].settled());
  EXPECT_EQ(content->parameters, identity().parameters);
  EXPECT_THAT(content->warnings, IsEmpty());
}

TEST_F(CacheFile, HasTheSameBytesHoweverTheVectorsWerePublished) {
  const auto radius = [](const auto&) { return 0.1f; };
  test::RandomVectors vectors(2);
  Snapshot atOnce = vectors.snapshot(0);
  Snapshot inParts = atOnce;
  std::vector<IndirectLightVector> all;
  for (int i = 0; i < 20; ++i) all.push_back(vectors.indirect());
  atOnce.indirect = atOnce.indirect.with(all, radius);
  inParts.indirect = inParts.indirect.with({all.begin(), all.begin() + 17}, radius);
  inParts.indirect = inParts.indirect.with({all.begin() + 17, all.end()}, radius);
  ASSERT_EQ(inParts.indirect.chunkCount(), 2u);
  EXPECT_TRUE(write(atOnce) == write(inParts));
  EXPECT_TRUE(write(read()->snapshot) == write(atOnce)) << "read and written again";
}

TEST_F(CacheFile, IsForAnyView) {
  const Snapshot snapshot = test::RandomVectors(3).snapshot(2);
  CacheIdentity one = identity();
  CacheIdentity other = identity();
  other.view = "another";
  ASSERT_TRUE(writeCache(path, snapshot, one));
  const std::string bytes = readFile(path).value();
  ASSERT_TRUE(writeCache(path, snapshot, other));
  EXPECT_TRUE(readFile(path).value() == bytes);
  EXPECT_TRUE(readCache(path, other, scene, parameters.vectors));
}

// FNV-1a, 64 bit (Fowler, Noll, Vo): short enough to be written here.
std::uint64_t fingerprint(const std::string& bytes) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
  return hash;
}

TEST_F(CacheFile, HasTheBytesOfItsVersion) {
  // Where this fails, kFileVersion has to rise with the fingerprint, or old files are misread.
  CacheIdentity fixed;
  fixed.sceneHash = "0123456789abcdef";
  fixed.parameters = {{"seed", "1"}};
  ASSERT_TRUE(writeCache(path, test::RandomVectors(4).snapshot(1), fixed));
  const std::string bytes = readFile(path).value();
  EXPECT_EQ(bytes.substr(0, 12), std::string("\x89LVC\r\n\x1a\n\3\0\0\0", 12));
  // Preamble; frames of 20 bytes a section; identity, counts, an ILV of 205 bytes, a DLV of 122, each with
  // the number of questions they settle.
  EXPECT_EQ(bytes.size(),
            12u + 4 * 20 + (8 + 16 + 8 + (8 + 4) + (8 + 1) + 8) + 8 + (8 + 205 + 8) + (8 + 122 + 8));
  EXPECT_EQ(fmt::format("version {}: {:016x}", kFileVersion, fingerprint(bytes)),
            "version 3: 48a1968d73295068");
}

TEST_F(CacheFile, BuildsTreesWithTheRadiiOfTheParametersThatAreAskedFor) {
  test::RandomVectors vectors(5);
  const IlvRules rules(parameters.vectors.ilv, scene.diagonal);
  const auto ilvRadiusOf = [&](const IndirectLightVector& v) { return ilvRadius(v, rules); };
  std::vector<IndirectLightVector> ilvs;
  std::vector<DirectLightVector> dlvs;
  for (int i = 0; i < 200; ++i) {
    ilvs.push_back(vectors.indirect());
    IndirectLightVector& v = ilvs.back();
    v.harmonicMean = 0.01f * static_cast<float>(1 + i % 20);
    v.leastDistance = v.harmonicMean / 4;
    v.lobeWidth = 0.0f;
    v.point.footprint = 0.002f;
    v.point.key = kLambertKey;
    dlvs.push_back(vectors.direct());
    dlvs.back().point.key = kLambertKey;
  }
  Snapshot snapshot = vectors.snapshot(0);
  snapshot.indirect = snapshot.indirect.with(ilvs, [](const auto&) { return 0.0f; });
  snapshot.direct[0] = snapshot.direct[0].with(dlvs, [](const auto&) { return 0.0f; });
  write(snapshot);

  parameters.vectors.dlv.rMax = Length::metres(0.1);
  const float dlvRadius = static_cast<float>(0.1 / scene.metresPerNormalisedUnit());
  const Expected<CacheContent> content = read();
  ASSERT_TRUE(content) << content.error().message();
  const auto ilvsWanted = RecordSet<IndirectLightVector>().with(ilvs, ilvRadiusOf);
  const auto dlvsWanted = RecordSet<DirectLightVector>().with(dlvs, [&](const auto&) { return dlvRadius; });
  std::vector<std::uint32_t> found;
  std::vector<std::uint32_t> wanted;
  std::size_t foundIlvs = 0;
  std::size_t foundDlvs = 0;
  for (const DirectLightVector& at : dlvs) {
    content->snapshot.indirect.query(kLambertKey, at.point.position, 0.0f, found);
    ilvsWanted.query(kLambertKey, at.point.position, 0.0f, wanted);
    EXPECT_EQ(found, wanted);
    foundIlvs += found.size();
    content->snapshot.direct[0].query(kLambertKey, at.point.position, 0.0f, found);
    dlvsWanted.query(kLambertKey, at.point.position, 0.0f, wanted);
    EXPECT_EQ(found, wanted);
    foundDlvs += found.size();
  }
  EXPECT_GT(foundIlvs, 0u);
  EXPECT_GT(foundDlvs, dlvs.size()) << "every place finds itself; some must find neighbours";
}

TEST_F(CacheFile, IsRefusedWhereverItIsCut) {
  const std::string bytes = write(test::RandomVectors(6).snapshot(1));
  for (std::size_t length = bytes.size(); length-- > 0;) {
    EXPECT_THAT(refusal(bytes.substr(0, length)), AllOf(isMessageAbout(path), HasSubstr("is cut short")))
        << "after " << length << " of " << bytes.size() << " bytes";
  }
  EXPECT_EQ(refusal(bytes), "");
}

TEST_F(CacheFile, IsRefusedWhicheverByteIsFlipped) {
  const std::string bytes = write(test::RandomVectors(7).snapshot(1));
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    for (const int flip : {0x01, 0x80, 0xff}) {
      std::string flipped = bytes;
      flipped[i] = static_cast<char>(flipped[i] ^ flip);
      EXPECT_THAT(refusal(flipped), isMessageAbout(path)) << "byte " << i << " ^ " << flip;
    }
  }
}

TEST_F(CacheFile, IsRefusedWhereItGoesOnAfterItsEnd) {
  const std::string bytes = write(test::RandomVectors(8).snapshot(1));
  EXPECT_THAT(refusal(bytes + '\0'), AllOf(isMessageAbout(path), HasSubstr("1 bytes follow its end")));
}

TEST_F(CacheFile, SaysWhatItIsIfItIsNoCacheOfThisVersion) {
  const std::string bytes = write(test::RandomVectors(9).snapshot(1));
  std::string newer = bytes;
  newer[8] = 4;
  EXPECT_THAT(refusal(newer), HasSubstr("is of version 4, and this Lightvane reads version 3 (use a newer"));
  std::string older = bytes;
  older[8] = 2;
  EXPECT_THAT(refusal(older), HasSubstr("is of version 2, which this Lightvane does not read"));
  EXPECT_THAT(refusal("version = 1\n"), HasSubstr("is not a Lightvane cache"));
  ASSERT_TRUE(writeCheckpoint(path, Checkpoint{}, identity()));
  EXPECT_THAT(refusal(), HasSubstr("is not a Lightvane cache"));
  std::filesystem::remove(path);
  EXPECT_THAT(refusal(), HasSubstr("no such file"));
}

TEST_F(CacheFile, IsRefusedForAnotherScene) {
  write(test::RandomVectors(10).snapshot(1));
  CacheIdentity other = identity();
  other.sceneHash = "0123456789abcdef";
  const Expected<CacheContent> content = readCache(path, other, scene, parameters.vectors);
  ASSERT_FALSE(content);
  EXPECT_THAT(content.error().message(),
              AllOf(isMessageAbout(path),
                    HasSubstr("another scene (" + identity().sceneHash + ", not 0123456789abcdef)")));
}

struct Setting {
  const char* key;
  const char* value;
};
void PrintTo(const Setting& setting, std::ostream* out) { *out << setting.key << " = " << setting.value; }
std::string settingName(const testing::TestParamInfo<Setting>& info) {
  std::string name = info.param.key;
  std::replace(name.begin(), name.end(), '.', '_');
  return name;
}

class CacheOfOtherMeaning : public CacheFile, public testing::WithParamInterface<Setting> {};

TEST_P(CacheOfOtherMeaning, IsRefused) {
  write(test::RandomVectors(11).snapshot(1));
  ASSERT_TRUE(setParameter(parameters, GetParam().key, GetParam().value, "test"));
  EXPECT_THAT(refusal(),
              AllOf(isMessageAbout(path), HasSubstr("store something else: " + std::string(GetParam().key)),
                    HasSubstr(std::string(", not ") + GetParam().value)));
}

INSTANTIATE_TEST_SUITE_P(Settings, CacheOfOtherMeaning,
                         testing::Values(Setting{"method.rules", "paper"}, Setting{"ilv.store", "vector"},
                                         Setting{"dlv.store", "vector"}, Setting{"dlv.normalise", "false"}),
                         settingName);

TEST_F(CacheFile, NamesAllRulesThatDifferInOneMessage) {
  write(test::RandomVectors(12).snapshot(1));
  applyRules(parameters.vectors, Rules::Printed);
  EXPECT_THAT(refusal(),
              HasSubstr("dlv.normalise = true, not false; dlv.store = split, not vector; ilv.store = "
                        "split, not vector; method.rules = refined, not printed"));
}

TEST_F(CacheFile, WarnsOfVectorsThatWouldBeComputedOtherwise) {
  write(test::RandomVectors(13).snapshot(1));
  parameters.picture.seed = 5;
  parameters.vectors.ilv.rows = 3;
  const Expected<CacheContent> content = read();
  ASSERT_TRUE(content) << content.error().message();
  EXPECT_THAT(content->warnings,
              ElementsAre(path.string() + ": its vectors were computed with ilv.rows = 12, not 3",
                          path.string() + ": its vectors were computed with seed = 1, not 5"));
  EXPECT_EQ(content->parameters.at("seed"), "1") << "the parameters are those of the file";
}

TEST_F(CacheFile, DoesNotWarnOfHowVectorsAreUsed) {
  write(test::RandomVectors(14).snapshot(1));
  parameters.vectors.ilv.nMin = 9;
  parameters.vectors.ilv.radiusScale = 0.1;
  const Expected<CacheContent> content = read();
  ASSERT_TRUE(content) << content.error().message();
  EXPECT_THAT(content->warnings, IsEmpty());
}

TEST_F(CacheFile, WarnsOfParametersThatOnlyOneSideKnows) {
  const Snapshot snapshot = test::RandomVectors(15).snapshot(1);
  CacheIdentity other = identity();
  other.parameters.erase("ilv.rows");
  other.parameters["ilv.\n"] = "\x1b[31m";
  ASSERT_TRUE(writeCache(path, snapshot, other));
  const Expected<CacheContent> content = read();
  ASSERT_TRUE(content) << content.error().message();
  EXPECT_THAT(content->warnings, ElementsAre(HasSubstr("with ilv.? = ?[31m, not unknown"),
                                             HasSubstr("with ilv.rows = unknown, not 12")));
}

// What no writer makes, with checksums that fit.

struct Section {
  std::string tag;
  std::string content;
};

std::vector<Section> takeApart(const std::string& bytes) {
  std::vector<Section> sections;
  for (std::size_t at = 12; at < bytes.size();) {
    std::uint64_t length = 0;
    ByteReader(std::string_view(bytes).substr(at + 4)).number(length);
    sections.push_back({bytes.substr(at, 4), bytes.substr(at + 12, length)});
    at += 20 + length;
  }
  return sections;
}

std::string putTogether(const std::vector<Section>& sections, std::string_view magic = "\x89LVC\r\n\x1a\n") {
  SectionWriter file({magic, ""});
  for (const Section& section : sections) {
    file.section({section.tag, ""}, [&](ByteWriter& writer) {
      for (char c : section.content) writer(c);
    });
  }
  return file.bytes();
}

TEST_F(CacheFile, IsRefusedWithSectionsInAnotherOrder) {
  const std::string bytes = write(test::RandomVectors(16).snapshot(1));
  std::vector<Section> sections = takeApart(bytes);
  ASSERT_EQ(putTogether(sections), bytes);
  std::swap(sections[2], sections[3]);
  EXPECT_THAT(refusal(putTogether(sections)), HasSubstr("indirect light vectors are not in their place"));
}

TEST_F(CacheFile, IsRefusedWithCountsThatItCannotHold) {
  for (std::size_t section = 0; section < 4; ++section) {
    for (const std::uint64_t count : {std::uint64_t{2}, std::uint64_t{1} << 33, ~std::uint64_t{0}}) {
      std::vector<Section> sections = takeApart(write(test::RandomVectors(17).snapshot(1)));
      ByteWriter number;
      number.number(count);
      // The count of the scene's hash, of lights (which the generation precedes), and of vectors.
      sections[section].content.replace(section == 1 ? 4 : 0, section == 1 ? 4 : 8,
                                        number.bytes().substr(0, section == 1 ? 4 : 8));
      EXPECT_THAT(refusal(putTogether(sections)), isMessageAbout(path))
          << count << " in section " << sections[section].tag;
    }
  }
}

TEST_F(CacheFile, IsRefusedWithMoreInASectionThanItsCountSays) {
  std::vector<Section> sections = takeApart(write(test::RandomVectors(18).snapshot(1)));
  sections[2].content += '\0';
  EXPECT_THAT(refusal(putTogether(sections)), HasSubstr("its indirect light vectors cannot be read"));
}

TEST_F(CacheFile, IsRefusedWithVectorsThatAreNowhere) {
  for (const float x : {kInfinity, std::numeric_limits<float>::quiet_NaN()}) {
    test::RandomVectors vectors(19);
    Snapshot snapshot = vectors.snapshot(0);
    IndirectLightVector lost = vectors.indirect();
    lost.point.position.y = x;
    snapshot.indirect = snapshot.indirect.with({lost}, [](const auto&) { return 0.0f; });
    write(snapshot);
    EXPECT_THAT(refusal(), AllOf(isMessageAbout(path), HasSubstr("vectors are nowhere"))) << x;
  }
}

TEST_F(CacheFile, IsRefusedWithVectorsOfSurfacesThatTheSceneDoesNotHave) {
  test::RandomVectors vectors(20);
  Snapshot snapshot = vectors.snapshot(0);
  DirectLightVector lost = vectors.direct();
  lost.point.key = 1000;
  snapshot.direct[0] = snapshot.direct[0].with({lost}, [](const auto&) { return 0.0f; });
  write(snapshot);
  EXPECT_THAT(refusal(), AllOf(isMessageAbout(path), HasSubstr("surfaces that the scene does not have")));
}

TEST_F(CacheFile, IsReadOrRefusedWhateverItsSectionsHold) {
  const std::vector<Section> sound = takeApart(write(test::RandomVectors(21).snapshot(3)));
  std::mt19937 random(22);
  int refused = 0;
  for (int i = 0; i < 2000; ++i) {
    std::vector<Section> sections = sound;
    const std::size_t changes = 1 + random() % 4;
    for (std::size_t change = 0; change < changes; ++change) {
      std::string& content = sections[random() % sections.size()].content;
      content[random() % content.size()] = static_cast<char>(random());
    }
    const std::string message = refusal(putTogether(sections));
    if (message.empty()) continue;
    ++refused;
    EXPECT_THAT(message, isMessageAbout(path));
  }
  EXPECT_GT(refused, 100);
}

TEST(ByteReader, TakesNoMemoryForElementsThatTheBytesCannotHold) {
  ByteWriter writer;
  std::vector<double> numbers(1000, 1.0);
  writer(numbers);
  std::string bytes = writer.bytes();
  ByteWriter count;
  count.number(std::uint64_t{1001});
  bytes.replace(0, 8, count.bytes());
  ByteReader reader(bytes);
  std::vector<double> read;
  reader(read);
  EXPECT_FALSE(reader.endedWell());
  EXPECT_EQ(read.capacity(), 0u);
}

TEST_F(CacheFile, SaysWhyItCannotBeWritten) {
  const std::filesystem::path nowhere = folder.path() / "no such folder" / "a.lvc";
  const Expected<void> written = writeCache(nowhere, Snapshot{}, identity());
  ASSERT_FALSE(written);
  EXPECT_THAT(written.error().message(), AllOf(isMessageAbout(nowhere), HasSubstr("does not exist")));
}

}  // namespace
}  // namespace lightvane
