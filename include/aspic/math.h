// Small dense algebra: vectors and matrices of three dimensions over any scalar.
#pragma once
#include "base/compat.h"
#include "math/small.h"
