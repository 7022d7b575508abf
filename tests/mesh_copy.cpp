// mesh_copy IN OUT [binary]: reads a mesh and writes it, for comparison with other programs.
#include <cstdio>
#include <string_view>

#include "base/error.h"
#include "io/mesh_file.h"

int main(int argc, char** argv) {
  if (argc < 3) return 1;
  const bool is_binary = argc > 3 && std::string_view(argv[3]) == "binary";
  const auto encoding = is_binary ? aspic::FileEncoding::binary : aspic::FileEncoding::ascii;
  try {
    std::visit([&](const auto& mesh) { aspic::write_mesh(argv[2], mesh, encoding); }, aspic::read_mesh(argv[1]));
    return 0;
  } catch (const aspic::InvalidInput& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
