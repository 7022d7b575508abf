"""Converts a recording of another program to tables of Aspic."""
import argparse
import sys

from .convert import InvalidInput, to_data_set, to_motion


def main():
    parser = argparse.ArgumentParser(prog="python3 -m aspic.recordings", description=__doc__, epilog="""
The columns frame or time of cases.csv select a frame of the recording for each case; markers.csv, if there is one, names the
points that are markers. Examples: python3 -m aspic.recordings trial.c3d pillow; python3 -m aspic.recordings 'scan_*.ply' pillow
--unit mm; python3 -m aspic.recordings trial.trc swing.csv""")
    parser.add_argument("recording", help=".trc, .c3d, .npz, .ply, .obj, or a table of image correlation; * selects a sequence")
    parser.add_argument("output", help="Folder of a data set for aspic fit, or a table .csv for aspic fit-motion")
    parser.add_argument("--unit", help="Unit of the recording: m, cm, mm, um, in, or its size in m (of a pixel)")
    parser.add_argument("--rest-frame", type=int, help="Frame that shows the body at rest; default: the first")
    parser.add_argument("--force", action="store_true", help="Overwrite the table of positions")
    given = parser.parse_args()
    try:
        if given.output.endswith(".csv"):
            notes = to_motion(given.recording, given.output, given.unit, given.force)
        else:
            notes = to_data_set(given.recording, given.output, given.unit, given.rest_frame, given.force)
    except (InvalidInput, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    for note in notes:
        print(note)
    return 0


if __name__ == "__main__":
    sys.exit(main())
