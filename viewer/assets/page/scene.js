// The view in three dimensions.

import {
  AmbientLight, DirectionalLight, PerspectiveCamera, Plane, Raycaster, Scene, Vector2, Vector3, WebGLRenderer,
} from "../three/three.module.min.js";
import { OrbitControls } from "../three/OrbitControls.js";
import { place } from "./axes.js";
import { Crafts } from "./crafts.js";
import { Fineness } from "./graphics.js";
import { Grid } from "./grid.js";
import { underRay } from "./ground.js";
import { Labels } from "./labels.js";
import { Surroundings } from "./surroundings.js";

/** A pointer that moves farther between down and up has turned the view, px. */
const CLICK = 5;
const COLOURS = ["accent", "body", "fence", "front", "good", "grid", "ground", "ink", "mission", "sky", "soft", "target"];

/** The colours of the style sheet. */
function colours() {
  const style = getComputedStyle(document.documentElement);
  return Object.fromEntries(COLOURS.map((name) => [name, style.getPropertyValue(`--${name}`).trim()]));
}

export class View {
  /**
   * `on` has functions: `place` gets the place under a click, north and east: on ground with heights, or else at the height that `height()`
   * tells; `change` is called when there is something else to draw.
   */
  constructor(canvas, labels, isSoftware, on) {
    this.canvas = canvas;
    this.labels = new Labels(labels);
    this.on = on;
    // Smooth edges cost a program more than twice the time.
    this.renderer = new WebGLRenderer({ canvas, antialias: !isSoftware });
    this.renderer.autoClear = false;
    this.fineness = new Fineness(isSoftware);
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(50, 1, 0.1, 6000);
    this.camera.position.set(9, 8, 14);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.target.set(0, 2, 0);
    this.controls.maxPolarAngle = 0.495 * Math.PI;
    this.controls.maxDistance = 2000;
    this.controls.minDistance = 0.5;
    this.follows = true;
    this.description = { vehicles: [], obstacles: [] };
    this.surroundings = new Surroundings(this.scene);
    this.crafts = new Crafts(this.scene);
    this.grid = new Grid();
    this.sun = new DirectionalLight(0xffffff, 2.2);
    this.sun.position.set(3, 10, 4);
    this.scene.add(new AmbientLight(0xffffff, 1.4), this.sun, this.grid);
    this.recolour();
    this.listen();
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
    this.resize();
  }

  listen() {
    let pressed = null;
    this.canvas.addEventListener("pointerdown", ({ clientX, clientY, button }) => { pressed = button === 0 ? [clientX, clientY] : null; });
    this.canvas.addEventListener("pointerup", ({ clientX, clientY }) => {
      const moved = pressed && Math.hypot(clientX - pressed[0], clientY - pressed[1]);
      pressed = null;
      if (moved === null || moved > CLICK) return;
      const found = this.placeUnder(clientX, clientY, this.on.height());
      if (found) this.on.place(found);
    });
    this.canvas.addEventListener("keydown", (event) => {
      if (event.ctrlKey || event.altKey || event.metaKey) return;
      const turns = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
      if (turns) this.turn(...turns);
      else if (event.key === "+" || event.key === "=") this.zoom(0.85);
      else if (event.key === "-") this.zoom(1 / 0.85);
      else return;
      event.preventDefault();
    });
    this.controls.addEventListener("change", () => { if (!this.drawing) this.on.change(); });
  }

  /** Turns the view about its target by steps of 6°. */
  turn(around, down) {
    const step = Math.PI / 30;
    const offset = this.camera.position.clone().sub(this.controls.target);
    offset.applyAxisAngle(new Vector3(0, 1, 0), step * around);
    const polar = Math.acos(offset.y / offset.length());
    const wanted = Math.min(Math.max(polar + step * down, 0.02), this.controls.maxPolarAngle);
    offset.applyAxisAngle(new Vector3(-offset.z, 0, offset.x).normalize(), polar - wanted);
    this.lookFrom(offset);
  }

  zoom(factor) {
    this.lookFrom(this.camera.position.clone().sub(this.controls.target).multiplyScalar(factor));
  }

  /** Looks at the target from so far beside it. */
  lookFrom(offset) {
    this.camera.position.copy(this.controls.target).add(offset);
    this.on.change();
  }

