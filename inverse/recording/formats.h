// Readers of recordings, one per format. `file` is the name for messages; the errors are InvalidInput with file, line
// or byte, value and remedy.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "recording/recording.h"

namespace aspic {

// Track row column files of Motion Analysis and OpenSim. Blank cells, NaN and 0 0 0 mean not seen.
Recording parse_trc(const std::string& file, std::string_view contents);

// C3D [c3d.org, user guide]: integer and floating-point points of Intel, DEC and MIPS processors. A negative residual
// means not seen.
Recording parse_c3d(const std::string& file, std::string_view contents);

// Archives of numpy: positions (frames, points, 3), and optionally names, times [s] and unit. NaN means not seen.
Recording parse_npz(const std::string& file, std::string_view contents);

// Tables of image correlation, one per frame. Frame 0 is the reference.
Recording read_dic_tables(const std::vector<std::filesystem::path>& files);

// PLY or OBJ files, one per frame, counted from 1. Points are the vertices whose property "marker" is a number from 0
// (PLY), those of point elements "p" in named objects (OBJ), or else all vertices.
Recording read_surface_sequence(const std::vector<std::filesystem::path>& files);

// Makes names unique by appending " (2)" and so on, with a note.
void make_names_unique(Recording& recording);

// Throws InvalidInput unless there are points and frames, numbers and times ascend, and all positions take no more
// memory than a multiple of the `bytes` they were read from.
void check_recording(const Recording& recording, size_t bytes);
// Throws InvalidInput if frames with this many points take far more memory than `bytes` of files. `where`: place for
// the message.
void check_density(size_t frames, size_t points, size_t bytes, const std::string& where);

}  // namespace aspic
