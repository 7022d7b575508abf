// The drawing functions of plot.h, mesh_picture.h and minimize.h. They run other programs, which a browser does not
// have: sheets of this engine have Pictures::none.
#include "aspic/mesh_picture.h"
#include "aspic/minimize.h"
#include "aspic/plot.h"
#include "base/error.h"

namespace aspic::cli {
namespace {

[[noreturn]] void refuse_picture() { throw InvalidInput("pictures cannot be written in a browser"); }

}  // namespace

void draw(const std::filesystem::path&, const Chart&) { refuse_picture(); }
void draw(const std::filesystem::path&, const ContourMap&) { refuse_picture(); }
void draw(const std::filesystem::path&, const SurfacePlot&) { refuse_picture(); }
bool draw(const std::vector<MeshDrawing>&, const StopToken&) { refuse_picture(); }
void draw_paths(const std::filesystem::path&, const std::string&, const Problem&, const std::vector<Minimization>&) {
  refuse_picture();
}
void draw_model(const std::filesystem::path&, const Problem&, const Minimization&, int) { refuse_picture(); }

}  // namespace aspic::cli