  /** Where the ground, if it has heights, or else the horizontal plane at a height is under a point of the screen: north and east, m. */
  placeUnder(clientX, clientY, height) {
    const box = this.canvas.getBoundingClientRect();
    const point = new Vector2(((clientX - box.left) / box.width) * 2 - 1, 1 - ((clientY - box.top) / box.height) * 2);
    const caster = new Raycaster();
    this.camera.updateMatrixWorld();
    caster.setFromCamera(point, this.camera);
    const { ground } = this.description;
    const hit = ground
      ? underRay(caster, ground, this.surroundings.ground.children[0])
      : caster.ray.intersectPlane(new Plane(new Vector3(0, 1, 0), -height), new Vector3());
    return hit && [-hit.z, hit.x];
  }

  /** Where a point of the scene is on the screen, px from the canvas's corner; null where it cannot be seen. */
  pointOf(point) {
    const seen = point.clone().applyMatrix4(this.camera.matrixWorldInverse);
    if (seen.z > 0) return null;
    seen.applyMatrix4(this.camera.projectionMatrix);
    if (Math.max(Math.abs(seen.x), Math.abs(seen.y)) > 1) return null;
    return [((seen.x + 1) / 2) * this.width, ((1 - seen.y) / 2) * this.height];
  }

  recolour() {
    this.colours = colours();
    this.grid.recolour(this.colours);
    this.crafts.recolour(this.colours);
    this.surroundings.build(this.description, this.colours);
    this.on.change();
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement;
    if (width === 0 || height === 0) return;
    Object.assign(this, { width, height });
    this.renderer.setPixelRatio(this.fineness.ratio(width, height));
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.on.change();
  }

  /** What stands still. */
  describe(description) {
    this.description = description;
    this.surroundings.build(description, this.colours);
    this.crafts.describe(description);
    this.grid.visible = !description.ground;
    this.on.change();
  }

  /** Between two lines on the ground, m. */
  get step() {
    return this.description.ground?.step_m ?? this.grid.step;
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
    this.lookFrom(away);
  }

  /** Looks down on what is in the middle, north up. */
  fromAbove() {
    const distance = this.camera.position.distanceTo(this.controls.target);
    this.lookFrom(new Vector3(0, distance, 0.01 * distance));
  }

  /** Draws states; `trails(id)` has the way of each, `chosen` is the one that the view follows. */
  draw(states, trails, chosen) {
    this.drawing = true;
    const followed = states.find(({ id }) => id === chosen);
    if (this.follows && followed) {
      const step = place(followed.position).sub(this.controls.target);
      this.controls.target.add(step);
      this.camera.position.add(step);
    }
    this.controls.update();
    this.camera.updateMatrixWorld();
    this.grid.follow(this.camera, this.controls.target);
    this.crafts.show(states, trails, this.camera);
    this.clear();
    this.renderer.render(this.scene, this.camera);
    this.name(states);
    this.drawing = false;
  }

  /** Sky above the horizon and ground below it: cleared, because a plane of that size costs time for each of its pixels. */
  clear() {
    const { renderer, width, height, camera } = this;
    const { y: up } = camera.getWorldDirection(new Vector3());
    const slope = -up / Math.sqrt(Math.max(1 - up * up, 1e-9));
    const horizon = slope / Math.tan((camera.fov / 2) * (Math.PI / 180));
    renderer.setClearColor(this.colours.sky);
    renderer.clear();
    renderer.setScissorTest(true);
    renderer.setScissor(0, 0, width, height * Math.min(Math.max((1 + horizon) / 2, 0), 1));
    renderer.setClearColor(this.colours.ground);
    renderer.clear();
    renderer.setScissorTest(false);
  }

  /** Takes in how long a drawing was waited for, ms. */
  pace(waited, now) {
    if (this.fineness.take(waited, now)) this.resize();
  }

  /** Names vehicles, waypoints and obstacles. */
  name(states) {
    const vehicles = states.map(({ id, position }) => ({ text: String(id), point: this.pointOf(place(position)), lift: 18, kind: "vehicle" }));
    const others = this.surroundings.names.map(({ text, position }) => ({ text, point: this.pointOf(position), lift: 10, kind: "waypoint" }));
    this.labels.show([...(states.length > 1 ? vehicles : []), ...others]);
  }
}
