// stillpoint plugins check: the cases of a library's stages, as a table and as findings.
#include <algorithm>
#include <csignal>
#include <iomanip>
#include <iostream>
#include <memory>

#include "commands.hpp"
#include "plugin_check/case_json.hpp"
#include "plugin_check/check_library.hpp"
#include "plugin_check/isolated.hpp"

namespace stillpoint {
namespace {

using plugin_check::CallTime;
using plugin_check::CaseResult;
using plugin_check::LibraryResult;
using plugin_check::TypeResult;

constexpr int kNameWidth = 40;

struct CheckOptions {
  plugin_check::CheckRequest request;
  std::string camera;
  bool json = false;
};

/// Every line of `text` after the first indented by so much.
std::string indented(const std::string& text, std::size_t columns) {
  std::string result;
  for (const char c : text) {
    result += c;
    if (c == '\n') result.append(columns, ' ');
  }
  while (!result.empty() && (result.back() == ' ' || result.back() == '\n')) result.pop_back();
  return result;
}

void print_times(const std::vector<CallTime>& times) {
  for (const CallTime& time : times)
    std::cout << "          " << std::left << std::setw(kNameWidth - 2) << time.function + "()"
              << std::fixed << std::setprecision(2) << "median " << time.median_ms
              << " ms, slowest " << time.slowest_ms << " ms\n";
}

void print_case(const CaseResult& result) {
  const auto outcome = result.outcome;
  std::cout << (outcome == CaseResult::Outcome::kPassed   ? "  ok    "
                : outcome == CaseResult::Outcome::kFailed ? "  FAIL  "
                                                          : "  -     ");
  if (result.remark.empty())
    std::cout << result.name << '\n';
  else
    std::cout << std::left << std::setw(kNameWidth) << result.name << result.remark << '\n';
  if (outcome == CaseResult::Outcome::kFailed)
    std::cout << "        what:   " << indented(result.finding.what, 16)
              << "\n        why:    " << indented(result.finding.why, 16)
              << "\n        to do:  " << indented(result.finding.remedy, 16) << '\n';
  if (outcome == CaseResult::Outcome::kNotRun)
    std::cout << "        not checked: " << indented(result.finding.what, 8)
              << "\n        give what it needs with --set OPTION=VALUE, a camera with --camera\n";
  print_times(result.times);
  std::cout << std::flush;
}

struct Counts {
  int passed = 0, failed = 0, not_run = 0;
};

Counts count(const LibraryResult& library) {
  Counts counts{.failed = static_cast<int>(library.unusable.size())};
  for (const TypeResult& type : library.types)
    for (const CaseResult& result : type.cases)
      ++(result.outcome == CaseResult::Outcome::kPassed   ? counts.passed
         : result.outcome == CaseResult::Outcome::kFailed ? counts.failed
                                                          : counts.not_run);
  return counts;
}

void print_json(const LibraryResult& library) {
  nlohmann::ordered_json types = nlohmann::json::array();
  for (const TypeResult& type : library.types)
    types.push_back(nlohmann::ordered_json{
        {"kind", type.kind}, {"type", type.type}, {"cases", nlohmann::json(type.cases)}});
  std::cout << nlohmann::ordered_json{{"plugin", library.plugin},
                                      {"version", library.version},
                                      {"unusable", library.unusable},
                                      {"types", types}}
                   .dump(2)
            << '\n';
}

void print_unusable(const LibraryResult& library) {
  for (const std::string& reason : library.unusable)
    std::cout << "  FAIL  cannot be used: " << indented(reason, 8) << '\n';
}

/// "decision/mine, source/other": of which not one case could be run.
std::string names_of_unchecked(const LibraryResult& library) {
  std::string names;
  for (const TypeResult& type : library.types)
    if (std::ranges::all_of(type.cases, [](const CaseResult& result) {
          return result.outcome == CaseResult::Outcome::kNotRun;
        }))
      names += (names.empty() ? "" : ", ") + type.kind + "/" + type.type;
  return names;
}

/// Exit code 1 when a case failed, 2 when a type could not be checked.
void judge(const LibraryResult& library) {
  const Counts counts = count(library);
  if (counts.failed > 0)
    throw Error(Fault::kStage, std::to_string(counts.failed) + " of " +
                                   std::to_string(counts.passed + counts.failed) + " cases failed");
  const std::string unchecked = names_of_unchecked(library);
  if (counts.passed == 0) throw Error(Fault::kUsage, "nothing could be checked");
  if (!unchecked.empty())
    throw Error(Fault::kUsage, "could not be checked", unchecked,
                "check it alone, KIND/TYPE behind the library, with what it needs");
}

void check(CheckOptions options) {
  if (!options.camera.empty()) options.request.camera = load_camera(options.camera);
  const TypeResult* current = nullptr;
  const LibraryResult library =
      plugin_check::check_library(options.request, [&](const auto& type, const auto& result) {
        if (options.json) return;
        if (&type != current) std::cout << type.kind << ' ' << type.type << '\n';
        current = &type;
        print_case(result);
      });
  if (options.json)
    print_json(library);
  else
    print_unusable(library);
  judge(library);
  if (!options.json) std::cout << "all " << count(library).passed << " cases passed\n";
}

}  // namespace

void add_plugins_check(CLI::App& plugins) {
  CLI::App* command = plugins.add_subcommand(
      "check", "Check that the stages of a library keep their contracts, also in adverse cases");
  auto options = std::make_shared<CheckOptions>();
  command->add_option("library", options->request.library, "build/libstillpoint_NAME.so")
      ->type_name("FILE")
      ->required();
  command
      ->add_option("type", options->request.type,
                   "Type to check, TYPE or KIND/TYPE; default: all of the library")
      ->type_name("TYPE");
  command
      ->add_option("--case", options->request.only,
                   "Run one case only, as in --case 'black images'")
      ->type_name("NAME");
  command
      ->add_option("--set", options->request.assignments,
                   "Set an option of the types that are checked; may be repeated")
      ->type_name("OPTION=VALUE")
      ->allow_extra_args(false);
  command
      ->add_option(
          "--camera", options->camera,
          "Camera file, or the name of one in configs/cameras, for a source that needs one")
      ->type_name("CAMERA");
  command->add_option("--timeout", options->request.seconds, "Seconds that a case may take")
      ->type_name("S")
      ->check(CLI::Range(0.1, 3600.0))
      ->capture_default_str();
  command->add_flag("--json", options->json, "Print JSON");
  command->callback([options] {
    try {
      check(*options);
    } catch (const plugin_check::Interrupted& interrupted) {
      std::raise(interrupted.signal);  // so that a calling script sees that it was interrupted
    }
  });
}

}  // namespace stillpoint
