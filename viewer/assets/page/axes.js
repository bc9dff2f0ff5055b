// Places and attitudes as the scene has them.

import { Vector3 } from "../three/three.module.min.js";

/** A place, NED, as the scene has it: x east, y up, z south. */
export function place([north, east, down], target = new Vector3()) {
  return target.set(east, -down, -north);
}

/** An attitude, FRD into NED, scalar first, as the scene has it: the axes change as those of places do. */
export function attitude([w, x, y, z], target) {
  return target.set(y, -z, -x, w).normalize();
}
