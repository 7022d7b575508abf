#pragma once
#include "part/wheel.h"
struct Car {
  Wheel wheels[4];
};
