// An axle.
#pragma once
#include "part/axle.h"
