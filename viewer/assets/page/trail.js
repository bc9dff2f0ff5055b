// The way that a vehicle has flown.

import { BufferAttribute, BufferGeometry, Line } from "../three/three.module.min.js";
import { place } from "./axes.js";

/** Points that are shown. */
const MOST = 3000;

export class Trail extends Line {
  constructor(material) {
    const position = new BufferAttribute(new Float32Array(3 * MOST), 3);
    super(new BufferGeometry().setAttribute("position", position), material);
    this.frustumCulled = false;
    this.clear();
  }

  clear() {
    this.geometry.setDrawRange(0, 0);
    this.count = 0;
    this.places = null;
  }

  /** Shows places, NED, m. Usually these are the ones of the last time and some more, in the same array: only these are written. */
  show(places) {
    const shown = places.length > MOST ? places.slice(-MOST) : places;
    if (places !== this.places || shown[0] !== this.first || shown.length < this.count) this.clear();
    if (shown.length === this.count) return;
    const { position } = this.geometry.attributes;
    for (let index = this.count; index < shown.length; index += 1) {
      place(shown[index]).toArray(position.array, 3 * index);
    }
    position.addUpdateRange(3 * this.count, 3 * (shown.length - this.count));
    position.needsUpdate = true;
    this.geometry.setDrawRange(0, shown.length);
    [this.places, this.first, this.count] = [places, shown[0], shown.length];
  }
}
