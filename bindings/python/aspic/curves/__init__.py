"""Materials from curves of homogeneous deformation, as testing machines measure them.

    curves = aspic.curves.read_curves("examples/data/rubber/treloar_1944.csv")
    print(aspic.curves.fit_curves(curves, "spline"))

    python3 -m aspic.curves examples/data/rubber/treloar_1944.csv --material fung spline --plot treloar.svg

Faces without load are free of traction, which determines the transverse stretch t:
uniaxial F = diag(l, t, t); equibiaxial F = diag(l, l, t); planar F = diag(l, 1, t), also called pure shear; simple_shear
F = I + g e1 e2'.
"""
from .fit import Curve, CurveFit, fit_curves
from .homogeneous import DEFORMATIONS, nominal_stress
from .report import markdown, plot, published
from .table import read_curves

__all__ = ["DEFORMATIONS", "Curve", "CurveFit", "fit_curves", "markdown", "nominal_stress", "plot", "published", "read_curves"]
