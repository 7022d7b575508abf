// Files that a page brings along: a scene with its meshes, from the reader's machine.
#pragma once
#include <filesystem>
#include <memory>
#include <string>

#include "io/external_program.h"
#include "viewer/arguments.h"

namespace aspic::viewer {

// Writes [{"name", "gzip"}, ...], each file gzipped and in base64, into a new temporary folder. Names are relative and
// stay below it. Throws InvalidInput: what is malformed, and more than kMostUploadedFiles or kMostUploadedBytes.
inline constexpr size_t kMostUploadedFiles = 64, kMostUploadedBytes = size_t{200} << 20;
std::unique_ptr<TemporaryFolder> written_upload(const Json& files);

// The file of that name among them. Throws InvalidInput.
std::filesystem::path uploaded_file(const TemporaryFolder& folder, const std::string& name);

}  // namespace aspic::viewer
