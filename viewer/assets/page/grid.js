// A grid on the ground, as fine as can be seen, wherever the view is.

import { BufferGeometry, Color, Float32BufferAttribute, Group, LineBasicMaterial, LineSegments } from "../three/three.module.min.js";

/** Steps of a grid to each side of its middle. */
const CELLS = 20;
/** Pieces of a line: software renderers drop lines that end far behind the camera. */
const PIECES = 8;
/** Steps between lines, m; each is for distances of the camera up to so many steps. */
const STEPS = [2, 10, 50, 250];
const FAR = 20;

/** Lines in both directions at these places, from -CELLS to CELLS. */
function lines(places) {
  const ends = [];
  const piece = (2 * CELLS) / PIECES;
  for (const line of places) {
    for (let from = -CELLS; from < CELLS; from += piece) {
      ends.push(line, 0, from, line, 0, from + piece, from, 0, line, from + piece, 0, line);
    }
  }
  return new BufferGeometry().setAttribute("position", new Float32BufferAttribute(ends, 3));
}

export class Grid extends Group {
  constructor() {
    super();
    const every = lines(Array.from({ length: 2 * CELLS + 1 }, (_, index) => index - CELLS));
    const part = (geometry) => new LineSegments(geometry, new LineBasicMaterial());
    this.fine = part(every);
    this.coarse = part(every);
    /** Through the origin. */
    this.axes = part(lines([0]));
    this.axes.position.y = 0.005;
    this.add(this.coarse, this.fine, this.axes);
    for (const each of this.children) each.frustumCulled = false;
  }

  recolour({ grid, ground, ink }) {
    this.fine.material.color.set(grid);
    // Far away its lines lie close together.
    this.coarse.material.color.copy(new Color(grid).lerp(new Color(ground), 0.45));
    this.axes.material.color.copy(new Color(ink).lerp(new Color(ground), 0.45));
  }

  /** Lies where a camera looks. */
  follow(camera, target) {
    const distance = camera.position.distanceTo(target);
    const last = STEPS.length - 1;
    const level = STEPS.findIndex((step, index) => index === last || distance < FAR * step);
    /** Between two lines, m. */
    this.step = STEPS[level];
    lay(this.fine, this.step, target);
    lay(this.coarse, STEPS[Math.min(level + 1, last)], target);
    const reach = STEPS[Math.min(level + 1, last)];
    this.axes.scale.set(reach, 1, reach);
  }
}

/** Its lines stay where they are while the grid moves along. */
function lay(part, step, { x, z }) {
  const along = (value) => Math.round(value / step) * step;
  part.position.set(along(x), 0, along(z));
  part.scale.set(step, 1, step);
}
