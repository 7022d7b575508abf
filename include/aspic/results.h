// Writers of results: single VTK files for ParaView, and the folder of a whole run.
#pragma once
#include "io/vtu.h"
#include "results/run_directory.h"
