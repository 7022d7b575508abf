// One process at a time writes into a folder of results.
#pragma once
#include <filesystem>

namespace aspic {

class RunLock {
 public:
  // Locks the folder until the end of the process or of this object, without a file of its own. Throws InvalidInput
  // when another run or fit holds the lock, with its process where the system knows it. A file system that cannot lock
  // folders leaves it unprotected.
  explicit RunLock(const std::filesystem::path& folder);
  ~RunLock();
  RunLock(const RunLock&) = delete;
  RunLock& operator=(const RunLock&) = delete;

 private:
  int descriptor_;
};

}  // namespace aspic
