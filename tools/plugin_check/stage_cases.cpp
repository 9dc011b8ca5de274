#include "plugin_check/stage_cases.hpp"

#include <algorithm>
#include <array>
#include <boost/crc.hpp>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <string_view>
#include <type_traits>

#include "plugin_check/drive.hpp"
#include "plugin_check/quiet_run.hpp"
#include "stillpoint/runtime/option_describer.hpp"
#include "stillpoint/runtime/yaml_loader.hpp"
#include "stillpoint/runtime/yaml_option_reader.hpp"
#include "stillpoint/support/contract_list.hpp"

namespace stillpoint::plugin_check {
namespace {

namespace fs = std::filesystem;

constexpr const char* kOptions = "options";
constexpr const char* kSameSeed = "one seed, two runs";
constexpr const char* kTwoAtOnce = "two stages at once";
constexpr const char* kDestroyed = "destroyed at any time";
constexpr const char* kEndedEarly = "ended before the first frame";
constexpr std::size_t kFramesOfBeginning = 8;

ConfigNode options_of(const CheckedType& checked) {
  FaultList faults;
  ConfigNode options;
  for (const std::string& assignment : checked.assignments)
    options = merge_sections(std::move(options), parse_assignment(assignment, faults));
  if (options.kind == ConfigNode::Kind::kMap) {
    YamlOptionReader reader(&options, checked.type.kind);
    describe_options(checked.type, reader);
    reader.finish();
    faults.add(reader.faults());
  }
  faults.throw_if_any();
  return options;
}

bool reads_files(const PluginType& type) {
  OptionDescriber describer;
  describe_options(type, describer);
  return std::ranges::any_of(describer.rows(), &OptionRow::is_path);
}

/// By path in the folder.
using FileSums = std::map<std::string, std::uint32_t>;

FileSums sums_of_files(const fs::path& folder) {
  FileSums sums;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    std::ifstream stream(entry.path(), std::ios::binary);
    const std::string bytes(std::istreambuf_iterator<char>(stream), {});
    boost::crc_32_type sum;
    sum.process_bytes(bytes.data(), bytes.size());
    sums[entry.path().lexically_relative(folder).string()] = sum.checksum();
  }
  return sums;
}

class StageCase {
 public:
  StageCase(const CheckedType& checked, const fs::path& folder)
      : checked_(checked),
        options_(options_of(checked)),
        folder_(folder),
        name_(checked.type.kind + " (" + checked.type.type + ")") {}

  template <class Interface>
  std::shared_ptr<Interface> make(const fs::path& folder) const {
    StageContext context = testing::test_context();
    context.output_directory = folder;
    context.camera = checked_.camera;
    YamlOptionReader reader(options_.kind == ConfigNode::Kind::kMap ? &options_ : nullptr,
                            checked_.type.kind);
    return create<Interface>(checked_.type, reader, context);
  }
  fs::path empty_folder(const std::string& name) const {
    fs::remove_all(folder_ / name);
    fs::create_directory(folder_ / name);
    return folder_ / name;
  }

  /// One stage through a scenario. Gives the digest of its results.
  template <class Interface>
  std::uint32_t run(const Scenario& scenario, CaseResult* result = nullptr) const {
    Observer observer(name_);
    const fs::path folder = empty_folder("one");
    auto stage = make<Interface>(folder);
    auto drive = make_drive<Interface>(*stage, {scenario, folder, observer});
    while (drive->step()) {
    }
    drive->finish();
    observer.require_unchanged();
    if (result) describe(*drive, observer, *result);
    drive.reset();
    destroy(stage, observer);
    return observer.digest();
  }

  template <class Interface>
  void run_twice(const Scenario& scenario, CaseResult& result) const {
    if (run<Interface>(scenario) == run<Interface>(scenario)) return;
    if (may_be_a_camera<Interface>()) return leave_open(result);
    throw Failure({"two runs with one seed gave different results",
                   "mode `inline` promises the same trajectory, byte for byte; studies and bug "
                   "reports rely on it",
                   "seed random numbers with StageContext::seed; do not decide by the clock, by "
                   "addresses, by the order of unordered containers, or by uninitialised memory"});
  }

