#include "viewer/upload.h"

#include <fmt/format.h>

#include "base/error.h"
#include "base/printable.h"
#include "io/atomic_file.h"
#include "io/base64.h"
#include "io/gzip.h"

namespace aspic::viewer {
namespace {

namespace fs = std::filesystem;

constexpr size_t kLongestName = 200;  // [bytes]
// A scene may read from its parent folder. The upload therefore has a parent folder, too.
const char* const kScenes = "files";

// Throws InvalidInput for a name outside the upload.
fs::path confined(const std::string& name) {
  const fs::path path = name;
  bool is_plain = !name.empty() && name.size() <= kLongestName && path.is_relative() && !path.has_root_path();
  for (const fs::path& part : path) is_plain = is_plain && !part.empty() && part != "." && part != "..";
  for (const char c : name) is_plain = is_plain && static_cast<unsigned char>(c) >= ' ' && c != '\\' && c != ':';
  if (!is_plain)
    throw InvalidInput(
        fmt::format("load.files: invalid name '{}'; a relative path of at most {} bytes without "
                    "'..' is expected",
                    printable(shortened(name)), kLongestName));
  return path;
}

std::string unpacked(const std::string& name, const std::string& text, size_t most) {
  std::string_view rest = text;
  std::string packed;
  if (!decode_base64(rest, text.size(), packed) || !rest.empty())
    throw InvalidInput("load.files: " + printable(name) + ": is not base64");
  try {
    return gunzipped(packed, most);
  } catch (const InvalidInput& error) {
    throw InvalidInput("load.files: " + printable(name) + ": " + error.what());
  }
}

}  // namespace

std::unique_ptr<TemporaryFolder> written_upload(const Json& files) {
  if (!files.is_array() || files.empty() || files.size() > kMostUploadedFiles)
    refuse("load.files", files.is_array() ? Json(files.size()) : files,
           fmt::format("a list of 1 to {} files is expected", kMostUploadedFiles));
  auto folder = std::make_unique<TemporaryFolder>();
  size_t left = kMostUploadedBytes;
  for (const Json& file : files) {
    Arguments arguments(file, "load.files");
    const fs::path path = folder->path() / kScenes / confined(arguments.text("name"));
    const Json& packed = arguments.value("gzip");
    arguments.finish();
    if (!packed.is_string()) refuse("load.files.gzip", packed, "base64 is expected");
    const std::string bytes = unpacked(path.filename().string(), packed.get_ref<const std::string&>(), left);
    left -= bytes.size();
    std::error_code error;
    fs::create_directories(path.parent_path(), error);
    if (error) throw InvalidInput(path.parent_path().string() + ": cannot be created: " + error.message());
    write_file(path, bytes);
  }
  return folder;
}

fs::path uploaded_file(const TemporaryFolder& folder, const std::string& name) {
  const fs::path path = folder.path() / kScenes / confined(name);
  std::error_code error;
  if (!fs::is_regular_file(path, error))
    throw InvalidInput("load.scene: '" + printable(shortened(name)) + "' is not one of the files that came with it");
  return path;
}

}  // namespace aspic::viewer
