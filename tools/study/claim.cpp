#include "study/claim.hpp"

#include <nlohmann/json.hpp>
#include <string>

#include "stillpoint/error.hpp"
#include "study/text_file.hpp"

namespace stillpoint::study {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

fs::path claim_of(const fs::path& folder) { return folder / "study.json"; }

/// The study file that has claimed the folder; empty: none has.
fs::path claimed_by(const fs::path& claim) {
  const std::string text = read_text(claim);
  if (text.empty()) return {};
  try {
    return Json::parse(text).at("file").get<std::string>();
  } catch (const Json::exception&) {
    throw Error(Fault::kUsage, "does not say whose folder this is", claim.string(),
                "remove it if the study in the folder is to go on, or choose another folder with "
                "-o");
  }
}

bool is_same_study(const fs::path& first, const fs::path& second) {
  if (first.stem() != second.stem()) return false;
  std::error_code error;
  return first == second || !fs::exists(first, error) || read_text(first) == read_text(second);
}

}  // namespace

namespace {

/// Throws Error(kUsage) where a file has the name of a result and no study has claimed the folder.
void require_no_results(const fs::path& folder) {
  for (const char* name : kResultFiles)
    if (fs::exists(folder / name))
      throw Error(Fault::kUsage, "is no file of an earlier study, and would be replaced",
                  (folder / name).string(), "choose another folder with -o, or move it");
}

}  // namespace

void claim_folder(const fs::path& folder, const fs::path& study_file, const std::string& command) {
  const fs::path claim = claim_of(folder);
  const fs::path file = fs::absolute(study_file).lexically_normal();
  const fs::path owner = claimed_by(claim);
  if (!owner.empty() && owner != file && !is_same_study(owner, file))
    throw Error(Fault::kUsage,
                "holds the study '" + owner.stem().string() + "' (" + owner.string() + "), not '" +
                    file.stem().string() + "' (" + file.string() + ")",
                folder.string(), "choose another folder with -o");
  if (owner.empty()) require_no_results(folder);
  const Json json = {
      {"study", file.stem().string()}, {"file", file.string()}, {"command", command}};
  write_text(claim, json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

std::string command_of(const fs::path& folder) {
  const Json claim = Json::parse(read_text(claim_of(folder)), nullptr, false);
  if (!claim.is_object() || !claim.contains("command") || !claim["command"].is_string())
    return "stillpoint ablate " + (folder / "study.yaml").string();
  return claim["command"].get<std::string>();
}

}  // namespace stillpoint::study
