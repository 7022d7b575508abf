// A car, without its wheels.
#pragma once
#include "part/car.h"
