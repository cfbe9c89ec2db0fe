// Checks FOLD files with the package of the format's own authors (npm: fold): the arrays and keys are those of its
// specification, its own functions find the edges that the file lists, and the fold angles are those between its normals.
//
//     npm install --prefix FOLDER fold@0.12.0 && node .ci/check_fold.mjs FOLDER FILE.fold...
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { dirname, join, resolve } from "node:path";

const [folder, ...files] = process.argv.slice(2);
const require = createRequire(join(resolve(folder), "package.json"));
const FOLD = require("fold");
const specification = readFileSync(join(dirname(require.resolve("fold")), "..", "doc", "spec.md"), "utf8");
const known = new Set([...specification.matchAll(/^\* `(\w+)`/gm)].map((match) => match[1]));
const attributes = new Set([...specification.matchAll(/`"(\w+)"`/g)].map((match) => match[1]));
// Degrees; both sides compute with doubles, coordinates have 17 digits.
const TOLERANCE = 1e-9;
const PLANAR = 1e-9;
let checks = 0;
const failures = [];

function check(file, holds, message) {
  checks += 1;
  if (!holds) failures.push(`FAILED ${file}: ${message}`);
}

function keys(file, fold) {
  for (const [key, value] of Object.entries(fold)) {
    check(file, known.has(key) || /^\w+:\w+$/.test(key), `${key} is no key of the specification and has no name space`);
    const family = key.match(/^(vertices|edges|faces)_/)?.[1];
    const first = family && Object.keys(fold).find((other) => other.startsWith(`${family}_`));
    if (family) check(file, value.length === fold[first].length, `${key} and ${first} differ in length`);
  }
  for (const name of [...(fold.frame_attributes ?? []), ...(fold.frame_classes ?? []), ...(fold.file_classes ?? [])]) {
    check(file, attributes.has(name) || name.includes(":"), `"${name}" is no class or attribute of the specification`);
  }
  const count = fold.vertices_coords.length;
  for (const list of [...(fold.faces_vertices ?? []), ...(fold.edges_vertices ?? [])]) {
    check(file, list.every((v) => Number.isInteger(v) && v >= 0 && v < count), `[${list}] names no vertices`);
  }
}

const name = ([u, v]) => `${Math.min(u, v)},${Math.max(u, v)}`;

// null for a polygon that is not planar: it has no normal, and the angle of its edges depends on how it is triangulated
function normal(points) {
  const found = FOLD.geom.polygonNormal(points);
  const off = (point) => Math.abs(FOLD.geom.dot(found, FOLD.geom.sub(point, points[0])));
  return points.every((point) => off(point) <= PLANAR * FOLD.geom.dist(points[0], points[1])) ? found : null;
}

// the letters of a flat drawing say how it is to fold
function edges(file, fold, flat) {
  const own = FOLD.convert.faces_vertices_to_edges({ faces_vertices: fold.faces_vertices });
  const found = new Map(own.edges_vertices.map((edge, k) => [name(edge), k]));
  check(file, found.size === fold.edges_vertices.length, "the package finds another number of edges");
  const point = (v) => [...fold.vertices_coords[v], 0].slice(0, 3);
  const normals = fold.faces_vertices.map((face) => normal(face.map(point)));
  fold.edges_vertices.forEach((edge, k) => {
    const at = found.get(name(edge));
    check(file, at !== undefined, `the package finds no edge ${edge}`);
    if (at === undefined) return;
    const border = own.edges_assignment[at] === "B";
    const [letter, angle] = [fold.edges_assignment[k], fold.edges_foldAngle[k]];
    const lattice = "foldwell:lattice" in fold;
    check(file, lattice || border === (letter === "B"), `edge ${edge}: the package says border: ${border}, the file "${letter}"`);
    check(file, Math.sign(angle) === { M: -1, V: 1 }[letter] || ((flat || "FUBJ".includes(letter)) && Math.abs(angle) <= TOLERANCE),
      `edge ${edge}: "${letter}" at ${angle} degrees`);
    if (border) return;
    const has = (face) => face.some((v, k) => name([v, face[(k + 1) % face.length]]) === name(edge));
    if (fold.faces_vertices.filter(has).length > 2) {
      check(file, letter === "U" && angle === null, `edge ${edge} of more than two faces: "${letter}" at ${angle} degrees`);
      return;
    }
    // edges_faces[0] lies left of the edge; in a valley the two normals point into each other
    const [left, right] = own.edges_faces[at].map((face) => normals[face]);
    if (!left || !right) return;
    const [from, to] = own.edges_vertices[at].map(point);
    const along = FOLD.geom.unit(FOLD.geom.sub(to, from));
    const sine = FOLD.geom.dot(FOLD.geom.cross(right, left), along);
    const turn = (Math.atan2(sine, FOLD.geom.dot(left, right)) * 180) / Math.PI;
    check(file, Math.abs(turn - angle) <= TOLERANCE, `edge ${edge}: ${turn} degrees between normals, ${angle} in the file`);
  });
}

for (const file of files) {
  const fold = JSON.parse(readFileSync(file, "utf8"));
  keys(file, fold);
  // angles of a flat drawing are targets, and a drawing without faces leaves them to its reader
  const flat = fold.vertices_coords.every((point) => (point[2] ?? 0) === (fold.vertices_coords[0][2] ?? 0));
  const targets = flat && fold.edges_foldAngle?.some((angle) => angle);
  if (fold.edges_foldAngle && fold.faces_vertices && !targets) edges(file, fold, flat);
}
failures.slice(0, 20).forEach((failure) => console.log(failure));
console.log(`${files.length} FOLD files, ${checks} checks passed by the package of the format, ${failures.length} failed`);
process.exitCode = failures.length || !files.length ? 1 : 0;
