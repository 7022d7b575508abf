// The exception that every function of the library throws for bad input.
#pragma once
#include "base/error.h"
