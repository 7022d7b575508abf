// Checked and completed capture.toml.
#pragma once
#include <filesystem>
#include <string>

#include "data/measured_table.h"
#include "scene/scene_files.h"
#include "scene/value.h"

namespace aspic {

class CaptureSettings {
 public:
  explicit CaptureSettings(const std::filesystem::path& path);  // the folder, or the file; throws InvalidInput

  const Value& operator[](std::string_view key) const { return *document_.find(key); }  // for keys with a default
  const Value* find(std::string_view key) const { return document_.find(key); }
  Table& document() { return document_; }
  SceneFiles& files() { return files_; }
  bool is_given(std::string_view key) const;               // not a default
  std::filesystem::path file(std::string_view key) const;  // file named by a key; throws InvalidInput if missing
  const std::filesystem::path& folder() const { return folder_; }
  std::string file_name() const { return file_.filename().string(); }

  double unit(const std::string& quantity) const;            // in SI units
  ColumnNames columns(const std::string& table_name) const;  // "markers", "cases", "positions", "forces"

 private:
  std::filesystem::path file_, folder_;
  SceneFiles files_;
  Table document_;
};

}  // namespace aspic
