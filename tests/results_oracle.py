"""Reads the files of results_samples with other programs: meshio, VTK and tinyusdz if installed, Python's XML parser,
and readers of PC2 and USD text written from the descriptions of the formats. Arguments: the program
results_samples, the folder of the npm package tinyusdz. Exit code 77: meshio is missing."""
import math
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

POINTS, SAMPLES = 5, 3


def expected_points(sample):
    return [[i + sample, i / 3, -sample / 7] for i in range(POINTS)]


def as_float32(rows):
    return [list(struct.unpack("<3f", struct.pack("<3f", *row))) for row in rows]


def check_vtu_with_meshio(folder, meshio):
    for sample in range(SAMPLES):
        mesh = meshio.read(folder / f"body_{sample}.vtu")
        assert mesh.points.dtype == "float64" and mesh.points.tolist() == expected_points(sample)
        assert mesh.cells_dict["tetra"].tolist() == [[0, 1, 2, 3], [1, 2, 3, 4]]
        assert mesh.point_data["velocity"].tolist() == expected_points(1)
        stress = mesh.cell_data["cauchy"][0]
        assert stress.dtype == "float32" and stress[0].tolist() == [1, 2, 3, 4, 5, 6]
        assert mesh.cell_data["body"][0].tolist() == [0, 1]
    large = meshio.read(folder / "large.vtu")
    assert large.points.tolist() == [[i * 0.1, i * 0.01, 1 / (i + 1)] for i in range(40000)]
    assert large.cells_dict["tetra"].tolist() == [[i, i + 1, i + 2, i + 3] for i in range(39997)]


def check_vtu_with_vtk(folder):
    """ParaView's own reader."""
    try:
        from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
    except ImportError:
        return "VTK is not installed"
    for sample in range(SAMPLES):
        reader = vtkXMLUnstructuredGridReader()
        reader.SetFileName(str(folder / f"body_{sample}.vtu"))
        reader.Update()
        grid = reader.GetOutput()
        assert [list(grid.GetPoint(i)) for i in range(grid.GetNumberOfPoints())] == expected_points(sample)
        assert grid.GetNumberOfCells() == 2 and grid.GetCellType(1) == 10
        assert grid.GetCellData().GetArray("cauchy").GetTuple(0) == (1, 2, 3, 4, 5, 6)
    return "read by VTK"


def check_pvd(folder):
    root = xml.etree.ElementTree.parse(folder / "run.pvd").getroot()
    assert root.tag == "VTKFile" and root.get("type") == "Collection"
    frames = [(float(d.get("timestep")), d.get("file")) for d in root.find("Collection")]
    assert frames == [(0.1 * s, f"body_{s}.vtu") for s in range(SAMPLES)], frames
    assert all((folder / name).is_file() for _, name in frames)


def check_pc2(folder):
    data = (folder / "skin.pc2").read_bytes()
    magic, version, points, start, rate, samples = struct.unpack_from("<12siiffi", data)
    assert (magic, version, points, start, rate, samples) == (b"POINTCACHE2\0", 1, POINTS, 0, 1, SAMPLES)
    assert len(data) == 32 + samples * points * 12
    for sample in range(samples):
        numbers = struct.unpack_from(f"<{3 * points}f", data, 32 + sample * points * 12)
        assert [list(numbers[3 * i:3 * i + 3]) for i in range(points)] == as_float32(expected_points(sample))


TOKEN = re.compile(r'\s*("[^"\n]*"|[A-Za-z_][\w:.]*(?:\[\])?|-?\d[\d.eE+-]*|[(){}\[\]=:,])')


