#include "io/foreign_formats.h"

#include <algorithm>
#include <iterator>

namespace aspic {
namespace {

enum class Converter { gmsh, meshio, blender, paraview, slicer, segmentation, febio, tetgen };

struct ForeignFormat {
  std::string_view extension, name;
  Converter converter;
};

constexpr ForeignFormat kFormats[] = {
    {".step", "STEP geometry", Converter::gmsh},
    {".stp", "STEP geometry", Converter::gmsh},
    {".iges", "IGES geometry", Converter::gmsh},
    {".igs", "IGES geometry", Converter::gmsh},
    {".brep", "Open CASCADE geometry", Converter::gmsh},
    {".geo", "Gmsh geometry", Converter::gmsh},
    {".unv", "an I-DEAS mesh", Converter::gmsh},
    {".inp", "an Abaqus or CalculiX input file", Converter::meshio},
    {".bdf", "a Nastran file", Converter::meshio},
    {".nas", "a Nastran file", Converter::meshio},
    {".fem", "a Nastran file", Converter::meshio},
    {".med", "a Salome mesh", Converter::meshio},
    {".xdmf", "an XDMF file", Converter::meshio},
    {".exo", "an Exodus file", Converter::meshio},
    {".e", "an Exodus file", Converter::meshio},
    {".cgns", "a CGNS file", Converter::meshio},
    {".su2", "an SU2 mesh", Converter::meshio},
    {".vol", "a Netgen mesh", Converter::meshio},
    {".meshb", "a binary Medit mesh", Converter::meshio},
    {".feb", "an FEBio model", Converter::febio},
    {".fbx", "an FBX scene", Converter::blender},
    {".dae", "a COLLADA scene", Converter::blender},
    {".blend", "a Blender scene", Converter::blender},
    {".abc", "an Alembic scene", Converter::blender},
    {".usd", "a USD scene", Converter::blender},
    {".usda", "a USD scene", Converter::blender},
    {".usdc", "a USD scene", Converter::blender},
    {".usdz", "a USD scene", Converter::blender},
    {".3mf", "a 3MF model for printing", Converter::slicer},
    {".amf", "an AMF model for printing", Converter::slicer},
    {".vtp", "VTK polygonal data in XML", Converter::paraview},
    {".vts", "a structured VTK grid", Converter::paraview},
    {".vti", "a VTK image", Converter::paraview},
    {".pvd", "an index of frames", Converter::paraview},
    {".nii", "a medical image", Converter::segmentation},
    {".nrrd", "a medical image", Converter::segmentation},
    {".mha", "a medical image", Converter::segmentation},
    {".dcm", "a medical image", Converter::segmentation},
    {".poly", "a TetGen surface", Converter::tetgen},
    {".smesh", "a TetGen surface", Converter::tetgen},
};

std::string remedy(Converter converter, const std::string& in) {
  switch (converter) {
    case Converter::gmsh:
      return "mesh it by Gmsh: gmsh " + in + " -3 -format msh41 -o OUT.msh";
    case Converter::meshio:
      return "convert its tets by meshio (pip install meshio): meshio convert " + in + " OUT.vtu";
    case Converter::blender:
      return "import it in Blender and export the closed surface as .obj or .ply";
    case Converter::paraview:
      return "open it in ParaView and save the tets as .vtu, or the surface as .ply";
    case Converter::slicer:
      return "save it as .stl in the program that slices it for printing";
    case Converter::segmentation:
      return "segment it, for example in 3D Slicer, and save the surface as .stl";
    case Converter::febio:
      return "export the mesh from FEBio Studio as .vtk";
    case Converter::tetgen:
      return "fill it by TetGen: tetgen -pq " + in + "; then give its .node file";
  }
  return "";
}

}  // namespace

std::string remedy_for_foreign_format(std::string_view extension) {
  const auto format = std::find_if(std::begin(kFormats), std::end(kFormats),
                                   [&](const ForeignFormat& f) { return f.extension == extension; });
  if (format == std::end(kFormats)) return "";
  return "this is " + std::string(format->name) + ", which is not read; " +
         remedy(format->converter, "IN" + std::string(extension));
}

}  // namespace aspic
