"""PEP 517 backend without requirements: CMake builds and installs the package, this makes a wheel of it.

pip install . compiles for this processor; pip wheel . --no-deps --config-settings portable=1 for any x86-64-v3 one. The build folder
build/wheel is kept, so that a second installation takes seconds. It needs the compiler and the libraries of CONTRIBUTING.md.
The wheel also has the program `aspic`, which view() starts, and its scenes.
"""
import base64
import hashlib
import pathlib
import shutil
import subprocess
import sys
import sysconfig
import tempfile
import tomllib
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[3]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
NAME = f"{PROJECT['name']}-{PROJECT['version']}"
TAG = f"cp{sys.version_info.major}{sys.version_info.minor}"
TAG = f"{TAG}-{TAG}-{sysconfig.get_platform().replace('-', '_').replace('.', '_')}"


def _run(*command):
    if subprocess.run([str(part) for part in command], cwd=ROOT).returncode != 0:
        raise SystemExit(f"error: {command[0]} {command[1]} failed; CONTRIBUTING.md lists the packages that it needs")


def _build(portable, prefix):
    build = ROOT / "build/wheel"
    viewer = "ON" if shutil.which("npm") else "OFF"
    options = {"CMAKE_BUILD_TYPE": "Release", "ASPIC_PYTHON": "ON", "ASPIC_TESTS": "OFF", "ASPIC_BENCH": "OFF",
               "ASPIC_MESHER": "OFF", "ASPIC_VIEWER": viewer, "ASPIC_PORTABLE": "ON" if portable else "OFF",
               "Python_EXECUTABLE": sys.executable, "ASPIC_PYTHON_DIR": "aspic"}
    _run("cmake", "-S", ".", "-B", build, "-G", "Ninja", *(f"-D{key}={value}" for key, value in options.items()))
    _run("cmake", "--build", build, "--target", "_aspic", "aspic_cli")
    _run("cmake", "--install", build, "--prefix", prefix, "--component", "python")
    return build / "bin/aspic"


def _metadata():
    requires = "".join(f"Requires-Dist: {name}\n" for name in PROJECT["dependencies"])
    return (f"Metadata-Version: 2.1\nName: {PROJECT['name']}\nVersion: {PROJECT['version']}\n"
            f"Summary: {PROJECT['description']}\nRequires-Python: {PROJECT['requires-python']}\n{requires}")


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    info = pathlib.Path(metadata_directory) / f"{NAME}.dist-info"
    info.mkdir()
    (info / "METADATA").write_text(_metadata())
    return info.name


def _write_wheel(directory, files):
    info = f"{NAME}.dist-info"
    files[f"{info}/METADATA"] = _metadata().encode()
    files[f"{info}/WHEEL"] = f"Wheel-Version: 1.0\nGenerator: aspic\nRoot-Is-Purelib: false\nTag: {TAG}\n".encode()

    def line(name, data):
        digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
        return f"{name},sha256={digest},{len(data)}\n"

    files[f"{info}/RECORD"] = ("".join(line(*file) for file in files.items()) + f"{info}/RECORD,,\n").encode()
    with zipfile.ZipFile(pathlib.Path(directory) / f"{NAME}-{TAG}.whl", "w") as wheel:
        for name, data in files.items():
            entry = zipfile.ZipInfo(name)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = (0o100755 if "/scripts/" in name else 0o100644) << 16  # mode, of a regular file
            wheel.writestr(entry, data)
    return f"{NAME}-{TAG}.whl"


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    with tempfile.TemporaryDirectory() as prefix:
        program = _build((config_settings or {}).get("portable"), prefix)
        data = f"{NAME}.data"
        return _write_wheel(wheel_directory, {**_files(prefix, ""), f"{data}/scripts/aspic": program.read_bytes(),
                                              **_files(ROOT / "scenes", f"{data}/data/share/aspic/scenes/")})


def _files(folder, to):
    """{name in the wheel: bytes} of the files below a folder."""
    folder = pathlib.Path(folder)
    return {to + path.relative_to(folder).as_posix(): path.read_bytes() for path in sorted(folder.rglob("*"))
            if path.is_file()}


def build_editable(wheel_directory, config_settings=None, metadata_directory=None):
    _build(False, ROOT / "build/editable")
    return _write_wheel(wheel_directory, {"aspic.pth": f"{ROOT / 'build/wheel/python'}\n".encode()})
