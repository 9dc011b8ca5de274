#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "fake_stages.hpp"
#include "stillpoint/runtime/option_describer.hpp"
#include "stillpoint/runtime/yaml_loader.hpp"
#include "stillpoint/runtime/yaml_option_reader.hpp"
#include "stillpoint/support/did_you_mean.hpp"

namespace stillpoint {
namespace {

using testing::ElementsAre;

/// The section `s` with the value that is written in `yaml`.
ConfigNode section(const std::string& yaml) {
  FaultList faults;
  const ConfigNode tree = parse_assignment("s=" + yaml, faults);
  faults.throw_if_any();
  return *tree.find("s");
}

FakeDecision::Options read_decision(const std::string& yaml) {
  const ConfigNode node = section(yaml);
  YamlOptionReader reader(&node, "s");
  FakeDecision::Options options;
  options.visit(reader);
  reader.finish();
  reader.faults().throw_if_any();
  return options;
}

TEST(YamlOptionReader, KeepsDefaultsThatAreNotGiven) {
  const auto options = read_decision("{}");
  EXPECT_THAT(options.labels, ElementsAre("person"));
  EXPECT_EQ(options.classes.at("person").prior, 0.9);
  ASSERT_EQ(options.regions.size(), 1u);
  EXPECT_EQ(options.regions[0].box[2], 0.5);
}

TEST(YamlOptionReader, ReadsEveryForm) {
  const auto options = read_decision(
      "{labels: [dog, 'a b'], other: {prior: 1e-3, keep: false}, rule: most, "
      "classes: {car: {prior: 0.2}, person: {keep: false}}, regions: [{name: r}, {name: q}]}");
  EXPECT_THAT(options.labels, ElementsAre("dog", "a b"));
  EXPECT_EQ(options.other.prior, 1e-3);
  EXPECT_FALSE(options.other.keep);
  EXPECT_EQ(options.rule, FakeDecision::Options::Rule::kMost);
  EXPECT_EQ(options.classes.at("car").prior, 0.2);
  EXPECT_EQ(options.classes.at("person").prior, 0.9) << "keys given in YAML join the defaults";
  EXPECT_FALSE(options.classes.at("person").keep);
}

TEST(YamlOptionReader, GivenListsReplaceTheDefaultList) {
  const auto options = read_decision("{regions: [{name: r}]}");
  ASSERT_EQ(options.regions.size(), 1u);
  EXPECT_THAT(options.regions[0].box, ElementsAre(0, 0, 1, 1));
  EXPECT_TRUE(read_decision("{regions: []}").regions.empty());
}

TEST(YamlOptionReader, CollectsInsteadOfThrowing) {
  const ConfigNode node = section("{epsilon: [], max_corners: 1, other: 2}");
  YamlOptionReader reader(&node, "s");
  FakeChecker::Options options;
  EXPECT_NO_THROW(options.visit(reader));
  EXPECT_NO_THROW(reader.finish());
  EXPECT_EQ(options.max_corners, 1000) << "a faulty value is not stored";
  EXPECT_THROW(reader.faults().throw_if_any(), Error);
}

TEST(OptionRecord, PrintedYamlReadsBackAsItself) {
  const auto print = [](const std::string& yaml) {
    const ConfigNode node = section(yaml);
    YamlOptionReader reader(&node, "s");
    FakeDecision::Options options;
    options.visit(reader);
    reader.finish();
    reader.faults().throw_if_any();
    return print_yaml(reader.record());
  };
  const std::string first = print(
      "{labels: [\"no\", '1', \"tab\\tand \\\"quote\\\" \\\\ ü\", ''], other: {prior: "
      "0.30000000000000004}, regions: [{name: '# no comment', box: []}], classes: {'a: b': {}}}");
  EXPECT_EQ(print(first), first);
  EXPECT_EQ(print("{regions: [], labels: []}"), print(print("{regions: [], labels: []}")));
}

TEST(OptionDescriber, ListsFieldsOfGroupsListsAndMaps) {
  OptionDescriber describer;
  FakeDecision::Options().visit(describer);
  std::vector<std::string> names;
  for (const OptionRow& row : describer.rows()) names.push_back(row.name);
  EXPECT_THAT(names, ElementsAre("labels", "classes", "classes.person.prior", "classes.person.keep",
                                 "regions", "regions[].name", "regions[].box", "other",
                                 "other.prior", "other.keep", "rule"));
  EXPECT_EQ(describer.rows()[2].default_value, "0.9");
  EXPECT_EQ(describer.rows()[2].range, "[0, 1]");
  EXPECT_EQ(describer.rows()[5].default_value, "required");
  EXPECT_EQ(describer.rows()[10].type, "any | most");
}

TEST(ConfigFiles, AFileIsReadOnceUnlessItHasFaults) {
  const std::filesystem::path folder = ::testing::TempDir();
  const auto write = [&](const char* name, const char* text) {
    std::ofstream(folder / name) << text;
    return folder / name;
  };
  const std::filesystem::path good = write("config_files_good.yaml", "a: 1\n");
  const std::filesystem::path bad = write("config_files_bad.yaml", "a: 1\na: 2\n");
  ConfigFiles files;
  const auto value = [&] {
    FaultList none;
    return files.load(good, {}, none)->find("a")->scalar;
  };
  EXPECT_EQ(value(), "1");
  write("config_files_good.yaml", "a: 2\n");
  EXPECT_EQ(value(), "1");
  for (int i = 0; i < 2; ++i) {
    FaultList faults;
    files.load(bad, {}, faults);
    EXPECT_FALSE(faults.empty()) << "each pipeline that uses it says what is wrong";
  }
}

TEST(DidYouMean, SuggestsNearNamesOnly) {
  const std::vector<std::string> names = {"epsilon", "max_corners", "pace"};
  EXPECT_EQ(did_you_mean("epsilom", names), "; did you mean 'epsilon'?");
  EXPECT_EQ(did_you_mean("pcae", names), "; did you mean 'pace'?");
  EXPECT_EQ(did_you_mean("window", names), "");
  EXPECT_EQ(did_you_mean("", names), "");
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
  EXPECT_EQ(edit_distance("", "abc"), 3u);
}

}  // namespace
}  // namespace stillpoint
