// Tetrahedral meshes: plain data, generators of simple shapes, mesh files, and selection of vertices.
#pragma once
#include "io/mesh_file.h"
#include "mesh/generators.h"
#include "mesh/mesh_groups.h"
#include "mesh/numbering.h"
#include "mesh/surface.h"
#include "mesh/tet_mesh.h"
#include "mesh/triangle_uv.h"
#include "mesh/vertices.h"
