// The vehicles in the scene: bodies, rotors, trails, set-points and shadows. What all have alike is drawn at once.

import {
  BufferAttribute, BufferGeometry, CircleGeometry, DoubleSide, InstancedMesh, LineBasicMaterial, LineDashedMaterial, LineSegments,
  Matrix4, MeshBasicMaterial, MeshLambertMaterial, OctahedronGeometry, Quaternion, Vector3,
} from "../three/three.module.min.js";
import { bodyOf, discsOf, reachOf, USUAL_ROTORS } from "./airframe.js";
import { attitude, place } from "./axes.js";
import { heightAt } from "./ground.js";
import { Trail } from "./trail.js";

/** A frame of the stream has no more. */
const MOST = 255;
/** Least size on the screen, as a share of the distance to the camera. */
const LEAST_SIZE = 0.045;
/** Shadows lie so far above the ground, m: they do not flicker. */
const SHADOW_LIFT = 0.03;
const UPRIGHT = new Quaternion();

/** Many of one shape, as many as are set. */
function many(geometry, material) {
  const mesh = new InstancedMesh(geometry, material, MOST);
  mesh.count = 0;
  mesh.frustumCulled = false;
  return mesh;
}

/** Lines from vehicles to the ground. */
function plumbLines(material) {
  const ends = new BufferAttribute(new Float32Array(6 * MOST), 3);
  const lengths = new BufferAttribute(new Float32Array(2 * MOST), 1);
  const geometry = new BufferGeometry().setAttribute("position", ends).setAttribute("lineDistance", lengths);
  const lines = new LineSegments(geometry, material);
  lines.frustumCulled = false;
  return lines;
}

export class Crafts {
  /** Without colours until the first call of `recolour`. */
  constructor(scene) {
    this.scene = scene;
    /** Rotors by vehicle; shapes by rotors; trails by vehicle. */
    this.rotors = new Map();
    this.shapes = new Map();
    this.trails = new Map();
    this.materials = {
      body: new MeshLambertMaterial({ vertexColors: true }),
      discs: new MeshBasicMaterial({ vertexColors: true, transparent: true, opacity: 0.45, side: DoubleSide, depthWrite: false }),
      trail: new LineBasicMaterial(), drop: new LineDashedMaterial({ dashSize: 0.4, gapSize: 0.3 }),
      target: new MeshBasicMaterial({ wireframe: true }),
      shadow: new MeshBasicMaterial({ color: 0, transparent: true, opacity: 0.25, depthWrite: false }),
    };
    this.targets = many(new OctahedronGeometry(0.35), this.materials.target);
    this.shadows = many(new CircleGeometry(0.5, 20).rotateX(-Math.PI / 2), this.materials.shadow);
    this.drops = plumbLines(this.materials.drop);
    scene.add(this.targets, this.shadows, this.drops);
  }

  /** Takes the shapes of vehicles in, and what their shadows fall on. */
  describe({ vehicles, ground }) {
    this.ground = ground;
    this.rotors = new Map(vehicles.map(({ id, rotors_m: rotors }) => [id, rotors]));
    this.forgetShapes();
  }

  recolour(colours) {
    this.colours = colours;
    this.materials.trail.color.set(colours.accent);
    this.materials.target.color.set(colours.target);
    this.materials.drop.color.set(colours.soft);
    this.forgetShapes();
  }

  /** Shapes are built when they are drawn first. */
  forgetShapes() {
    for (const { body, discs } of this.shapes.values()) {
      this.scene.remove(body, discs);
      for (const part of [body, discs]) {
        part.geometry.dispose();
        part.dispose();
      }
    }
    this.shapes.clear();
  }

  shapeOf(id) {
    const rotors = this.rotors.get(id) ?? USUAL_ROTORS;
    const key = JSON.stringify(rotors);
    if (!this.shapes.has(key)) {
      const body = many(bodyOf(rotors, this.colours), this.materials.body);
      const discs = many(discsOf(rotors, this.colours), this.materials.discs);
      this.scene.add(body, discs);
      this.shapes.set(key, { body, discs, span: 2 * reachOf(rotors) });
    }
    return this.shapes.get(key);
  }

  /** Shows states; `places(id)` is the way of each. */
  show(states, places, camera) {
    for (const mesh of this.meshes()) mesh.count = 0;
    states.slice(0, MOST).forEach((state, index) => {
      this.showOne(state, index, camera);
      this.trailOf(state.id).show(places(state.id));
    });
    this.forgetTrails(states);
    for (const mesh of this.meshes()) mesh.instanceMatrix.needsUpdate = true;
    const { position, lineDistance } = this.drops.geometry.attributes;
    position.needsUpdate = true;
    lineDistance.needsUpdate = true;
    this.drops.geometry.setDrawRange(0, 2 * Math.min(states.length, MOST));
  }

  /** What is there many times. */
  meshes() {
    return [this.targets, this.shadows, ...[...this.shapes.values()].flatMap(({ body, discs }) => [body, discs])];
  }

  showOne(state, index, camera) {
    const { body, discs, span } = this.shapeOf(state.id);
    const at = place(state.position);
    const turned = attitude(state.quaternion, new Quaternion());
    // Far away it is drawn larger than it is.
    const size = Math.max(1, (LEAST_SIZE * camera.position.distanceTo(at)) / span);
    put(body, at, turned, size);
    put(discs, at, turned, size);
    const ground = heightAt(this.ground, ...state.position);
    put(this.shadows, new Vector3(at.x, ground + SHADOW_LIFT, at.z), UPRIGHT, size * span);
    if (state.tracks && state.setpoint.every(Number.isFinite)) {
      const target = place(state.setpoint);
      put(this.targets, target, UPRIGHT, Math.max(0.3, 0.022 * camera.position.distanceTo(target)));
    }
    const { position, lineDistance } = this.drops.geometry.attributes;
    position.setXYZ(2 * index, at.x, at.y, at.z).setXYZ(2 * index + 1, at.x, ground, at.z);
    lineDistance.setX(2 * index, 0).setX(2 * index + 1, Math.abs(at.y - ground));
  }

  trailOf(id) {
    if (!this.trails.has(id)) {
      const trail = new Trail(this.materials.trail);
      this.trails.set(id, trail);
      this.scene.add(trail);
    }
    return this.trails.get(id);
  }

  forgetTrails(states) {
    const present = new Set(states.map(({ id }) => id));
    for (const [id, trail] of this.trails) {
      if (present.has(id)) continue;
      this.scene.remove(trail);
      trail.geometry.dispose();
      this.trails.delete(id);
    }
  }
}

/** One more of a shape. */
function put(mesh, at, turned, size) {
  mesh.setMatrixAt(mesh.count, new Matrix4().compose(at, turned, new Vector3(size, size, size)));
  mesh.count += 1;
}
