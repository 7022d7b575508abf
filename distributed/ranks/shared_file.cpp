#include "ranks/shared_file.h"

#include <mpi.h>

#include <algorithm>
#include <exception>
#include <stdexcept>
#include <string>

#include "base/error.h"
#include "ranks/message_size.h"

namespace aspic::distributed {
namespace {

namespace fs = std::filesystem;

}  // namespace

struct SharedFile::Impl {
  std::string path;
  MPI_File file = MPI_FILE_NULL;

  // MPI returns errors of files by default.
  void check(int code) const {
    if (code == MPI_SUCCESS) return;
    char text[MPI_MAX_ERROR_STRING] = {};
    int length = 0;
    MPI_Error_string(code, text, &length);
    throw std::runtime_error(path + ": cannot be written: " + std::string(text, static_cast<size_t>(length)) +
                             "; free disk space or choose another folder with --out");
  }
};

SharedFile::SharedFile(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
SharedFile::SharedFile(SharedFile&&) noexcept = default;

SharedFile SharedFile::create(const fs::path& path) {
  auto impl = std::make_unique<Impl>();
  impl->path = path.string();
  impl->check(
      MPI_File_open(MPI_COMM_WORLD, impl->path.c_str(), MPI_MODE_CREATE | MPI_MODE_WRONLY, MPI_INFO_NULL, &impl->file));
  impl->check(MPI_File_set_size(impl->file, 0));
  return SharedFile(std::move(impl));
}

SharedFile::~SharedFile() {
  // Closing waits for other ranks, which an exception on this rank alone must not.
  if (impl_ && impl_->file != MPI_FILE_NULL && std::uncaught_exceptions() == 0) MPI_File_close(&impl_->file);
}

void SharedFile::write_all(std::uint64_t position, const void* data, std::size_t bytes) const {
  constexpr std::uint64_t kChunk = std::uint64_t{1} << 28;
  std::uint64_t most = bytes;
  MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPI_UINT64_T, MPI_MAX, MPI_COMM_WORLD);
  for (std::uint64_t begin = 0; begin < most; begin += kChunk) {
    const std::uint64_t here = begin < bytes ? std::min<std::uint64_t>(kChunk, bytes - begin) : 0;
    MPI_Status status;
    impl_->check(MPI_File_write_at_all(impl_->file, static_cast<MPI_Offset>(position + begin),
                                       static_cast<const char*>(data) + begin, message_size(here), MPI_BYTE, &status));
    int written = 0;
    MPI_Get_count(&status, MPI_BYTE, &written);
    if (static_cast<std::uint64_t>(written) != here)
      throw std::runtime_error(impl_->path + ": only a part was written; is the disk full?");
  }
}

void SharedFile::sync() const { impl_->check(MPI_File_sync(impl_->file)); }

void replace_by(const fs::path& finished, const fs::path& target) {
  std::error_code error;
  fs::rename(finished, target, error);
  if (error) throw InvalidInput(target.string() + ": cannot be written: " + error.message());
}

}  // namespace aspic::distributed
