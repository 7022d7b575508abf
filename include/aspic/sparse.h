// Symmetric sparse matrices of 3x3 blocks, and solvers for them: analyze once per pattern, factorize once per matrix,
// solve once per right-hand side.
#pragma once
#include "base/huge_pages.h"
#include "base/stop_token.h"
#include "base/stopwatch.h"
#include "linalg/block_sparse.h"
#include "linalg/dense_rows.h"
#include "linalg/linear_solver.h"
#include "linalg/projection.h"
#include "linalg/stiff_rows.h"
