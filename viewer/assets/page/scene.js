// The view in three dimensions.

import {
  AmbientLight, Color, DirectionalLight, Group, Mesh, MeshLambertMaterial, PerspectiveCamera, Plane, PlaneGeometry,
  Raycaster, Scene, Vector2, Vector3, WebGLRenderer,
} from "../three/three.module.min.js";
import { OrbitControls } from "../three/OrbitControls.js";
import { Craft, place } from "./craft.js";
import { grid } from "./grid.js";
import { Surroundings } from "./surroundings.js";

const GROUND = 4000;
const GRID = 200;
/** A pointer that moves farther between down and up has turned the view, px. */
const CLICK = 5;
const COLOURS = ["accent", "body", "fence", "front", "good", "grid", "ground", "ink", "mission", "sky", "soft", "target"];

/** The colours of the style sheet. */
function colours() {
  const style = getComputedStyle(document.documentElement);
  return Object.fromEntries(COLOURS.map((name) => [name, style.getPropertyValue(`--${name}`).trim()]));
}

export class View {
  /** `onPlace` gets the place under a click, north and east, at the height that `height()` tells. */
  constructor(canvas, labels, onPlace, height) {
    this.canvas = canvas;
    this.labels = labels;
    this.renderer = new WebGLRenderer({ canvas, antialias: true });
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(50, 1, 0.1, 6000);
    this.camera.position.set(9, 8, 14);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.target.set(0, 2, 0);
    this.controls.maxPolarAngle = 0.495 * Math.PI;
    this.controls.maxDistance = 2000;
    this.controls.minDistance = 0.5;
    this.follows = true;
    this.crafts = new Map();
    this.description = { vehicles: [], obstacles: [] };
    this.surroundings = new Surroundings(this.scene);
    this.sun = new DirectionalLight(0xffffff, 2.2);
    this.sun.position.set(3, 10, 4);
    this.floor = new Group();
    // Drawn first and without depth: depths of so large a plane are too coarse to keep it below the grid.
    this.ground = new Mesh(new PlaneGeometry(GROUND, GROUND), new MeshLambertMaterial({ depthWrite: false }));
    this.ground.rotation.x = -Math.PI / 2;
    this.ground.renderOrder = -1;
    this.scene.add(new AmbientLight(0xffffff, 1.4), this.sun, this.ground, this.floor);
    this.recolour();
    this.listen(onPlace, height);
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
    this.resize();
  }

  listen(onPlace, height) {
    let pressed = null;
    this.canvas.addEventListener("pointerdown", ({ clientX, clientY, button }) => { pressed = button === 0 ? [clientX, clientY] : null; });
    this.canvas.addEventListener("pointerup", ({ clientX, clientY }) => {
      const moved = pressed && Math.hypot(clientX - pressed[0], clientY - pressed[1]);
      pressed = null;
      if (moved === null || moved > CLICK) return;
      const found = this.placeUnder(clientX, clientY, height());
      if (found) onPlace(found);
    });
    this.canvas.addEventListener("keydown", (event) => {
      const turns = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
      if (turns) this.turn(...turns);
      else if (event.key === "+" || event.key === "=") this.zoom(0.85);
      else if (event.key === "-") this.zoom(1 / 0.85);
      else return;
      event.preventDefault();
    });
  }

  /** Turns the view about its target by steps of 6°. */
  turn(around, down) {
    const step = Math.PI / 30;
    const offset = this.camera.position.clone().sub(this.controls.target);
    offset.applyAxisAngle(new Vector3(0, 1, 0), step * around);
    const polar = Math.acos(offset.y / offset.length());
    const wanted = Math.min(Math.max(polar + step * down, 0.02), this.controls.maxPolarAngle);
    offset.applyAxisAngle(new Vector3(-offset.z, 0, offset.x).normalize(), polar - wanted);
    this.camera.position.copy(this.controls.target).add(offset);
  }

  zoom(factor) {
    const offset = this.camera.position.clone().sub(this.controls.target).multiplyScalar(factor);
    this.camera.position.copy(this.controls.target).add(offset);
  }

  /** Where the horizontal plane at a height is under a point of the screen: north and east, m. */
  placeUnder(clientX, clientY, height) {
    const box = this.canvas.getBoundingClientRect();
    const point = new Vector2(((clientX - box.left) / box.width) * 2 - 1, 1 - ((clientY - box.top) / box.height) * 2);
    const caster = new Raycaster();
    this.camera.updateMatrixWorld();
    caster.setFromCamera(point, this.camera);
    const hit = caster.ray.intersectPlane(new Plane(new Vector3(0, 1, 0), -height), new Vector3());
    return hit && [-hit.z, hit.x];
  }

