"""The wheel that pip makes of the package."""
import pathlib
import platform
import re
import subprocess
import sys
import zipfile

import pytest

from aspic import _aspic

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "bindings/python/build_backend"))
import aspic_build  # noqa: E402


def test_installed_wheel_has_a_module_and_a_program_that_runs(tmp_path):
    name = aspic_build._write_wheel(tmp_path, {"one/__init__.py": b"two = 2\n",
                                               f"{aspic_build.NAME}.data/scripts/one": b"#!/bin/sh\necho 2\n"})
    with zipfile.ZipFile(tmp_path / name) as wheel:
        assert wheel.testzip() is None
    pip = [sys.executable, "-m", "pip"]
    if subprocess.run([*pip, "--version"], capture_output=True).returncode != 0:
        pytest.skip("no pip")
    subprocess.run([*pip, "install", "--quiet", "--no-index", "--no-deps", "--prefix", tmp_path / "to",
                    "--break-system-packages", tmp_path / name], check=True, capture_output=True)
    (program,) = (tmp_path / "to").rglob("bin/one")
    assert subprocess.run([program], capture_output=True, text=True).stdout == "2\n"
    (module,) = (tmp_path / "to").rglob("one/__init__.py")
    assert module.read_text() == "two = 2\n"


def test_portable_wheel_holds_the_libraries_that_a_linux_may_lack():
    files = aspic_build._libraries(sys.executable, _aspic.__file__)
    assert "aspic.libs/libmuparser.so.2" in files
    assert not [name for name in files if re.search(r"/(libc|libm|libstdc\+\+|libz|ld-linux)[.-]", name)]
    assert {name.split("/")[1] for name in files if "licenses" in name}
    assert aspic_build._newest_glibc({"a": b"\x7fELF\0GLIBC_2.9\0GLIBC_2.17\0", "b": b"\0GLIBC_2.40"}) == 17
    assert 17 <= aspic_build._newest_glibc(files) <= int(platform.libc_ver()[1].split(".")[1])
    assert ("numpy<2" in aspic_build._metadata()) == aspic_build._needs_numpy_1()
