#include "io/usd.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <system_error>

#include "base/check.h"
#include "base/error.h"
#include "io/number_text.h"
#include "io/output_file.h"

namespace aspic {
namespace {

namespace fs = std::filesystem;

// Identifier of letters, digits and underscores that does not begin with a digit and is not in `taken`.
std::string identifier(const std::string& name, std::set<std::string>& taken) {
  std::string word;
  for (const char c : name) {
    const bool fits = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    word += fits ? c : '_';
  }
  if (word.empty() || (word[0] >= '0' && word[0] <= '9')) word = "_" + word;
  std::string unique = word;
  for (int i = 2; !taken.insert(unique).second; ++i) unique = word + "_" + std::to_string(i);
  return unique;
}

void append_real(std::string& text, float value) {
  if (std::isnan(value)) {
    text += "nan";
  } else {
    append_number(text, value);
  }
}

std::string points_text(const std::vector<float>& x) {
  std::string text = "[";
  for (size_t i = 0; i + 2 < x.size(); i += 3) {
    text += i == 0 ? "(" : ", (";
    for (size_t k = 0; k < 3; ++k) {
      if (k > 0) text += ", ";
      append_real(text, x[i + k]);
    }
    text += ')';
  }
  return text + "]";
}

// [(lower), (upper)], so that viewers need not read every point. `margin`: around the points [m].
std::string extent_text(const std::vector<float>& x, double margin) {
  std::vector<float> corners(x.begin(), x.begin() + std::min<std::ptrdiff_t>(3, std::ssize(x)));
  corners.insert(corners.end(), corners.begin(), corners.end());
  for (size_t i = 3; i < x.size(); ++i) {
    corners[i % 3] = std::min(corners[i % 3], x[i]);
    corners[3 + i % 3] = std::max(corners[3 + i % 3], x[i]);
  }
  for (size_t i = 0; i < corners.size(); ++i) corners[i] += static_cast<float>(i < 3 ? -margin : margin);
  return points_text(corners);
}

// Rounds almost integral time codes to integers, because the times were rounded.
double time_code(double time, double codes_per_second) {
  const double code = time * codes_per_second;
  return std::abs(code - std::round(code)) < 1e-6 ? std::round(code) : code;
}

std::string head(UpAxis up, const std::vector<double>& codes, double codes_per_second) {
  std::string text = "#usda 1.0\n(\n    defaultPrim = \"simulation\"\n    metersPerUnit = 1\n    upAxis = ";
  text += up == UpAxis::z ? "\"Z\"\n" : "\"Y\"\n";
  const auto add = [&](const char* key, double value) {
    text += std::string("    ") + key + " = ";
    append_number(text, value);
    text += '\n';
  };
  add("timeCodesPerSecond", codes_per_second);
  add("framesPerSecond", codes_per_second);
  add("startTimeCode", codes.empty() ? 0 : codes.front());
  add("endTimeCode", codes.empty() ? 0 : codes.back());
  return text + ")\n";
}

// The vertices of curves in their order, where closed curves end at their first vertex.
struct Curves {
  std::vector<int> counts, vertices;

