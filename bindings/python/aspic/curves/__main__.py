"""Fits materials to curves of testing machines."""
import argparse
import pathlib
import sys

from .._aspic import InvalidInput
from .fit import WEIGHTINGS, fit_curves
from .report import markdown, plot, published
from .table import read_curves


def _run(given):
    options = {"poisson": given.poisson, "weighting": given.weighting, "incompressible": not given.compressible, "held": given.hold,
               "starts": given.starts}
    if given.published:
        text, converged = published(given.published, given.material, **options)
        print(text)
        return converged
    if not given.files:
        raise InvalidInput("give at least one FILE with curves, or --published TABLE")
    if given.plot and len(given.files) > 1:
        raise InvalidInput("--plot draws one table; give one FILE")
    fits = {}
    for file in map(pathlib.Path, given.files):
        curves = read_curves(file, given.test)
        for material in given.material:
            fit = fits[file.stem, material] = fit_curves(curves, material, **options)
            if not given.table:
                print(f"{file.stem}, {fit}\n")
    if given.table:
        print(markdown(fits))
    if given.plot:
        import matplotlib
        figure = plot(list(fits.values()), pathlib.Path(given.files[0]).stem).figure
        with matplotlib.rc_context({"svg.fonttype": "none"}):  # letters stay text
            figure.savefig(given.plot)
    return all(fit.converged for fit in fits.values())


def main():
    parser = argparse.ArgumentParser(prog="python3 -m aspic.curves", description=__doc__)
    parser.add_argument("files", nargs="*", metavar="FILE", help="Tables with the columns test, stretch, and stress_Pa, _kPa or _MPa")
    parser.add_argument("--material", nargs="+", default=["spline"], help="Materials to fit, each separately")
    parser.add_argument("--test", nargs="+", default=[], help="Tests of the tables to use; all by default")
    parser.add_argument("--hold", nargs="+", default=[], help="Material parameters to keep at their defaults")
    parser.add_argument("--weighting", default="balanced", choices=WEIGHTINGS,
                        help="Equal weight for each stress (absolute), curve (balanced) or relative error (relative)")
    parser.add_argument("--poisson", type=float, default=0.49, help="Poisson's ratio of the material for scenes")
    parser.add_argument("--compressible", action="store_true", help="Assume a body with this ratio instead of an incompressible one")
    parser.add_argument("--starts", type=int, default=6, help="Number of initial guesses")
    parser.add_argument("--plot", help="Plot measured and fitted curves: FILE.svg or FILE.png (needs matplotlib)")
    parser.add_argument("--table", action="store_true", help="Print a Markdown table of relative errors")
    parser.add_argument("--published", help="Compare with the published errors in this table, for the tables beside it")
    try:
        return 0 if _run(parser.parse_args()) else 3
    except (InvalidInput, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
