#include "io/gltf.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "io/atomic_file.h"
#include "io/folder_test.h"

namespace aspic {
namespace {

using BinaryGltf = FolderTest;

// Python reads the file according to the specification: chunks, accessors, morph targets and weights of the animation.
const char* const kReader = R"(
import json, struct, sys
data = open(sys.argv[1], 'rb').read()
magic, version, length = struct.unpack_from('<4sII', data)
assert (magic, version, length) == (b'glTF', 2, len(data))
size, kind = struct.unpack_from('<I4s', data, 12)
assert kind == b'JSON' and size % 4 == 0
head = json.loads(data[20:20 + size])
start = 28 + size
size, kind = struct.unpack_from('<I4s', data, start - 8)
assert kind == b'BIN\0' and size % 4 == 0 and start + size == len(data)
assert head['buffers'][0]['byteLength'] <= size
def read(i):
    a = head['accessors'][i]
    v = head['bufferViews'][a['bufferView']]
    n = a['count'] * {'SCALAR': 1, 'VEC3': 3}[a['type']]
    assert 4 * n == v['byteLength'] and v['byteOffset'] + v['byteLength'] <= size
    values = struct.unpack_from('<%d%s' % (n, {5126: 'f', 5125: 'I'}[a['componentType']]), data, start + v['byteOffset'])
    if a['type'] == 'VEC3':
        assert a['min'] == [min(values[c::3]) for c in range(3)] and a['max'] == [max(values[c::3]) for c in range(3)]
    return values
mesh = head['meshes'][head['nodes'][head['scenes'][head['scene']]['nodes'][0]]['mesh']]
part = mesh['primitives'][0]
assert head['materials'][part['material']]['doubleSided'] is True
base = read(part['attributes']['POSITION'])
targets = [read(t['POSITION']) for t in part['targets']]
sampler = head['animations'][0]['samplers'][0]
times, weights = read(sampler['input']), read(sampler['output'])
assert head['animations'][0]['channels'][0]['target'] == {'node': 0, 'path': 'weights'}
assert len(head['animations'][0]['channels']) == 1 and len(head['scenes'][0]['nodes']) == 2
assert read(part['indices']) == (0, 1, 2)
assert times == (0, 0.25, 0.5)
n = len(targets)
frames = [[b + sum(weights[k * n + t] * targets[t][i] for t in range(n)) for i, b in enumerate(base)] for k in range(3)]
assert frames == [[0, 0, 0, 1, 0, 0, 0, 1, 0], [0, 0, 1, 1, 0, 1, 0, 1, 1], [0, 2, 0, 1, 2, 0, 0, 3, 0]], frames
)";

TEST_F(BinaryGltf, IsReadByPython) {
  const std::vector<Triangle> triangles = {{0, 1, 2}};
  write_file(path("a.glb"),
             glb({.meshes = {{.name = "a \"body\"",
                              .triangles = triangles,
                              .frames = {{0, 0, 0, 1, 0, 0, 0, 1, 0},
                                         {0, 0, 1, 1, 0, 1, 0, 1, 1},
                                         {0, 2, 0, 1, 2, 0, 0, 3, 0}}},
                             {.name = "fixed", .triangles = triangles, .frames = {{0, 0, 0, 1, 0, 0, 0, 1, 0}}}},
                  .times = {0, 0.25, 0.5}}));
  write_file(path("read.py"), kReader);
  const std::string command = "python3 '" + path("read.py").string() + "' '" + path("a.glb").string() + "'";
  EXPECT_EQ(std::system(command.c_str()), 0);
}

}  // namespace
}  // namespace aspic