class Usda:
    """Parses the part of the USD text grammar that the writer uses; anything else is an error."""

    def __init__(self, text):
        assert text.startswith("#usda 1.0\n")
        position, self.tokens = len("#usda 1.0\n"), []
        while text[position:].strip():
            match = TOKEN.match(text, position)
            assert match, text[position:position + 40]
            self.tokens.append(match[1])
            position = match.end()
        self.tokens.reverse()

    def take(self, expected=None):
        token = self.tokens.pop()
        assert expected is None or token == expected, f"{token} where {expected} was expected"
        return token

    def next_is(self, token):
        return bool(self.tokens) and self.tokens[-1] == token

    def value(self):
        token = self.take()
        if token in "([":
            items, close = [], {"(": ")", "[": "]"}[token]
            while not self.next_is(close):
                items.append(self.value())
                if not self.next_is(close):
                    self.take(",")
            self.take(close)
            return items
        return token[1:-1] if token[0] == '"' else float(token)

    def metadata(self):
        self.take("(")
        values = {}
        while not self.next_is(")"):
            key = self.take()
            self.take("=")
            values[key] = self.value()
        self.take(")")
        return values

    def samples(self):
        self.take("{")
        values = {}
        while not self.next_is("}"):
            code = float(self.take())
            self.take(":")
            assert code not in values
            values[code] = self.value()
            self.take(",")
        self.take("}")
        return values

    def prim(self):
        self.take("def")
        kind, name = self.take(), self.take()[1:-1]
        assert re.fullmatch(r"[A-Za-z_]\w*", name)
        self.take("{")
        children, attributes = {}, {}
        while not self.next_is("}"):
            if self.next_is("def"):
                child, content = self.prim()
                assert child not in children
                children[child] = content
                continue
            typename = self.take()
            if typename == "uniform":
                typename += " " + self.take()
            key = self.take()
            self.take("=")
            attributes[typename + " " + key] = self.samples() if key.endswith(".timeSamples") else self.value()
            if self.next_is("("):
                attributes[key + " metadata"] = self.metadata()
        self.take("}")
        return name, (kind, attributes, children)


def usd_through_tinyusdz(folder, package):
    """Returns the text that an independent USD library writes after reading ours; None if it is not installed."""
    node = shutil.which("node")
    if node is None or not (package / "tinyusdz.wasm").is_file():
        return None
    script = pathlib.Path(__file__).with_name("results_usd.mjs")
    command = [node, str(script), str(package), str(folder / "run.usda")]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def check_usd(text):
    usda = Usda(text)
    assert usda.metadata() == {"defaultPrim": "simulation", "metersPerUnit": 1, "upAxis": "Y", "timeCodesPerSecond": 10,
                               "framesPerSecond": 10, "startTimeCode": 0, "endTimeCode": 2}
    name, (kind, attributes, meshes) = usda.prim()
    assert (name, kind, attributes, usda.tokens) == ("simulation", "Xform", {}, [])
    assert list(meshes) == ["skin", "soft_bar"]
    texture = meshes["skin"][1]
    assert texture["texCoord2f[] primvars:st"] == [[0, 0], [1, 0], [.5, 1], [.25, 0], [-1, 2], [0, 0]]
    assert texture["primvars:st metadata"] == {"interpolation": "faceVarying"}
    assert not any("primvars" in key for key in meshes["soft_bar"][1])
    for kind, attributes, children in meshes.values():
        assert kind == "Mesh" and not children
        assert attributes["int[] faceVertexCounts"] == [3, 3]
        assert attributes["int[] faceVertexIndices"] == [0, 2, 1, 2, 3, 4]
        assert attributes["uniform token subdivisionScheme"] == "none"
        points, extent = attributes["point3f[] points.timeSamples"], attributes["float3[] extent.timeSamples"]
        assert list(points) == list(extent) == [0, 1, 2]
        for sample in range(SAMPLES):
            expected = as_float32(expected_points(sample))
            read = as_float32(points[sample])
            assert read == expected, (read, expected)
            columns = list(zip(*expected))
            assert as_float32(extent[sample]) == [[min(c) for c in columns], [max(c) for c in columns]]
            assert all(math.isfinite(x) for row in read for x in row)


def main():
    try:
        import meshio
    except ImportError:
        print("python3-meshio is not installed")
        sys.exit(77)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        subprocess.run([sys.argv[1], name], check=True)
        check_vtu_with_meshio(folder, meshio)
        vtk = check_vtu_with_vtk(folder)
        check_pvd(folder)
        check_pc2(folder)
        check_usd((folder / "run.usda").read_text())
        through_tinyusdz = usd_through_tinyusdz(folder, pathlib.Path(sys.argv[2]))
        if through_tinyusdz is not None:
            check_usd(through_tinyusdz)
    tinyusdz = "tinyusdz is not installed" if through_tinyusdz is None else "read by tinyusdz"
    print(f"VTU (meshio; {vtk}), PVD, PC2 and USD (own parser; {tinyusdz}) are read back as written")


main()