  template <class Interface>
  void run_two_at_once(const Scenario& scenario, CaseResult& result) const {
    const std::uint32_t alone = run<Interface>(scenario);
    std::array<std::unique_ptr<Observer>, 2> observers;
    std::array<std::shared_ptr<Interface>, 2> stages;
    std::array<std::unique_ptr<Drive>, 2> drives;
    const std::array folders = {empty_folder("first"), empty_folder("second")};
    for (std::size_t i = 0; i < 2; ++i) {
      observers[i] = std::make_unique<Observer>(name_);
      stages[i] = make<Interface>(folders[i]);
      drives[i] = make_drive<Interface>(*stages[i], {scenario, folders[i], *observers[i]});
    }
    for (bool first = true, second = true; first || second;) {
      first = first && drives[0]->step();
      second = second && drives[1]->step();
    }
    for (const auto& drive : drives) drive->finish();
    if (std::ranges::all_of(observers,
                            [&](const auto& observer) { return observer->digest() == alone; }))
      return;
    drives = {};
    stages = {};
    if (may_be_a_camera<Interface>()) return leave_open(result);
    throw Failure({"two stages, called in turn, gave other results than one alone",
                   "programs may have several pipelines, and outputs of one type several "
                   "instances",
                   "keep all state in members: no static or global variables that change"});
  }

  /// An output in the folder of an earlier run, whose results must stay.
  void end_before_first_frame(const Scenario& scenario) const {
    run<Output>(scenario);
    const fs::path folder = folder_ / "one";
    const FileSums before = sums_of_files(folder);
    Observer observer(name_);
    auto stage = make<Output>(folder);
    observer.call("begin", {}, [&] { stage->begin(std::make_shared<QuietRun>(true)); });
    const SparseMap no_map;
    const std::vector<TrackedPose> no_poses;
    const SourceReport no_report;
    const std::vector<StageTime> no_times;
    const RunSummary summary{.map = no_map,
                             .poses = no_poses,
                             .source = no_report,
                             .times = no_times,
                             .mode = "inline",
                             .complete = false,
                             .failure = "source (tum_rgbd): rgb.txt: there is no such file"};
    observer.call("ended_before_first_frame", {},
                  [&] { stage->ended_before_first_frame(summary); });
    destroy(stage, observer);
    const FileSums after = sums_of_files(folder);
    for (const auto& [file, sum] : before)
      if (!after.contains(file) || after.at(file) != sum)
        throw Failure({"a run without a frame replaced " + file + " of an earlier run",
                       "a wrong path of a recording would cost the results of hours",
                       "write files with AtomicFile, and commit() them in finish(), which is not "
                       "called then"});
  }

  template <class Interface>
  void destroy_at_any_time(const Scenario& scenario) const {
    for (const int steps : {0, 1, 2, 1000}) {
      Observer observer(name_);
      const fs::path folder = empty_folder("one");
      auto stage = make<Interface>(folder);
      auto drive = make_drive<Interface>(*stage, {scenario, folder, observer});
      for (int i = 0; i < steps && drive->step(); ++i) {
      }
      drive.reset();
      destroy(stage, observer);
    }
  }

 private:
  /// A source that does not know how many frames it has. Cameras never give the same again.
  template <class Interface>
  bool may_be_a_camera() const {
    if constexpr (std::is_same_v<Interface, Source>)
      return !make<Source>(empty_folder("one"))->size();
    return false;
  }
  static void leave_open(CaseResult& result) {
    result.outcome = CaseResult::Outcome::kNotRun;
    result.finding = {
        "its frames were others than before: right for a camera, which a source "
        "without size() is taken for",
        "two runs on one recording must give the same results",
        "give size() where the number of frames is known"};
  }

  static void describe(const Drive& drive, const Observer& observer, CaseResult& result) {
    result.remark = drive.remark();
    result.times = observer.times();
    const std::optional<Finding> unchecked = drive.unchecked();
    if (!unchecked) return;
    result.outcome = CaseResult::Outcome::kNotRun;
    result.finding = *unchecked;
  }
  template <class Interface>
  static void destroy(std::shared_ptr<Interface>& stage, Observer& observer) {
    observer.check("its destructor", {}, [&] { stage.reset(); });
  }

