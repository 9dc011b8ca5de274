#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <memory>

#include "stillpoint/engine/registry.hpp"
#include "stillpoint/error.hpp"
#include "stillpoint/runtime/yaml_option_reader.hpp"
#include "stillpoint/sdk.hpp"

namespace stillpoint {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

const fs::path kBuilt = STILLPOINT_BAD_PLUGINS;

/// A folder of plugins that is removed again.
class RegistryTest : public testing::Test {
 protected:
  RegistryTest() {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(testing::TempDir()) / (std::string("stillpoint_plugins_") + info->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~RegistryTest() override { fs::remove_all(folder_); }

  void use(const std::string& name) const {
    const std::string file = "libstillpoint_" + name + ".so";
    fs::copy_file(kBuilt / file, folder_ / file);
  }
  void write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / ("libstillpoint_" + name + ".so"), std::ios::binary) << bytes;
  }
  static std::string bytes_of(const std::string& name) {
    std::ifstream stream(kBuilt / ("libstillpoint_" + name + ".so"), std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  /// The only reason there is, after a search in which the good plugin must have been found.
  std::string reason() const {
    use("good");
    Registry registry;
    registry.search(folder_);
    EXPECT_NE(registry.find("moving_checker", "good"), nullptr);
    EXPECT_EQ(registry.unusable().size(), 1u);
    return registry.unusable().empty() ? "" : registry.unusable().front().reason;
  }

  fs::path folder_;
};

std::shared_ptr<MovingChecker> make(const Registry& registry, const std::string& type) {
  YamlOptionReader defaults(nullptr, "moving_checker");
  return create<MovingChecker>(*registry.find("moving_checker", type), defaults, {});
}

TEST_F(RegistryTest, GoodPluginOutlivesTheRegistry) {
  use("good");
  std::shared_ptr<MovingChecker> checker;
  {
    Registry registry;
    registry.search(folder_);
    const PluginType* type = registry.find("moving_checker", "good");
    ASSERT_NE(type, nullptr);
    EXPECT_EQ(type->version, "1.2.3");
    EXPECT_EQ(type->library.filename(), "libstillpoint_good.so");
    EXPECT_TRUE(registry.unusable().empty());
    checker = make(registry, "good");
  }
  EXPECT_TRUE(checker->check({}, {}, {}).reliable);
}

TEST_F(RegistryTest, NoSymbol) {
  use("no_symbol");
  EXPECT_THAT(reason(), HasSubstr("does not export 'stillpoint_plugin'"));
}
TEST_F(RegistryTest, OlderApi) {
  use("older_api");
  EXPECT_THAT(reason(), HasSubstr("built for plugin API " + std::to_string(kPluginApi - 1) +
                                  ", this program has API " + std::to_string(kPluginApi) +
                                  "; rebuild it against Stillpoint "));
}
TEST_F(RegistryTest, NothingOfALibraryThatDoesNotFitIsRun) {
  use("older_api");
  Registry registry;
  registry.search(folder_);
  EXPECT_EQ(registry.unusable().size(), 1u);
  EXPECT_EQ(std::getenv("STILLPOINT_OLDER_API_RAN"), nullptr);
}
TEST_F(RegistryTest, LibraryFromBeforeThereWereStamps) {
  use("no_stamp");
  EXPECT_THAT(reason(), HasSubstr("built for a plugin API before 10, this program has API "));
}
TEST_F(RegistryTest, StampThatIsDamaged) {
  std::string bytes = bytes_of("good");
  bytes.replace(bytes.find("stillpoint plugin\n"), 10, "stillwater");
  write("damaged", bytes);
  EXPECT_EQ(reason(), "its stamp is damaged");
}
TEST_F(RegistryTest, StampWhoseNumberIsNone) {
  std::string bytes = bytes_of("good");
  const std::string line = "moving_checker " + std::to_string(MovingChecker::kApi) + "\n";
  bytes.replace(bytes.find(line) + line.size() - 2, 1, "x");
  write("damaged", bytes);
  EXPECT_EQ(reason(), "its stamp is damaged");
}
TEST_F(RegistryTest, OlderContract) {
  use("older_kind");
  EXPECT_EQ(reason().find("built for API " + std::to_string(Output::kApi - 1) +
                          " of kind 'output', this program has API " +
                          std::to_string(Output::kApi) + "; rebuild it against Stillpoint "),
            0u);
}
TEST_F(RegistryTest, OlderContractLeavesTheOtherKindsUsable) {
  use("older_and_newer_kinds");
  EXPECT_THAT(reason(), HasSubstr("output 'viewer': built for API "));
  Registry registry;
  registry.search(folder_);
  EXPECT_EQ(registry.find("output", "viewer"), nullptr);
  EXPECT_TRUE(make(registry, "current")->check({}, {}, {}).reliable);
}
TEST_F(RegistryTest, NewerApi) {
  use("newer_api");
  EXPECT_THAT(reason(), HasSubstr("built for plugin API " + std::to_string(kPluginApi + 1)));
}
TEST_F(RegistryTest, WrongTag) {
  use("wrong_tag");
  EXPECT_THAT(reason(), HasSubstr("built with gcc7-eigen3.3-align32, this program with libstdc++"));
}
TEST_F(RegistryTest, OtherLayout) {
  use("other_layout");
  EXPECT_THAT(reason(), AllOf(HasSubstr("-cxx11abi1-glibcxxdebug-eigen"),
                              ::testing::ContainsRegex("-align[0-9]+\\.0-"),
                              HasSubstr(", this program with libstdc++")));
}
TEST_F(RegistryTest, UndefinedSymbol) {
  use("undefined_symbol");
  const std::string text = reason();
  EXPECT_THAT(text, HasSubstr("cannot be loaded: undefined symbol: "));
  EXPECT_THAT(text, HasSubstr("function_that_is_nowhere"));
  EXPECT_THAT(text, testing::Not(HasSubstr("Bad file descriptor")));
}
TEST_F(RegistryTest, UnknownKind) {
  use("unknown_kind");
  EXPECT_EQ(reason(), "radar 'pulse': there is no kind 'radar'");
}
TEST_F(RegistryTest, IncompleteEntry) {
  use("incomplete_entry");
  EXPECT_EQ(reason(), "its descriptor has an incomplete entry");
}
TEST_F(RegistryTest, NotALibrary) {
  write("text", "this is a letter, not a library\n");
  EXPECT_EQ(reason(), "not a shared library");
}
TEST_F(RegistryTest, EmptyFile) {
  write("empty", "");
  EXPECT_EQ(reason(), "not a shared library");
}
TEST_F(RegistryTest, Folder) {
  fs::create_directories(folder_ / "libstillpoint_folder.so");
  EXPECT_EQ(reason(), "cannot be read");
}

TEST_F(RegistryTest, Pipe) {
  ASSERT_EQ(::mkfifo((folder_ / "libstillpoint_pipe.so").c_str(), 0600), 0);
  EXPECT_EQ(reason(), "cannot be read");
}

TEST_F(RegistryTest, DuplicateTypeGoesToTheFirst) {
  use("second_good");
  const fs::path first = folder_ / "libstillpoint_good.so";
  EXPECT_EQ(reason(), "moving_checker 'good' is already provided by " + first.string());
  Registry registry;
  registry.search(folder_);
  EXPECT_EQ(registry.find("moving_checker", "good")->library, first);
  ASSERT_NE(registry.find("moving_checker", "unique"), nullptr) << "the rest can be used";
  EXPECT_EQ(registry.find("moving_checker", "unique")->library,
            folder_ / "libstillpoint_second_good.so");
}

TEST_F(RegistryTest, TypesWithWrongOptionsAreRefusedOneByOne) {
  use("bad_options");
  Registry registry;
  registry.search(folder_);
  std::vector<std::string> reasons;
  for (const UnusableLibrary& library : registry.unusable()) reasons.push_back(library.reason);
  EXPECT_EQ(
      reasons,
      (std::vector<std::string>{
          "the options of moving_checker 'outside': the default of 'share', 2, is outside its "
          "range, [0, 1]",
          "the options of moving_checker 'twice': two options are named 'points'",
          "the options of moving_checker 'type': an option must not be named 'type'",
          "the options of moving_checker 'list': the default of 'shares' has a number outside its "
          "range, [0, 1]",
          "the options of moving_checker 'reserved': an option must not be named 'when_full'"}));
  EXPECT_NE(registry.find("moving_checker", "right"), nullptr);
}

TEST_F(RegistryTest, TruncatedAnywhere) {
  const std::string bytes = bytes_of("good");
  for (std::size_t part = 0; part < 64; ++part) {
    write("truncated", bytes.substr(0, bytes.size() * part / 64));
    Registry registry;
    registry.search(folder_);
    EXPECT_EQ(registry.unusable().size(), 1u) << part << "/64 of the file";
  }
  write("truncated", bytes.substr(0, bytes.size() / 2));
  EXPECT_EQ(reason(), "truncated or damaged");
}

TEST_F(RegistryTest, ConstructorFailureNamesTheType) {
  use("throws_in_constructor");
  Registry registry;
  registry.search(folder_);
  try {
    make(registry, "throws_in_constructor");
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "moving_checker (throws_in_constructor): no such model file");
    EXPECT_EQ(error.fault(), Fault::kStage);
  }
  EXPECT_THROW(make(registry, "throws_number"), Error);
}

TEST_F(RegistryTest, ExceptionsOutliveObjectAndRegistry) {
  use("throws_later");
  try {
    Registry registry;
    registry.search(folder_);
    make(registry, "throws_later")->check({}, {}, {});
    FAIL();
  } catch (const std::exception& error) {
    EXPECT_STREQ(error.what(), "text inside the plugin");
  }
}

TEST_F(RegistryTest, MissingTypeIsExplained) {
  use("good");
  use("older_api");
  Registry registry;
  registry.search(folder_);
  registry.search(folder_);  // a second time changes nothing
  EXPECT_EQ(registry.explain_missing("moving_checker", "god"),
            "no moving_checker named 'god'; did you mean 'good'?\n"
            "  available:  good\n"
            "  not usable: libstillpoint_older_api.so: " +
                registry.unusable().front().reason + "\n  searched:   " + folder_.string() +
                "      (add folders by 'plugins: {paths: [DIR]}' or STILLPOINT_PLUGIN_PATH)");
}

TEST_F(RegistryTest, MissingFolderHasNoPlugins) {
  Registry registry;
  registry.search(folder_ / "nowhere");
  EXPECT_TRUE(registry.types().empty() && registry.unusable().empty());
  EXPECT_EQ(registry.searched().size(), 1u);
  EXPECT_EQ(registry.missing_folders(), registry.searched());
  EXPECT_NE(registry.explain_missing("tracker", "orb").find("nowhere (not there)"),
            std::string::npos);
}

}  // namespace
}  // namespace stillpoint
