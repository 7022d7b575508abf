// Lets one process at a time write into a folder of results.
#pragma once
#include <filesystem>
#include <string>

#include "base/error.h"

namespace aspic {

// Another process is writing into the folder.
class FolderInUse : public InvalidInput {
  using InvalidInput::InvalidInput;
};

class RunLock {
 public:
  // Locks the folder until the end of the process or of this object, without a file of its own. Throws FolderInUse
  // if another run or fit holds the lock, with its process if known. Does nothing on file systems that cannot lock
  // folders.
  explicit RunLock(const std::filesystem::path& folder);
  ~RunLock();
  RunLock(const RunLock&) = delete;
  RunLock& operator=(const RunLock&) = delete;

  // Returns "process 4711" if a process of this machine holds the lock; empty: none, or unknown.
  static std::string holder(const std::filesystem::path& folder);

 private:
  int descriptor_;
};

}  // namespace aspic
