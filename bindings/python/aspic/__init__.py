"""Aspic animates soft bodies: every time step minimizes one energy.

    import aspic
    scene = aspic.Scene(gravity=(0, -9.81, 0))
    jelly = scene.add(aspic.box((.1, .1, .1), cells=(4, 4, 4)), name="jelly",
                      material=aspic.Material("neo_hookean", young=5e3, poisson=.4))
    jelly.pin(jelly.vertices[:, 1] == .1)
    sim = aspic.Simulation(scene, h=0.01)
    for report in sim.steps(50):
        print(report.time, report.status, sim.q[0, 1])

Units are SI. Arrays of vertices have the shape (n, 3) and the order of the mesh; results are copies. Bad input raises
InvalidInput, a ValueError of one line; the report of a step states whether it converged.
"""
import weakref

from ._cpu import require_processor

require_processor()
# Registers the removal of temporary folders at exit before _aspic registers its hook, which therefore runs first: other
# threads stop computing before their files go.
weakref.finalize(require_processor, bool).detach()

from ._aspic import (  # noqa: E402
    Hessian,
    InvalidInput,
    Iteration,
    LinearSolver,
    Objective,
    Snapshot,
    StepReport,
    __version__,
    integrator_names,
    linear_solver_names,
    materials,
    minimizer_names,
    set_thread_count,
    test_functions,
    thread_count,
)
from . import plot  # noqa: E402
from .energies import Energy, TetEnergy, check_derivatives  # noqa: E402
from .figures import Figure, show  # noqa: E402
from .fits import Equilibrium, Trajectory, capture, fit, lame, verify  # noqa: E402
from .live import View, view  # noqa: E402
from .meshes import Mesh, Surface, box, cylinder, read_mesh, rod, sheet, sphere, torus  # noqa: E402
from .optimize import backtrack, minimize, test_function  # noqa: E402
from .results import Run  # noqa: E402
from .scenes import Body, Material, Scene  # noqa: E402
from .simulations import NotConverged, Reports, Simulation, Trace, compare  # noqa: E402

__all__ = [
    "Body", "Energy", "Equilibrium", "Figure", "Hessian", "InvalidInput", "Iteration", "LinearSolver", "Material", "Mesh",
    "NotConverged", "Objective", "Reports", "Run", "Scene", "Simulation", "Snapshot", "StepReport", "Surface",
    "TetEnergy", "Trace", "Trajectory", "View", "__version__", "backtrack", "box", "capture", "check_derivatives",
    "compare", "cylinder", "fit", "integrator_names", "lame", "linear_solver_names", "materials", "minimize",
    "minimizer_names", "plot", "read_mesh", "rod", "set_thread_count", "sheet", "show", "sphere", "test_function",
    "test_functions", "thread_count", "torus", "verify", "view",
]
