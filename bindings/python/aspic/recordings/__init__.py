"""Measured motions in the files of other programs, and their conversion to tables that Aspic reads.

    python3 -m aspic.recordings trial.c3d pillow            # positions and markers of the data set in the folder pillow
    python3 -m aspic.recordings trial.trc swing.csv         # a table for aspic fit-motion

Formats: TRC, C3D, NPZ, tables of image correlation, and PLY and OBJ files; a * in a name selects a sequence of files, one per
frame. Memory stays in proportion to the size of the files.
"""
from .convert import to_data_set, to_motion
from .read import read_recording
from .recording import Recording

__all__ = ["Recording", "read_recording", "to_data_set", "to_motion"]