  explicit Curves(std::span<const Segment> segments) {
    for (const auto& [a, b] : segments) {
      if (vertices.empty() || vertices.back() != a) counts.push_back(1), vertices.push_back(a);
      ++counts.back(), vertices.push_back(b);
    }
  }
};

// Returns the points of the curves, or of all vertices of a mesh.
std::vector<float> points_of(const UsdMesh& mesh, int sample) {
  std::vector<float> x = mesh.points(sample), chosen;
  if (mesh.segments.empty()) return x;
  for (const int v : Curves(mesh.segments).vertices)
    chosen.insert(chosen.end(), x.begin() + 3 * std::ptrdiff_t{v}, x.begin() + 3 * std::ptrdiff_t{v} + 3);
  return chosen;
}

// Returns the attribute with the texture coordinates of all corners; empty without any.
std::string texture(std::span<const TriangleUv> uv) {
  std::string text;
  for (const TriangleUv& triangle : uv)
    for (const auto& [u, v] : triangle) {
      text += text.empty() ? "        texCoord2f[] primvars:st = [(" : ", (";
      append_number(text, u);
      text += ", ";
      append_number(text, v);
      text += ')';
    }
  return text.empty() ? "" : text + "] (\n            interpolation = \"faceVarying\"\n        )\n";
}

std::string topology(const UsdMesh& mesh) {
  std::string counts, indices;
  if (!mesh.segments.empty()) {
    for (const int count : Curves(mesh.segments).counts) {
      if (!counts.empty()) counts += ", ";
      append_number(counts, count);
    }
    std::string width;
    append_number(width, 2 * mesh.radius);
    return "        uniform token type = \"linear\"\n        int[] curveVertexCounts = [" + counts +
           "]\n        float[] widths = [" + width + "] (\n            interpolation = \"constant\"\n        )\n";
  }
  for (const Triangle& triangle : mesh.triangles) {
    counts += counts.empty() ? "3" : ", 3";
    for (const int vertex : triangle) {
      if (!indices.empty()) indices += ", ";
      append_number(indices, vertex);
    }
  }
  return "        int[] faceVertexCounts = [" + counts + "]\n        int[] faceVertexIndices = [" + indices +
         "]\n        uniform token subdivisionScheme = \"none\"\n" +
         (mesh.is_two_sided ? "        uniform bool doubleSided = 1\n" : "") + texture(mesh.uv);
}

template <class ValueText>
void write_samples(OutputFile& file, const std::string& attribute, const std::vector<double>& codes,
                   ValueText value_text) {
  file.append("        " + attribute + ".timeSamples = {\n");
  for (size_t i = 0; i < codes.size(); ++i) {
    std::string line = "            ";
    append_number(line, codes[i]);
    file.append(line + ": " + value_text(static_cast<int>(i)) + ",\n");
  }
  file.append("        }\n");
}

void write_mesh_prim(OutputFile& file, const UsdMesh& mesh, const std::string& name, const std::vector<double>& codes) {
  const std::string type = mesh.segments.empty() ? "Mesh" : "BasisCurves";
  file.append("\n    def " + type + " \"" + name + "\"\n    {\n" + topology(mesh));
  if (mesh.is_fixed) {
    const std::vector<float> x = points_of(mesh, 0);
    file.append("        float3[] extent = " + extent_text(x, mesh.radius) +
                "\n        point3f[] points = " + points_text(x) + "\n    }\n");
    return;
  }
  write_samples(file, "float3[] extent", codes,
                [&](int sample) { return extent_text(points_of(mesh, sample), mesh.radius); });
  write_samples(file, "point3f[] points", codes, [&](int sample) { return points_text(points_of(mesh, sample)); });
  file.append("    }\n");
}

// Apertures and focal lengths of USD are in tenths of the unit of length; only their ratios matter here.
std::string camera_prim(const Camera& camera, const std::string& name) {
  constexpr double kFocalLength = 50, kAspect = 16.0 / 9;
  std::string rows;
  for (const auto& row : camera.matrix()) {
    for (size_t c = 0; c < 4; ++c) {
      rows += c > 0 ? ", " : rows.empty() ? "(" : ", (";
      append_number(rows, row[c]);
    }
    rows += ")";
  }
  std::string text = "\n    def Camera \"" + name + "\"\n    {\n        matrix4d xformOp:transform = (" + rows +
                     ")\n        uniform token[] xformOpOrder = [\"xformOp:transform\"]\n";
  const auto add = [&](const char* attribute, double value) {
    text += std::string("        float ") + attribute + " = ";
    append_number(text, value);
    text += "\n";
  };
  add("focalLength", kFocalLength);
  add("verticalAperture", 2 * kFocalLength * camera.slope);
  add("horizontalAperture", 2 * kFocalLength * camera.slope * kAspect);
  text += "        float2 clippingRange = (";
  append_number(text, camera.nearest);
  text += ", ";
  append_number(text, 1e6 * camera.nearest);
  return text + ")\n    }\n";
}

}  // namespace

UpAxis up_axis(const Vec3d& gravity) {
  const double z = std::abs(gravity[2]);
  return z > std::abs(gravity[0]) && z > std::abs(gravity[1]) ? UpAxis::z : UpAxis::y;
}

void write_usd(const fs::path& path, const std::vector<UsdMesh>& meshes, const std::vector<double>& times,
               double codes_per_second, const UsdView& view) {
  std::vector<double> codes;
  for (const double time : times) codes.push_back(time_code(time, codes_per_second));

  const fs::path unfinished = path.string() + ".unfinished";
  OutputFile file = OutputFile::create(unfinished);
  try {
    file.append(head(view.up, codes, codes_per_second) + "\ndef Xform \"simulation\"\n{");
    std::set<std::string> taken;
    for (const UsdMesh& mesh : meshes) write_mesh_prim(file, mesh, identifier(mesh.name, taken), codes);
    if (view.camera) file.append(camera_prim(*view.camera, identifier("view", taken)));
    file.append("}\n");
    file.sync();
    file.close();
  } catch (const InvalidInput&) {
    std::error_code ignored;
    fs::remove(unfinished, ignored);
    throw;
  }
  std::error_code error;
  fs::rename(unfinished, path, error);
  if (error) throw InvalidInput(path.string() + ": cannot be written: " + error.message());
}

}  // namespace aspic
