// Ground with heights: a surface, and lines along the squares between them.

import {
  BufferGeometry, Float32BufferAttribute, Group, LineBasicMaterial, LineSegments, Mesh, MeshLambertMaterial, Plane, Vector3,
} from "../three/three.module.min.js";
import { place } from "./axes.js";

/** So far above the surface, m, lines and shadows can be seen. */
const LIFT = 0.02;

/** A position in a row, from 0 to last: the square's first corner, and the share of its side. */
function square(at, last) {
  const within = Math.min(Math.max(at, 0), last);
  const first = Math.min(Math.floor(within), Math.max(last - 1, 0));
  return [first, within - first];
}

/** How high the ground is at a place, north and east, m: bilinear between corners, level beyond them, and flat without any. */
export function heightAt(ground, north, east) {
  if (!ground) return 0;
  const { corner_m: corner, step_m: step, rows_m: rows } = ground;
  const [row, up] = square((north - corner[0]) / step, rows.length - 1);
  const [column, right] = square((east - corner[1]) / step, rows[0].length - 1);
  const along = (heights) => heights[column] * (1 - right) + (heights[column + 1] ?? heights[column]) * right;
  return along(rows[row]) * (1 - up) + along(rows[row + 1] ?? rows[row]) * up;
}

/**
 * Where a ray meets the ground, or null: on the surface that is drawn, or beyond it, where the ground goes on as high as at the edge. Flat
 * ground has neither.
 */
export function underRay(caster, ground, surface) {
  const [hit] = caster.intersectObject(surface, false);
  if (hit) return hit.point;
  const level = (height) => caster.ray.intersectPlane(new Plane(new Vector3(0, 1, 0), -height), new Vector3());
  const rough = level(0);
  return rough && level(heightAt(ground, -rough.z, rough.x));
}

/** The surface, with its lines. */
export function surface({ corner_m: corner, step_m: step, rows_m: rows }, colours) {
  const columns = rows[0].length;
  const corners = [];
  const faces = [];
  const lines = [];
  rows.forEach((heights, row) => heights.forEach((height, column) => {
    corners.push(...place([corner[0] + step * row, corner[1] + step * column, -height]));
    const index = columns * row + column;
    const isLastColumn = column === columns - 1;
    const isLastRow = row === rows.length - 1;
    if (!isLastColumn) lines.push(index, index + 1);
    if (!isLastRow) lines.push(index, index + columns);
    if (!isLastColumn && !isLastRow) faces.push(index, index + 1, index + columns, index + 1, index + columns + 1, index + columns);
  }));
  const positions = new Float32BufferAttribute(corners, 3);
  const solid = new BufferGeometry().setAttribute("position", positions).setIndex(faces);
  solid.computeVertexNormals();
  const material = new MeshLambertMaterial({ color: colours.ground, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 });
  const grid = new LineSegments(
    new BufferGeometry().setAttribute("position", positions).setIndex(lines), new LineBasicMaterial({ color: colours.grid }));
  grid.position.y = LIFT;
  const group = new Group();
  group.add(new Mesh(solid, material), grid);
  return group;
}
