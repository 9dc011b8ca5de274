#include "output_web/steering.hpp"

#include <nlohmann/json.hpp>
#include <utility>

#include "output_web/json_text.hpp"

namespace stillpoint::output_web {

bool Steering::execute(const void* viewer, Command command) {
  if (!allowed_) return false;
  if (!run_ || (command != Command::kSaveMap && !run_->steerable())) return true;
  switch (command) {
    case Command::kPause:
      if (!pause_) pause_ = run_->pause();
      pausing_viewers_.insert(viewer);
      break;
    case Command::kResume:
      pausing_viewers_.clear();
      pause_.reset();
      break;
    case Command::kStep:
      if (pause_) run_->step();
      break;
    case Command::kEnd:
      if (!std::exchange(ending_, true)) note(LogLevel::kInfo, "a viewer ends the run");
      run_->stop();
      break;
    case Command::kSaveMap:
      save_map();
      break;
  }
  return true;
}

bool Steering::leave(const void* viewer) {
  if (pausing_viewers_.erase(viewer) == 0 || !pausing_viewers_.empty()) return false;
  pause_.reset();
  return true;
}

std::string Steering::state() const {
  return text_of({{"allowed", allowed_ && run_},
                  {"steerable", run_ && run_->steerable()},
                  {"paused", pause_ != nullptr},
                  {"ending", ending_},
                  {"map_file", run_ ? run_->map_file().filename().string() : ""},
                  {"notes", notes_},
                  {"note", note_}});
}

void Steering::save_map() {
  try {
    run_->save_map();
    note(LogLevel::kInfo, "map saved: " + run_->map_file().string());
  } catch (const std::exception& error) {
    note(LogLevel::kWarning, std::string("the map was not saved: ") + error.what());
  }
}

void Steering::note(LogLevel level, std::string text) {
  log_(level, text);
  ++notes_;
  note_ = std::move(text);
}

}  // namespace stillpoint::output_web
