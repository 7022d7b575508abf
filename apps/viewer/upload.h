// Files that a page uploads: a scene with its meshes.
#pragma once
#include <filesystem>
#include <memory>
#include <string>

#include "io/external_program.h"
#include "viewer/arguments.h"

namespace aspic::viewer {

// Writes [{"name", "gzip"}, ...], each file gzipped and in base64, into a new temporary folder. Names are relative
// paths below it. Throws InvalidInput for malformed data, and above kMostUploadedFiles or kMostUploadedBytes.
inline constexpr size_t kMostUploadedFiles = 64, kMostUploadedBytes = size_t{200} << 20;
std::unique_ptr<TemporaryFolder> written_upload(const Json& files);

// Returns the uploaded file of that name. Throws InvalidInput if it is missing.
std::filesystem::path uploaded_file(const TemporaryFolder& folder, const std::string& name);

}  // namespace aspic::viewer
