// Imports among the modules of the page.
import assert from "node:assert/strict";
import { existsSync, readdirSync, readFileSync } from "node:fs";
import { dirname, join, relative } from "node:path";
import { test } from "node:test";

const kSource = join(import.meta.dirname, "../src");
const modules = readdirSync(kSource, { recursive: true, encoding: "utf8" }).filter((name) => name.endsWith(".ts"));

// Imported modules of web/src, also those of types.
function importsOf(name: string): string[] {
  const found = readFileSync(join(kSource, name), "utf8").matchAll(/(?:from|import) "(\.[^"]*)"/g);
  return [...found].map(([, path]) => `${join(dirname(name), path!)}.ts`).filter((path) => existsSync(join(kSource, path)));
}

// Returns a circle of a graph as a path; null: none.
function circle(graph: Map<string, Iterable<string>>): string[] | null {
  const done = new Set<string>();
  const visit = (at: string, path: string[]): string[] | null => {
    if (path.includes(at)) return [...path.slice(path.indexOf(at)), at];
    if (done.has(at)) return null;
    for (const next of graph.get(at) ?? []) {
      const found = visit(next, [...path, at]);
      if (found) return found;
    }
    done.add(at);
    return null;
  };
  for (const start of graph.keys()) {
    const found = visit(start, []);
    if (found) return found;
  }
  return null;
}

test("modules do not import each other in circles", () => {
  assert.equal(circle(new Map([["a", ["b"]], ["b", ["c"]], ["c", ["b"]]]))?.join(), "b,c,b");
  assert.ok(modules.length > 90);
  assert.equal(circle(new Map(modules.map((name) => [name, importsOf(name)]))), null);
});

test("folders do not import each other in circles", () => {
  const folders = new Map<string, Set<string>>();
  const folderOf = (name: string): string => dirname(name);
  for (const name of modules) {
    const reached = folders.get(folderOf(name)) ?? new Set<string>();
    for (const path of importsOf(name)) if (folderOf(path) !== folderOf(name) && folderOf(path) !== ".") reached.add(folderOf(path));
    folders.set(folderOf(name), reached);
  }
  folders.delete("."); // may import all
  assert.equal(circle(folders), null);
});

test("no module imports one outside the folder", () => {
  for (const name of modules)
    for (const [, path] of readFileSync(join(kSource, name), "utf8").matchAll(/(?:from|import) "(\.[^"]*)"/g))
      assert.ok(!relative(kSource, join(kSource, dirname(name), path!)).startsWith(".."), `${name} imports ${path}`);
});
