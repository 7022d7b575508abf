// Prints the USD layer that tinyusdz read from a file. Arguments: folder of the npm package tinyusdz, file.
import fs from 'node:fs';
import path from 'node:path';

const [folder, file] = process.argv.slice(2).map((name) => path.resolve(name));
// The package supports only browsers and their workers. The next lines make Node look like a worker.
Object.defineProperty(process, 'type', { value: 'renderer' });
globalThis.WorkerGlobalScope = class {};
globalThis.self = globalThis;
globalThis.location = { href: 'http://localhost/' };

// The package does not declare that it is a module, which older Node versions require.
const source = fs.readFileSync(path.join(folder, 'tinyusdz.js'), 'utf8');
const { default: start } = await import('data:text/javascript,' + encodeURIComponent(source));
const wasm = fs.readFileSync(path.join(folder, 'tinyusdz.wasm'));
const tinyusdz = await start({
  instantiateWasm(imports, done) {
    WebAssembly.instantiate(wasm, imports).then((result) => done(result.instance, result.module));
    return {};
  },
});

const bytes = new Uint8Array(fs.readFileSync(file));
const scene = new tinyusdz.TinyUSDZLoaderNative();
if (!scene.loadFromBinary(bytes, 'run.usda')) throw new Error(scene.error());
const layer = new tinyusdz.TinyUSDZLoaderNative();
if (!layer.loadAsLayerFromBinary(bytes, 'run.usda')) throw new Error(layer.error());
process.stdout.write(layer.layerToString());
