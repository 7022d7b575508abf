// Simulations from TOML scenes, the same as those of the program `aspic`; docs/scene.md lists every key.
#pragma once
#include "mesh/embed.h"
#include "scene/scene.h"