  const CheckedType& checked_;
  const ConfigNode options_;
  const fs::path folder_;
  const std::string name_;
};

std::string yaml_of(const CheckedType& checked, const ConfigNode* options) {
  YamlOptionReader reader(options, checked.type.kind);
  describe_options(checked.type, reader);
  reader.finish();
  reader.faults().throw_if_any();
  return print_yaml(reader.record());
}

/// Writes options to a file, reads it and writes what was read.
std::string written_and_read(const CheckedType& checked, const std::string& text,
                             const fs::path& file) {
  std::ofstream(file) << (text.empty() ? "{}\n" : text);
  FaultList faults;
  const ConfigNode node = load_config_file(file, "pipelines", faults);
  faults.throw_if_any();
  return yaml_of(checked, &node);
}

/// `check --print` writes all options; a run from that file must be the same run.
std::string check_options(const CheckedType& checked, const fs::path& folder) {
  const ConfigNode given = options_of(checked);
  const std::string defaults =
      yaml_of(checked, given.kind == ConfigNode::Kind::kMap ? &given : nullptr);
  // Relative paths become absolute when they are first read.
  const std::string text = written_and_read(checked, defaults, folder / "options.yaml");
  if (written_and_read(checked, text, folder / "options.yaml") != text)
    throw Failure({"the options that `stillpoint check --print` writes read back as others",
                   "a run could not be repeated from its pipeline.yaml",
                   "visit() must name the same options in every call, and not change values"});
  const auto lines = std::ranges::count(text, '\n');
  return std::to_string(lines) + (lines == 1 ? " line" : " lines");
}

const Scenario& scenario_named(const std::string& name, const std::vector<Scenario>& scenarios) {
  const auto found = std::ranges::find(scenarios, name, &Scenario::name);
  return found == scenarios.end() ? scenarios.front() : *found;
}

template <class Interface>
void run_stage_case(const CheckedType& checked, const std::vector<Scenario>& scenarios,
                    const fs::path& folder, CaseResult& result) {
  const StageCase one(checked, folder);
  const Scenario& scenario = scenario_named(result.name, scenarios);
  Scenario beginning = scenarios.front();  // several stages go through it: networks are slow
  beginning.inputs.resize(kFramesOfBeginning);
  // In a recording without loops, a loop closer gives nothing that could be compared.
  const auto trip = std::ranges::find(scenarios, true, &Scenario::is_round_trip);
  const Scenario& compared =
      Interface::kKind == std::string_view(LoopCloser::kKind) ? *trip : beginning;
  if (result.name == kSameSeed) return one.run_twice<Interface>(compared, result);
  if (result.name == kTwoAtOnce) return one.run_two_at_once<Interface>(compared, result);
  if (result.name == kDestroyed) return one.destroy_at_any_time<Interface>(beginning);
  if (result.name == kEndedEarly) return one.end_before_first_frame(beginning);
  one.run<Interface>(scenario, scenario.is_usual || scenario.is_round_trip ? &result : nullptr);
}

}  // namespace

std::vector<std::string> cases_of(const std::string& kind, const std::vector<Scenario>& scenarios) {
  std::vector<std::string> names = {scenarios.front().name, kOptions, kSameSeed, kTwoAtOnce,
                                    kDestroyed};
  if (kind == Source::kKind) return names;
  if (kind == Output::kKind) names.push_back(kEndedEarly);
  for (const Scenario& scenario : scenarios) {
    const bool is_for_kind = (scenario.of_images || kind != Segmenter::kKind) &&
                             (scenario.kind.empty() || scenario.kind == kind);
    if (&scenario != &scenarios.front() && is_for_kind) names.push_back(scenario.name);
  }
  return names;
}

CaseResult run_case(const CheckedType& checked, const std::string& name,
                    const std::vector<Scenario>& scenarios, const fs::path& folder) {
  CaseResult result{.name = name};
  try {
    if (name == kOptions)
      result.remark = check_options(checked, folder);
    else
      Contracts::for_each([&]<class Interface>() {
        if (checked.type.kind == Interface::kKind)
          run_stage_case<Interface>(checked, scenarios, folder, result);
      });
  } catch (const Failure& failure) {
    result.outcome = CaseResult::Outcome::kFailed;
    result.finding = failure.finding;
  } catch (const Error& error) {
    // A stage that wants a file first is not wrong, and files may not fit the frames of a case. A
    // source may have no images, as without a camera.
    const bool in_a_call = dynamic_cast<const StageError*>(&error);
    const bool wants_options =
        error.fault() != Fault::kStage &&
        (!in_a_call || checked.type.kind == Source::kKind || reads_files(checked.type));
    result.outcome = wants_options ? CaseResult::Outcome::kNotRun : CaseResult::Outcome::kFailed;
    const Scenario& scenario = scenario_named(name, scenarios);
    result.finding = {error.what(), scenario.why, scenario.remedy};
    if (name == kEndedEarly) {
      result.finding.why = "viewers would not learn why the run ended";
      result.finding.remedy =
          "expect ended_before_first_frame() in place of finish(), without any "
          "frame or pose";
    }
    if (name == kDestroyed) {
      result.finding.why = "Ctrl-C or the failure of another stage end a run at any time";
      result.finding.remedy = "expect the destructor after any number of calls, also after none";
    }
  }
  return result;
}

}  // namespace stillpoint::plugin_check
