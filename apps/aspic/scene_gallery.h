// The gallery: shipped scenes for newcomers. scenes/gallery.json is its table, the first comment of a scene its
// sentence.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace aspic::cli {

struct GalleryScene {
  std::string name, level, about;    // the file's name without its extension and page number; difficulty; one sentence
  std::filesystem::path path, file;  // relative to the folder; with it
};

// Reads gallery.json in the folder of the scenes. Throws InvalidInput.
std::vector<GalleryScene> gallery_scenes(const std::filesystem::path& folder);

// Returns the scene of this name. Throws InvalidInput with a suggestion.
const GalleryScene& scene_named(const std::string& name, const std::vector<GalleryScene>& scenes);

// Returns docs/gallery.md. Pictures are scenes/gallery/NAME.webp.
std::string gallery_page(const std::vector<GalleryScene>& scenes);

}  // namespace aspic::cli