  /** Where a place, NED, is on the screen, px from the canvas's corner; null behind the camera. */
  pointOf(ned) {
    const point = place(ned);
    this.camera.updateMatrixWorld();
    if (point.clone().applyMatrix4(this.camera.matrixWorldInverse).z > 0) return null;
    point.project(this.camera);
    return [((point.x + 1) / 2) * this.canvas.clientWidth, ((1 - point.y) / 2) * this.canvas.clientHeight];
  }

  recolour() {
    this.colours = colours();
    this.scene.background = new Color(this.colours.sky);
    this.ground.material.color.set(this.colours.ground);
    for (const part of this.floor.children) {
      part.geometry.dispose();
      part.material.dispose();
    }
    this.floor.clear();
    // Every 2 m around the start, every 50 m beyond, and the axes through the start.
    const { ink, grid: colour } = this.colours;
    this.floor.add(grid(GRID, 2, 10, colour), grid(10 * GRID, 50, 50, colour), grid(GRID, GRID / 2, 10, colour));
    this.floor.children[2].material.color.set(ink);
    this.floor.children[2].position.y = 0.005;
    for (const craft of this.crafts.values()) craft.recolour(this.colours);
    this.surroundings.build(this.description, this.colours);
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement;
    if (width === 0 || height === 0) return;
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
  }

  /** What stands still. */
  describe(description) {
    this.description = description;
    this.surroundings.build(description, this.colours);
    for (const { id, rotors_m: rotors } of description.vehicles) this.craft(id).setRotors(rotors);
  }

  craft(id) {
    if (!this.crafts.has(id)) this.crafts.set(id, new Craft(this.scene, this.colours));
    return this.crafts.get(id);
  }

  /** Turns the view so that everything is in it. */
  showAll(states) {
    const places = [
      ...states.map(({ position }) => position),
      ...this.description.vehicles.flatMap(({ mission, home_m: home }) => [home, ...mission.map(({ position_m: at }) => at)]),
    ].map((ned) => place(ned));
    const middle = places.reduce((sum, point) => sum.add(point), new Vector3()).divideScalar(places.length || 1);
    const reach = Math.max(3, ...places.map((point) => point.distanceTo(middle)));
    const narrow = Math.min(1, this.camera.aspect);
    const away = this.camera.position.clone().sub(this.controls.target).normalize().multiplyScalar((2.6 * reach) / narrow);
    this.controls.target.copy(middle);
    this.camera.position.copy(middle).add(away);
  }

  /** Looks down on what is in the middle, north up. */
  fromAbove() {
    const distance = this.camera.position.distanceTo(this.controls.target);
    this.camera.position.copy(this.controls.target).add(new Vector3(0, distance, 0.01 * distance));
  }

  /** Draws states; `trails` has the way of each, `chosen` is the one that the view follows. */
  draw(states, trails, chosen) {
    const present = new Set(states.map(({ id }) => id));
    for (const [id, craft] of this.crafts) {
      if (present.has(id)) continue;
      craft.remove();
      this.crafts.delete(id);
    }
    const followed = states.find(({ id }) => id === chosen);
    if (this.follows && followed) {
      const step = place(followed.position).sub(this.controls.target);
      this.controls.target.add(step);
      this.camera.position.add(step);
    }
    this.controls.update();
    for (const state of states) {
      const craft = this.craft(state.id);
      craft.update(state, this.camera);
      craft.setTrail(trails(state.id));
    }
    this.renderer.render(this.scene, this.camera);
    this.name(states);
  }

  /** Names of vehicles, waypoints and obstacles beside them. */
  name(states) {
    const vehicles = states.map(({ id, position }) => ({ text: String(id), at: position, lift: 18, kind: "vehicle" }));
    const others = this.surroundings.names.map(({ text, position }) => ({
      text, at: [-position.z, position.x, -position.y], lift: 10, kind: "waypoint",
    }));
    const named = [...(states.length > 1 ? vehicles : []), ...others];
    while (this.labels.children.length < named.length) this.labels.append(document.createElement("span"));
    while (this.labels.children.length > named.length) this.labels.lastChild.remove();
    named.forEach(({ text, at, lift, kind }, index) => {
      const label = this.labels.children[index];
      const point = this.pointOf(at);
      label.hidden = point === null;
      if (point === null) return;
      if (label.textContent !== text) label.textContent = text;
      label.className = kind;
      label.style.transform = `translate(${(point[0] + 8).toFixed(1)}px, ${(point[1] - lift).toFixed(1)}px)`;
    });
  }
}
