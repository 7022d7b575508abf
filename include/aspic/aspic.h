// Aspic animates soft bodies: each time step is one minimization. This header includes the whole public library.
//
// | header          | what it holds                                                                |
// |-----------------|------------------------------------------------------------------------------|
// | math.h          | Vec3d, Mat3d: small dense algebra                                             |
// | mesh.h          | TetMesh; generators, mesh files, selection of vertices                        |
// | material.h      | names and parameters of the materials                                         |
// | sparse.h        | block-sparse matrices, linear solvers                                         |
// | energy.h        | Energy, a term of the potential V; loads, springs, damping                    |
// | optimize.h      | Objective, SearchDirection and the loop that minimizes                        |
// | model.h         | ModelBuilder, Model, State                                                    |
// | simulation.h    | Simulation, StepReport; the objective of a time step for loops of one's own   |
// | scene.h         | simulations from TOML scenes                                                  |
// | results.h       | writers for ParaView and for whole runs                                       |
// | error.h         | InvalidInput, the exception for bad input                                     |
//
// Units are SI. Positions, velocities and forces of a mesh are arrays of 3 numbers per vertex. Bad input throws
// InvalidInput; a numerical failure is a Status in a report. Nothing is printed.
//
// custom_material.h, which is not included here, makes materials from an energy density.
#pragma once
#include "aspic/energy.h"
#include "aspic/error.h"
#include "aspic/material.h"
#include "aspic/math.h"
#include "aspic/mesh.h"
#include "aspic/model.h"
#include "aspic/optimize.h"
#include "aspic/results.h"
#include "aspic/scene.h"
#include "aspic/simulation.h"
#include "aspic/sparse.h"
