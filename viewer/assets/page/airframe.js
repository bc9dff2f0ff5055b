// The shape of a vehicle, of few pieces: each piece costs time in every frame.

import {
  BoxGeometry, BufferGeometry, CircleGeometry, Color, CylinderGeometry, Float32BufferAttribute, Quaternion, Vector3,
} from "../three/three.module.min.js";
import { place } from "./axes.js";

const UP = new Vector3(0, 1, 0);

/** Rotors of which nothing is known, FRD, m. */
export const USUAL_ROTORS = [[0.25, 0, 0], [0, 0.25, 0], [-0.25, 0, 0], [0, -0.25, 0]];

/** Distance of the outermost rotor from the middle, m. */
export function reachOf(rotors) {
  return Math.max(...rotors.map(([x, y]) => Math.hypot(x, y)), 0.01);
}

/** One geometry of some, each in its colour. The parts are used up. */
function joined(parts) {
  const [positions, normals, colours] = [[], [], []];
  for (const [part, colour] of parts) {
    const { r, g, b } = new Color(colour);
    const plain = part.toNonIndexed();
    const { position, normal } = plain.attributes;
    positions.push(...position.array);
    normals.push(...normal.array);
    for (let index = 0; index < position.count; index += 1) colours.push(r, g, b);
    part.dispose();
    plain.dispose();
  }
  return new BufferGeometry()
    .setAttribute("position", new Float32BufferAttribute(positions, 3))
    .setAttribute("normal", new Float32BufferAttribute(normals, 3))
    .setAttribute("color", new Float32BufferAttribute(colours, 3));
}

/** Hub, nose, arms and motors around the places of the rotors. The front is the half in which x is positive. */
export function bodyOf(rotors, { body, front }) {
  const reach = reachOf(rotors);
  const nose = new BoxGeometry(0.24 * reach, 0.2 * reach, 0.3 * reach).translate(...place([0.45 * reach, 0, 0]).toArray());
  const parts = [[new BoxGeometry(0.5 * reach, 0.22 * reach, 0.7 * reach), body], [nose, front]];
  for (const rotor of rotors) {
    const end = place(rotor);
    const along = new Quaternion().setFromUnitVectors(UP, end.clone().normalize());
    const arm = new CylinderGeometry(0.06 * reach, 0.06 * reach, end.length(), 6)
      .applyQuaternion(along).translate(end.x / 2, end.y / 2, end.z / 2);
    const motor = new CylinderGeometry(0.1 * reach, 0.1 * reach, 0.2 * reach, 10).translate(end.x, end.y, end.z);
    parts.push([arm, body], [motor, rotor[0] > 0.3 * reach ? front : body]);
  }
  return joined(parts);
}

/** The discs in which the rotors turn. */
export function discsOf(rotors, { soft }) {
  const reach = reachOf(rotors);
  return joined(rotors.map((rotor) => {
    const { x, y, z } = place(rotor);
    return [new CircleGeometry(0.5 * reach, 20).rotateX(-Math.PI / 2).translate(x, y + 0.14 * reach, z), soft];
  }));
}
