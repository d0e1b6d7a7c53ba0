#include "app/settings.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace lightvane {
namespace {

using Pairs = std::vector<std::pair<std::string, std::string>>;

std::vector<RenderSetting> sceneSettings(const Pairs& pairs) {
  std::vector<RenderSetting> settings;
  for (const auto& [key, value] : pairs) settings.push_back({key, value, "room.toml:1:1"});
  return settings;
}

CommandLineSettings setOptions(const Pairs& pairs) {
  CommandLineSettings command;
  for (const auto& [key, value] : pairs)
    command.settings.push_back({key, value, "--set " + key + "=" + value});
  return command;
}

struct Row {
  const char* name;
  Pairs scene;
  Pairs command;
  Pairs expected;  ///< what these keys come to
};

void PrintTo(const Row& row, std::ostream* out) { *out << row.name; }

class Precedence : public testing::TestWithParam<Row> {};

TEST_P(Precedence, IsAsTheTableSays) {
  const Row& row = GetParam();
  const auto parameters = resolveParameters(sceneSettings(row.scene), setOptions(row.command));
  ASSERT_TRUE(parameters) << parameters.error().message();
  const auto text = parametersAsText(*parameters);
  for (const auto& [key, value] : row.expected) EXPECT_EQ(text.at(key), value) << key;
}

// ilv.n_min is set by the rules: 4 by default, 3 by `paper`; ilv.radius_scale by the presets, too: 0.5 by
// `draft`.
INSTANTIATE_TEST_SUITE_P(
    Settings, Precedence,
    testing::Values(
        Row{"Defaults", {}, {}, {{"ilv.n_min", "4"}, {"method.rules", "refined"}}},
        Row{"RulesOverDefaults",
            {},
            {{"method.rules", "paper"}},
            {{"ilv.n_min", "3"}, {"ilv.weight", "absolute"}}},
        Row{"PresetOverRules",
            {},
            {{"preset", "draft"}, {"method.rules", "paper"}},
            {{"ilv.rows", "8"}, {"ilv.n_min", "3"}, {"ilv.radius_scale", "1"}, {"ilv.weight", "absolute"}}},
        Row{"SceneKeysOverPreset",
            {{"ilv.n_min", "7"}},
            {{"preset", "draft"}},
            {{"ilv.n_min", "7"}, {"ilv.rows", "8"}}},
        Row{"SceneKeysOverCommandLineRules",
            {{"ilv.n_min", "7"}},
            {{"method.rules", "paper"}},
            {{"ilv.n_min", "7"}, {"ilv.weight", "absolute"}}},
        Row{"CommandLineOverScene", {{"ilv.n_min", "7"}}, {{"ilv.n_min", "9"}}, {{"ilv.n_min", "9"}}},
        Row{"LastSetWins", {}, {{"ilv.n_min", "9"}, {"ilv.n_min", "10"}}, {{"ilv.n_min", "10"}}},
        Row{"OrderOfRulesAndKeysDoesNotMatter",
            {},
            {{"ilv.n_min", "9"}, {"method.rules", "paper"}},
            {{"ilv.n_min", "9"}, {"ilv.weight", "absolute"}}},
        Row{"CommandLineRulesReplaceTheScenes",
            {{"method.rules", "paper"}},
            {{"method.rules", "printed"}},
            {{"method.rules", "printed"}, {"ilv.weight", "printed"}}},
        Row{"ScenePreset", {{"preset", "draft"}}, {}, {{"ilv.radius_scale", "0.5"}}},
        Row{"CommandLinePresetReplacesTheScenes",
            {{"preset", "draft"}},
            {{"preset", "fine"}},
            {{"ilv.radius_scale", "0.3"}, {"ilv.rows", "20"}}}),
    [](const auto& row) { return row.param.name; });

TEST(Settings, SamplesPerPixelMeanPathsForTheMethodPath) {
  CommandLineSettings command;
  command.samplesPerPixel = RenderSetting{"", "9", "--spp"};
  EXPECT_EQ(resolveParameters({}, command)->picture.filmSamples, 9);
  EXPECT_EQ(resolveParameters({}, command)->picture.pathSamples, Parameters{}.picture.pathSamples);
  const auto path = resolveParameters(sceneSettings({{"method.name", "path"}}), command);
  EXPECT_EQ(path->picture.pathSamples, 9);
  EXPECT_EQ(path->picture.filmSamples, Parameters{}.picture.filmSamples);
}

TEST(Settings, ErrorsNameTheirPlace) {
  const auto error = [](const Pairs& scene, const Pairs& command) {
    const auto parameters = resolveParameters(sceneSettings(scene), setOptions(command));
    return parameters ? std::string("none") : parameters.error().message();
  };
  EXPECT_EQ(error({{"ilv.nmin", "3"}}, {}),
            "room.toml:1:1: there is no parameter 'ilv.nmin' (did you mean ilv.n_min?)");
  EXPECT_EQ(error({{"preset", "drft"}}, {}),
            "room.toml:1:1: preset takes draft, balanced or fine, not 'drft' (did you mean draft?)");
  EXPECT_THAT(error({}, {{"method.rules", "ours"}}),
              testing::StartsWith("--set method.rules=ours: method.rules takes printed, paper or refined"));
}

TEST(Settings, AnOptionAndASetOfTheSameKeyContradict) {
  CommandLineSettings command = setOptions({{"seed", "4"}});
  command.settings.push_back({"seed", "3", "--seed"});
  const auto parameters = resolveParameters({}, command);
  ASSERT_FALSE(parameters);
  EXPECT_EQ(parameters.error().message(), "--set seed=4: sets seed, and so does --seed (give one of them)");
}

TEST(Settings, NonDefaultParametersAreThoseAndNoOther) {
  EXPECT_EQ(nonDefaultParameters(Parameters{}), "");
  EXPECT_EQ(nonDefaultParameters(*resolveParameters({}, setOptions({{"ilv.n_min", "5"}, {"seed", "2"}}))),
            "seed=2 ilv.n_min=5");
}

class Reproducing : public testing::TestWithParam<std::pair<Pairs, Pairs>> {};

TEST_P(Reproducing, SettingsGiveTheSameParameters) {
  const auto scene = sceneSettings(GetParam().first);
  const Parameters wanted = *resolveParameters(scene, setOptions(GetParam().second));
  const auto again = resolveParameters(scene, setOptions(reproducingSettings(scene, wanted)));
  ASSERT_TRUE(again) << again.error().message();
  EXPECT_EQ(parametersAsText(*again), parametersAsText(wanted));
  // What [render] says may be taken out of the scene without changing its hash.
  std::map<std::string, std::string> withoutScene =
      parametersAsText(*resolveParameters({}, setOptions(reproducingSettings(scene, wanted))));
  EXPECT_EQ(withoutScene, parametersAsText(wanted));
}

INSTANTIATE_TEST_SUITE_P(
    Settings, Reproducing,
    testing::Values(std::pair<Pairs, Pairs>{{}, {}},
                    std::pair<Pairs, Pairs>{{{"dlv.mode", "always"}}, {{"preset", "draft"}}},
                    std::pair<Pairs, Pairs>{{{"ilv.n_min", "7"}}, {{"ilv.n_min", "4"}}},
                    std::pair<Pairs, Pairs>{{{"method.rules", "paper"}},
                                            {{"method.rules", "refined"}, {"ilv.n_min", "3"}}},
                    std::pair<Pairs, Pairs>{{{"method.rules", "paper"}, {"preset", "draft"}},
                                            {{"dlv.r_max", "0.5m"}, {"seed", "18446744073709551615"}}},
                    std::pair<Pairs, Pairs>{{{"preset", "fine"}},
                                            {{"method.rules", "printed"}, {"preset", "balanced"}}}));

TEST(Settings, RulesAreReproducedInOneWord) {
  const Parameters paper = *resolveParameters({}, setOptions({{"method.rules", "paper"}}));
  EXPECT_THAT(reproducingSettings({}, paper), testing::ElementsAre(testing::Pair("method.rules", "paper")));
}

}  // namespace
}  // namespace lightvane
