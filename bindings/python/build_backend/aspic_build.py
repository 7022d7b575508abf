"""PEP 517 backend without requirements: CMake builds and installs the package, this makes a wheel of it.

pip install . compiles for this machine. pip wheel . --no-deps --config-settings portable=1, which tools/wheel calls, makes a wheel
for any x86-64-v3 processor and any Linux whose glibc has the symbols that it needs; it contains the libraries that a Linux may
lack. The build folder build/wheel is kept, so that a second installation takes seconds. Both need the compiler and the
libraries of CONTRIBUTING.md. The wheel also has the program `aspic`, which view() starts, and its scenes.
"""
import base64
import hashlib
import os
import pathlib
import platform
import re
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
# The Python of the wheel: this one, or that of a folder with bin/python3, include and lib/cmake, see tools/wheel.
OTHER = os.environ.get("ASPIC_OTHER_PYTHON")
EXECUTABLE = f"{OTHER}/bin/python3" if OTHER else sys.executable
VERSION = subprocess.check_output([EXECUTABLE, "-c", "import sysconfig; print(sysconfig.get_python_version())"], text=True).strip()
PYTHON = "cp" + VERSION.replace(".", "")
PLATFORM = sysconfig.get_platform().replace("-", "_").replace(".", "_")
# Libraries that the tag manylinux promises (PEP 600); others are copied into the wheel.
EVERYWHERE = ("ld-linux-x86-64", "libc", "libdl", "libexpat", "libgcc_s", "libm", "libpthread", "libstdc++", "libz", "linux-vdso")
# Places of the copies seen from the module and from the program: in an environment, Debian's /usr/local, and pip --target.
LIBRARIES = (f"$ORIGIN/../aspic.libs:$ORIGIN/../lib/python{VERSION}/site-packages/aspic.libs:"
             f"$ORIGIN/../lib/python{VERSION}/dist-packages/aspic.libs")


def _run(*command):
    if subprocess.run([str(part) for part in command], cwd=ROOT).returncode != 0:
        raise SystemExit(f"error: {command[0]} {command[1]} failed; CONTRIBUTING.md lists the packages that it needs")


def _build(portable, prefix):
    build = ROOT / "build/wheel"
    viewer = "ON" if shutil.which("npm") else "OFF"
    options = {"CMAKE_BUILD_TYPE": "Release", "ASPIC_PYTHON": "ON", "ASPIC_TESTS": "OFF", "ASPIC_BENCH": "OFF",
               "ASPIC_MESHER": "OFF", "ASPIC_VIEWER": viewer, "ASPIC_PORTABLE": "ON" if portable else "OFF",
               "Python_EXECUTABLE": EXECUTABLE, "ASPIC_PYTHON_DIR": "aspic"}
    if OTHER:
        options |= {"Python_INCLUDE_DIR": f"{OTHER}/include/python{VERSION}", "pybind11_DIR": f"{OTHER}/lib/cmake/pybind11"}
    if portable:  # an RPATH, which serves the libraries of libraries, too, instead of a RUNPATH
        options |= {"CMAKE_BUILD_WITH_INSTALL_RPATH": "ON", "CMAKE_INSTALL_RPATH": LIBRARIES}
        options |= {f"CMAKE_{kind}_LINKER_FLAGS": "-Wl,--disable-new-dtags" for kind in ("EXE", "MODULE")}
    _run("cmake", "--fresh", "-S", ".", "-B", build, "-G", "Ninja", *(f"-D{key}={value}" for key, value in options.items()))
    _run("cmake", "--build", build, "--target", "_aspic", "aspic_cli")
    _run("cmake", "--install", build, "--prefix", prefix, "--component", "python")
    return build / "bin/aspic"


def _needs_numpy_1():
    """Whether pybind11 is older than 2.12, which cannot read arrays of NumPy 2."""
    header = pathlib.Path(OTHER or "/usr", "include/pybind11/detail/common.h")
    version = re.findall(r"PYBIND11_VERSION_M\w+ (\d+)", header.read_text()) if header.exists() else [2, 12]
    return [int(part) for part in version] < [2, 12]


