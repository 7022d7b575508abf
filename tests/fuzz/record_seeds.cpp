// Runs, fits and measurements as the library writes them.
#include "io/atomic_file.h"
#include "io/checkpoint.h"
#include "io/gmsh.h"
#include "io/pc2.h"
#include "mesh/generators.h"
#include "scene/material_file.h"
#include "seeds.h"
#include "several_files.h"

namespace aspic::fuzz {
namespace {

TetMesh box() { return make_box({{0, 0, 0}}, {{1, 1, 1}}, {1, 1, 1}); }

std::string checkpoint_bytes(const Checkpoint& checkpoint) {
  const auto path = folder_of_process() / "seed.bin";
  write_checkpoint(path, checkpoint);
  return read_file(path);
}

std::string point_cache_bytes() {
  const auto path = folder_of_process() / "seed.pc2";
  Pc2File cache = Pc2File::create(path, 2);
  for (const double x : {0.0, 0.5}) cache.append(std::vector<double>{x, 0, 0, 1, x, 0});
  cache.close();
  return read_file(path);
}

std::string material_bytes() {
  const auto path = folder_of_process() / "seed.vtu";
  write_material(path, {.mesh = box(),
                        .model = "neo_hookean",
                        .values = {{"young", std::vector<double>(6, 1e5)}, {"poisson", std::vector<double>(6, 0.4)}},
                        .further = {{"young_deviation", std::vector<double>(6, 10)}}});
  return read_file(path);
}

// State of a run with two bodies, as run_directory writes it.
Checkpoint run_checkpoint() {
  const std::vector<double> q(24, 0.5), zero(24, 0.0);
  return {.fingerprint = "0123456789abcdef",
          .arrays = {{"q", q},
                     {"qdot", zero},
                     {"time", {0.01}},
                     {"start_q", q},
                     {"start_qdot", zero},
                     {"start_time", {0}},
                     {"history", {}},
                     {"frame_times", {0, 0.01}}},
          .integers = {{"steps_taken", 1}}};
}

std::string data_set_text() {
  return joined_files(
      {{"capture.toml",
        "version = 1\nmesh = \"rest.msh\"\nfixed = \"z < 1e-9\"\nunits = { force = \"mN\" }\n"
        "deviation = { position = 1e-4 }\n[[tip]]\nradius = 0.01\n[[patch]]\nname = \"p\"\nwhere = \"z > 0.9\"\n"},
       {"markers.csv", "marker,x,y,z\nA,0.5,0.4,1\nB,0.2,0.3,1\n"},
       {"cases.csv",
        "case,group,touch_x,touch_y,touch_z,depth,force_x,force_y,force_z,force_sd\n"
        "deep,p,0.5,0.4,1,0.04,0,0,-1,0.01\nshallow,p,0.5,0.4,1,0.02,,,,\n"},
       {"positions.csv", "case,marker,x,y,z,sd\ndeep,A,0.5,0.4,0.96,1e-4\nshallow,B,0.2,0.3,0.99,\n"},
       {"rest.msh", gmsh_bytes(box(), FileEncoding::ascii)}});
}

std::string with_body(const std::string& text) {
  return "[time]\nduration = 0.1\n[[body]]\nname = \"a\"\n" + text + "\n";
}

}  // namespace

std::vector<Seed> record_seeds() {
  const Checkpoint fit{
      .fingerprint = "fuzz", .arrays = {{"p", {1, 2}}, {"state", {3}}}, .integers = {{"journal_bytes", 16}}};
  const Checkpoint run = run_checkpoint();
  return {
      {"checkpoint", "run", checkpoint_bytes(run)},
      {"checkpoint", "fit", checkpoint_bytes(fit)},
      {"point_cache", "two", point_cache_bytes()},
      {"material", "fitted", material_bytes()},
      {"journal", "begun",
       joined_files({{"fit.journal", std::string(40, '\0')}, {"fit.state", checkpoint_bytes(fit)}})},
      {"run_folder", "checkpoint", joined_files({{"checkpoint.bin", checkpoint_bytes(run)}})},
      {"run_folder", "tables", joined_files({{"steps.csv", "step,time\n1,0.01\n"}, {"run.pvd", "<VTKFile/>\n"}})},
      {"data_set", "measured", data_set_text()},
      {"motion_table", "tip", "time,marker,x,y,z,sigma\n0,tip,1,1,1,0.1\n0.01,tip,1,0.9,1,0.1\n"},
  };
}

std::vector<Seed> scene_seeds() {
  const std::string box_shape = "shape = { box = { lower = [0, 0, 0], upper = [1, 2, 1], cells = [1, 2, 1] } }";
  return {
      {"scene", "pinned",
       with_body(box_shape + "\n[[body.pin]]\nwhere = \"y < 0.1\"\nmotion = { rotate = { axis = [0, 1, "
                             "0], rate_deg = 1.0 } }")},
      {"scene", "file",
       with_body("mesh = \"box.msh\"\nmaterial = { young = { file = \"young.csv\" }, poisson = 0.4 }")},
      {"scene", "fitted", with_body("mesh = \"box.msh\"\nmaterial = { file = \"material.vtu\" }")},
      {"scene", "regions",
       with_body("mesh = \"box.msh\"\nmaterial = { density = { regions = { 1 = 100, 2 = 300 } } }")},
      {"scene", "skin",
       with_body("mesh = \"box.msh\"\nskin = \"skin.obj\"\nscale = 2\nrotate = { axis = [1, 0, 0], angle_deg = "
                 "30 }\nvelocity = [\"Y\", 0, 0]")},
      {"scene", "sphere",
       with_body("shape = { sphere = { radius = 1, size = 0.7 } }\ndeform = { twist = { axis = [0, 0, "
                 "1], angle_deg = 1 } }")},
      {"scene", "cylinder",
       with_body("shape = { cylinder = { radius = 1, height = 2, size = 1 } }\n[[body.spring]]\nedges "
                 "= true\nstiffness = 10")},
      {"scene", "torus",
       with_body("shape = { torus = { major_radius = 1, minor_radius = 0.3, size = 0.6 } }\nmaterial = { "
                 "model = \"stvk\", young = \"1e5 * (1 + X)\" }")},
      {"scene", "contact",
       "[contact]\nfriction = 0.5\nreach = 0.01\nstiffness = 1e4\ncreep = 1e-3\n" + with_body(box_shape) +
           "[[obstacle]]\nname = \"floor\"\nplane = { origin = [0, -1, 0], normal = [0, 1, 0] }\n"},
      {"scene", "obstacles",
       with_body(box_shape) + "[[obstacle]]\nmesh = \"skin.obj\"\ntranslate = [0, -3, 0]\nfriction = "
                              "1\n[[obstacle]]\nshape = { sphere = { "
                              "radius = 1, size = 0.7 } }\nscale = 0.5\nrotate = { axis = [0, 0, 1], angle_deg = 30 "
                              "}\ntranslate = [4, 0, 0]\n"},
      {"obstacle", "sheet", "v -2 0 -2\nv 2 0 -2\nv 0 0 4\nf 1 2 3\n"},
      {"obstacle", "fan",
       "v 0 0 -2\nv 0 0 2\nv 2 0 0\nv -2 0 0\nv 0 -2 0\nf 1 2 3\nf 1 2 4\nf 1 2 5\nf 1 1 5\nf 1 2 3\n"},
      {"scene", "sheets",
       "[wind]\nvelocity = [\"sin(t)\", 0, 0]\n[[attach]]\npoints = { body = \"a\", where = \"y > 0.9\" }\nto = { body "
       "= \"b\" }\ngap = \"keep\"\n" +
           with_body("shape = { rectangle = { width = 2, height = 2, size = 1 } }\nshell = { thickness = 1e-2, weave = "
                     "{ weft = 1e5, shear = 1e4 } }") +
           "\n[[body]]\nname = \"b\"\nshape = { disc = { radius = 1, size = 1 } }\nshell = { thickness = 1e-2, bending "
           "= \"mid_edge\" }\ntranslate = [0, 1, 0.1]\n[[body]]\nshape = { tube = { radius = 1, height = 1, size = 1 } "
           "}\nshell = { thickness = 1e-2, moment = 1e-5, rest = \"flat\" }\ntranslate = [5, 0, 0]\n"},
      {"scene", "rods",
       with_body(
           "shape = { line = { from = [0, 0, 0], to = [1, 0, 0], size = 0.5 } }\nrod = { radius = 1e-2, twist_last "
           "= \"t\" }") +
           "\n[[body]]\nshape = { ring = { radius = 1, size = 1 } }\nrod = { radius = 1e-2, rest = \"straight\" }\n"
           "[[body]]\nshape = { coil = { radius = 1, pitch = 1, turns = 2, size = 1 } }\nrod = { radius = 1e-2, "
           "natural_twist = 1 }\n"},
      {"thin", "sheet", "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nv 0 1 0\nf 1 2 3 4\nf 1 2 5\n"},
      {"thin", "rod", "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nl 1 2 3 4\n"},
      {"values", "one", "young\n1e5\n2e5\n"},
      {"values", "three", "# three\n1, 2, 3\n4; 5; 6\n"},
      {"scene", "fill", with_body("mesh = \"skin.obj\"\nmesh_size = 0.5")},
  };
}

}  // namespace aspic::fuzz
