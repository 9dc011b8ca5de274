#include "plugin_check/check_library.hpp"

#include <algorithm>
#include <opencv2/core/utility.hpp>
#include <system_error>

#include "plugin_check/case_json.hpp"
#include "plugin_check/isolated.hpp"
#include "plugin_check/stage_cases.hpp"
#include "stillpoint/error.hpp"
#include "stillpoint/support/did_you_mean.hpp"
#include "stillpoint/support/temporary_folder.hpp"

namespace stillpoint::plugin_check {
namespace {

namespace fs = std::filesystem;

/// What the library provides, without loading it into this process.
nlohmann::json contents_of(const CheckRequest& request) {
  const IsolatedEnd end = run_isolated(
      [&] {
        Registry registry;
        registry.load(request.library);
        nlohmann::json contents = {{"types", nlohmann::json::array()},
                                   {"unusable", nlohmann::json::array()}};
        for (const PluginType& type : registry.types()) {
          contents["plugin"] = type.plugin;
          contents["version"] = type.version;
          contents["types"].push_back({{"kind", type.kind}, {"type", type.type}});
        }
        for (const UnusableLibrary& library : registry.unusable())
          contents["unusable"].push_back(library.reason);
        return contents.dump();
      },
      request.seconds);
  if (end.result) return nlohmann::json::parse(*end.result);
  return {{"types", nlohmann::json::array()},
          {"unusable", {"it cannot be loaded: " + (end.console.empty() ? end.how : end.console)}}};
}

LibraryResult library_of(const CheckRequest& request) {
  const nlohmann::json contents = contents_of(request);
  LibraryResult library{.plugin = contents.value("plugin", ""),
                        .version = contents.value("version", ""),
                        .unusable = contents["unusable"]};
  std::vector<std::string> names;
  for (const nlohmann::json& one : contents["types"]) {
    TypeResult type{.kind = one["kind"], .type = one["type"]};
    names.push_back(type.type);
    if (request.type.empty() || request.type == type.type ||
        request.type == type.kind + "/" + type.type)
      library.types.push_back(std::move(type));
  }
  if (!request.type.empty() && library.types.empty() && library.unusable.empty())
    throw Error(Fault::kUsage,
                "it has no type '" + request.type + "'" + did_you_mean(request.type, names),
                request.library.string(), "there are: " + join(names));
  return library;
}

std::vector<std::string> chosen_cases(const CheckRequest& request, const std::string& kind,
                                      const std::vector<Scenario>& scenarios) {
  std::vector<std::string> names = cases_of(kind, scenarios);
  if (request.only.empty()) return names;
  if (std::ranges::find(names, request.only) == names.end())
    throw Error(Fault::kUsage, "no case '" + request.only + "'" + did_you_mean(request.only, names),
                "plugins check", "there are: " + join(names));
  return {request.only};
}

CaseResult run_alone(const CheckRequest& request, const TypeResult& type, const std::string& name,
                     const std::vector<Scenario>& scenarios) {
  const TemporaryFolder folder;
  const int threads = cv::getNumThreads();
  const IsolatedEnd end = run_isolated(
      [&] {
        cv::setNumThreads(threads);
        Registry registry;
        registry.load(request.library);
        const PluginType* found = registry.find(type.kind, type.type);
        if (!found) throw Error(Fault::kStage, "the library has changed", request.library.string());
        const CheckedType checked{*found, request.assignments, request.camera};
        return nlohmann::json(run_case(checked, name, scenarios, folder.path())).dump();
      },
      request.seconds);
  if (end.result) return nlohmann::json::parse(*end.result).get<CaseResult>();
  CaseResult result{.outcome = CaseResult::Outcome::kFailed, .name = name};
  result.finding = {end.how + (end.console.empty() ? "" : "; it said:\n" + end.console),
                    "a run would end, and nobody would know why",
                    "how to follow a case with gdb: the page 'Debugging a plugin'"};
  return result;
}

}  // namespace

LibraryResult check_library(
    const CheckRequest& request,
    const std::function<void(const TypeResult& type, const CaseResult& result)>& done) {
  if (std::error_code error; !fs::is_regular_file(request.library, error))
    throw Error(Fault::kUsage,
                fs::is_directory(request.library, error) ? "is a folder" : "there is no such file",
                request.library.string(), "give the library, build/libstillpoint_NAME.so");
  LibraryResult library = library_of(request);
  const std::vector<Scenario> scenarios = make_scenarios();
  for (TypeResult& type : library.types)
    for (const std::string& name : chosen_cases(request, type.kind, scenarios)) {
      type.cases.push_back(run_alone(request, type, name, scenarios));
      done(type, type.cases.back());
      // Where the usual recording is too much, all others say the same again.
      if (name == scenarios.front().name &&
          type.cases.back().outcome != CaseResult::Outcome::kPassed)
        break;
    }
  return library;
}

}  // namespace stillpoint::plugin_check