def _metadata():
    limit = ["numpy<2"] if _needs_numpy_1() else []
    requires = "".join(f"Requires-Dist: {name}\n" for name in PROJECT["dependencies"] + limit)
    return (f"Metadata-Version: 2.1\nName: {PROJECT['name']}\nVersion: {PROJECT['version']}\n"
            f"Summary: {PROJECT['description']}\nRequires-Python: {PROJECT['requires-python']}\n{requires}")


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    info = pathlib.Path(metadata_directory) / f"{NAME}.dist-info"
    info.mkdir()
    (info / "METADATA").write_text(_metadata())
    return info.name


def _libraries(*binaries):
    """{name in the wheel: bytes} of the libraries that binaries need and a Linux may lack, with their licenses."""
    files = {}
    for binary in binaries:
        listed = subprocess.run(["ldd", binary], check=True, capture_output=True, text=True).stdout
        for name, path in re.findall(r"(\S+) => (/\S+)", listed):
            if name.split(".so")[0] in EVERYWHERE:
                continue
            path = pathlib.Path(path).resolve()
            files[f"aspic.libs/{name}"] = path.read_bytes()
            package = subprocess.run(["dpkg", "-S", path], check=True, capture_output=True, text=True).stdout.split(":")[0]
            files[f"{NAME}.dist-info/licenses/{package}"] = pathlib.Path(f"/usr/share/doc/{package}/copyright").read_bytes()
    return files


def _newest_glibc(files):
    """The number after "2." of the oldest glibc that has all symbols of the binaries among {name in the wheel: bytes}."""
    return max(int(n) for data in files.values() if data[:4] == b"\x7fELF" for n in re.findall(rb"\0GLIBC_2\.(\d+)", data))


def _write_wheel(directory, files, system=PLATFORM):
    tag = f"{PYTHON}-{PYTHON}-{system}"
    info = f"{NAME}.dist-info"
    files[f"{info}/METADATA"] = _metadata().encode()
    files[f"{info}/WHEEL"] = f"Wheel-Version: 1.0\nGenerator: aspic\nRoot-Is-Purelib: false\nTag: {tag}\n".encode()

    def line(name, data):
        digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
        return f"{name},sha256={digest},{len(data)}\n"

    files[f"{info}/RECORD"] = ("".join(line(*file) for file in files.items()) + f"{info}/RECORD,,\n").encode()
    with zipfile.ZipFile(pathlib.Path(directory) / f"{NAME}-{tag}.whl", "w") as wheel:
        for name, data in files.items():
            entry = zipfile.ZipInfo(name)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = (0o100755 if "/scripts/" in name else 0o100644) << 16  # mode, of a regular file
            wheel.writestr(entry, data)
    return f"{NAME}-{tag}.whl"


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    with tempfile.TemporaryDirectory() as prefix:
        portable = (config_settings or {}).get("portable")
        program = _build(portable, prefix)
        data = f"{NAME}.data"
        files = {**_files(prefix, ""), f"{data}/scripts/aspic": program.read_bytes(),
                 **_files(ROOT / "scenes", f"{data}/data/share/aspic/scenes/")}
        if not portable:
            return _write_wheel(wheel_directory, files)
        files |= _libraries(program, *pathlib.Path(prefix).rglob("*.so"))
        return _write_wheel(wheel_directory, files, f"manylinux_2_{_newest_glibc(files)}_{platform.machine()}")


def _files(folder, to):
    """{name in the wheel: bytes} of the files below a folder."""
    folder = pathlib.Path(folder)
    return {to + path.relative_to(folder).as_posix(): path.read_bytes() for path in sorted(folder.rglob("*"))
            if path.is_file()}


def build_editable(wheel_directory, config_settings=None, metadata_directory=None):
    _build(False, ROOT / "build/editable")
    return _write_wheel(wheel_directory, {"aspic.pth": f"{ROOT / 'build/wheel/python'}\n".encode()})
