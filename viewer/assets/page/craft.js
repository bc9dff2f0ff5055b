// One vehicle in the scene: body, rotors, trail and set-point.

import {
  BufferAttribute, BufferGeometry, CylinderGeometry, Group, Line, LineBasicMaterial, LineDashedMaterial, Mesh, MeshBasicMaterial,
  MeshLambertMaterial, BoxGeometry, OctahedronGeometry, Quaternion, Vector3, DoubleSide, CircleGeometry,
} from "../three/three.module.min.js";

const TRAIL = 3000;
/** Least size on the screen, as a share of the distance to the camera. */
const LEAST_SIZE = 0.045;

/** A place, NED, as the scene has it: x east, y up, z south. */
export function place([north, east, down], target = new Vector3()) {
  return target.set(east, -down, -north);
}

/** An attitude, FRD into NED, scalar first, as the scene has it: the axes change as those of places do. */
function attitude([w, x, y, z], target) {
  return target.set(y, -z, -x, w).normalize();
}

/** A line with room for so many points, which are given later. */
function growingLine(material, most) {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(3 * most), 3));
  geometry.setDrawRange(0, 0);
  const line = new Line(geometry, material);
  line.frustumCulled = false;
  return line;
}

export class Craft {
  constructor(scene, colours) {
    this.scene = scene;
    this.body = new Group();
    this.shape = new Group();
    this.body.add(this.shape);
    this.materials = {
      body: new MeshLambertMaterial(), front: new MeshLambertMaterial(),
      disc: new MeshBasicMaterial({ transparent: true, opacity: 0.45, side: DoubleSide }),
      trail: new LineBasicMaterial(), target: new MeshBasicMaterial({ wireframe: true }),
      drop: new LineDashedMaterial({ dashSize: 0.4, gapSize: 0.3 }),
    };
    this.trail = growingLine(this.materials.trail, TRAIL);
    this.drop = growingLine(this.materials.drop, 2);
    this.target = new Mesh(new OctahedronGeometry(0.35), this.materials.target);
    this.shadow = new Mesh(new CircleGeometry(0.5, 24), new MeshBasicMaterial({ color: 0, transparent: true, opacity: 0.25 }));
    this.shadow.rotation.x = -Math.PI / 2;
    scene.add(this.body, this.trail, this.drop, this.target, this.shadow);
    this.span = 0;
    this.setRotors([[0.25, 0, 0], [0, 0.25, 0], [-0.25, 0, 0], [0, -0.25, 0]]);
    this.recolour(colours);
  }

  /** Builds the shape around the places of the rotors, FRD, m. The front is the half in which x is positive. */
  setRotors(rotors) {
    const text = JSON.stringify(rotors);
    if (text === this.rotors) return;
    this.rotors = text;
    for (const part of this.shape.children) part.geometry.dispose();
    this.shape.clear();
    const reach = Math.max(...rotors.map(([x, y]) => Math.hypot(x, y)), 0.01);
    this.span = 2 * reach;
    const hub = new Mesh(new BoxGeometry(0.5 * reach, 0.22 * reach, 0.7 * reach), this.materials.body);
    this.shape.add(hub);
    for (const rotor of rotors) this.addArm(rotor, reach);
    const nose = new Mesh(new BoxGeometry(0.24 * reach, 0.2 * reach, 0.3 * reach), this.materials.front);
    nose.position.copy(place([0.45 * reach, 0, 0]));
    this.shape.add(nose);
  }

  addArm(rotor, reach) {
    const end = place(rotor);
    const length = end.length();
    const isFront = rotor[0] > 0.3 * reach;
    const arm = new Mesh(new CylinderGeometry(0.05 * reach, 0.05 * reach, length), this.materials.body);
    arm.position.copy(end).multiplyScalar(0.5);
    arm.quaternion.copy(new Quaternion().setFromUnitVectors(new Vector3(0, 1, 0), end.clone().normalize()));
    const motor = new Mesh(
      new CylinderGeometry(0.1 * reach, 0.1 * reach, 0.2 * reach), isFront ? this.materials.front : this.materials.body);
    motor.position.copy(end);
    const disc = new Mesh(new CylinderGeometry(0.5 * reach, 0.5 * reach, 0.02 * reach, 24), this.materials.disc);
    disc.position.copy(end).setY(end.y + 0.14 * reach);
    this.shape.add(arm, motor, disc);
  }

  recolour(colours) {
    const { body, front, disc, trail, target, drop } = this.materials;
    body.color.set(colours.body);
    front.color.set(colours.front);
    disc.color.set(colours.soft);
    trail.color.set(colours.accent);
    target.color.set(colours.target);
    drop.color.set(colours.soft);
  }

  /** Where it is. */
  update(state, camera) {
    place(state.position, this.body.position);
    attitude(state.quaternion, this.body.quaternion);
    const distance = camera.position.distanceTo(this.body.position);
    this.body.scale.setScalar(Math.max(1, (LEAST_SIZE * distance) / this.span));
    this.target.visible = state.tracks && state.setpoint.every(Number.isFinite);
    if (this.target.visible) place(state.setpoint, this.target.position);
    this.target.scale.setScalar(Math.max(0.3, 0.022 * camera.position.distanceTo(this.target.position)));
    this.shadow.position.set(this.body.position.x, 0.01, this.body.position.z);
    this.shadow.scale.setScalar(this.body.scale.x * this.span);
    this.setLine(this.drop, [state.position, [state.position[0], state.position[1], 0]]);
    this.drop.computeLineDistances();
  }

  /** The way that it has flown, NED, m. */
  setTrail(places) {
    this.setLine(this.trail, places.length > TRAIL ? places.slice(-TRAIL) : places);
  }

  setLine(line, places) {
    const { position } = line.geometry.attributes;
    places.forEach(([north, east, down], index) => position.setXYZ(index, east, -down, -north));
    position.needsUpdate = true;
    line.geometry.setDrawRange(0, places.length);
  }

  remove() {
    const parts = [this.body, this.trail, this.drop, this.target, this.shadow];
    this.scene.remove(...parts);
    for (const part of [...parts, ...this.shape.children]) part.geometry?.dispose();
    for (const material of [...Object.values(this.materials), this.shadow.material]) material.dispose();
  }
}
