#pragma once
struct Axle {};
