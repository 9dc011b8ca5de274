// The layouts that can be imported, and how each is recognised.
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "importing/foreign_recording.hpp"

namespace stillpoint::importing {

struct Layout {
  const char* name;    ///< "7-scenes"
  const char* title;   ///< "7-Scenes"
  const char* signs;   ///< what it is recognised by, for messages
  const char* camera;  ///< its camera in configs/cameras; null: the recording brings it
  bool (*recognises)(const std::filesystem::path& recording);
  /// Throws Error(kData) when the recording cannot be used.
  std::unique_ptr<ForeignRecording> (*open)(const std::filesystem::path& recording,
                                            const ImportOptions& options);
};

std::span<const Layout> layouts();

/// Throws Error(kUsage) when there is none of this name.
const Layout& layout_named(const std::string& name);

/// By what lies in the folder, or by the file. Throws Error(kData) when there is no such recording
/// or none of the layouts is recognised, and Error(kUsage) when it needs no import.
const Layout& layout_of(const std::filesystem::path& recording);

}  // namespace stillpoint::importing
