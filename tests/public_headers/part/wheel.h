#pragma once
struct Wheel {};
