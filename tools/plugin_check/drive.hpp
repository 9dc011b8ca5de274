// Drives a stage through a scenario as the pipeline does, and checks all that it gives.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "plugin_check/observer.hpp"
#include "plugin_check/scenario.hpp"
#include "stillpoint/sdk.hpp"

namespace stillpoint::plugin_check {

/// One stage on its way through a scenario. Each step() is what the pipeline asks of it for one
/// frame; results are checked as in a run with `validate: full`. Throws StageError or Failure.
class Drive {
 public:
  virtual ~Drive() = default;
  /// False: there was nothing left to do.
  virtual bool step() = 0;
  /// What is asked at the end of a run.
  virtual void finish() {}
  /// What to tell of a drive that went well; may be empty.
  virtual std::string remark() const { return {}; }
  /// Why a drive that went well says nothing of the stage, if so.
  virtual std::optional<Finding> unchecked() const { return std::nullopt; }
};

struct DriveSetup {
  const Scenario& scenario;
  const std::filesystem::path& folder;  ///< exists and is empty
  Observer& observer;
};

/// For each contract. Stage, scenario and observer must outlive the drive.
template <class Interface>
std::unique_ptr<Drive> make_drive(Interface& stage, const DriveSetup& setup);

}  // namespace stillpoint::plugin_check
