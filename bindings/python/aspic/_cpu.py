"""Refuses processors that lack the instructions of the module, which would end the program without a message."""
import pathlib
import platform

NEEDED = {"avx2", "fma", "bmi2", "f16c", "movbe"}  # of x86-64-v3


def require_processor(cpuinfo="/proc/cpuinfo"):
    if platform.machine() != "x86_64" or not pathlib.Path(cpuinfo).exists():
        return
    for line in pathlib.Path(cpuinfo).read_text(errors="replace").splitlines():
        if line.startswith("flags"):
            if missing := NEEDED - set(line.split()):
                raise ImportError("aspic needs an x86-64-v3 processor (2013 or later); this one lacks "
                                  + ", ".join(sorted(missing)))
            return
