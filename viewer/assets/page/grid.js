// A grid on the ground.

import { BufferGeometry, Float32BufferAttribute, LineBasicMaterial, LineSegments } from "../three/three.module.min.js";

/** Lines a step apart over a square, m. They are made of short pieces: software renderers drop lines that end far behind the camera. */
export function grid(size, step, piece, colour) {
  const half = size / 2;
  const ends = [];
  for (let line = -half; line <= half; line += step) {
    for (let from = -half; from < half; from += piece) {
      ends.push(line, 0, from, line, 0, from + piece, from, 0, line, from + piece, 0, line);
    }
  }
  const geometry = new BufferGeometry().setAttribute("position", new Float32BufferAttribute(ends, 3));
  return new LineSegments(geometry, new LineBasicMaterial({ color: colour }));
}
