// Lets one process at a time write into a folder of results.
#pragma once
#include <filesystem>

namespace aspic {

class RunLock {
 public:
  // Locks the folder until the end of the process or of this object, without a file of its own. Throws InvalidInput
  // if another run or fit holds the lock, with its process if known. Does nothing on file systems that cannot lock
  // folders.
  explicit RunLock(const std::filesystem::path& folder);
  ~RunLock();
  RunLock(const RunLock&) = delete;
  RunLock& operator=(const RunLock&) = delete;

 private:
  int descriptor_;
};

}  // namespace aspic
