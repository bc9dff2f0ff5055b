// What stands still: missions, fences, homes and obstacles.

import {
  BackSide, BufferGeometry, DoubleSide, EdgesGeometry, ExtrudeGeometry, FrontSide, Group, Line, LineBasicMaterial, LineDashedMaterial, LineSegments, Mesh,
  MeshBasicMaterial, MeshLambertMaterial, RingGeometry, Shape, SphereGeometry, Vector3,
} from "../three/three.module.min.js";
import { place } from "./axes.js";
import { surface } from "./ground.js";

const WALL = 30;
const CORNERS = 72;

/** Points of a circle, north and east. */
function circle([north, east], radius) {
  return Array.from({ length: CORNERS }, (_, index) => {
    const angle = (2 * Math.PI * index) / CORNERS;
    return [north + radius * Math.cos(angle), east + radius * Math.sin(angle)];
  });
}

/** Whether the front of a wall around corners, north and east, is within it: by the direction in which they go around. */
function facesIn(corners) {
  const areas = corners.map(([north, east], index) => {
    const [nextNorth, nextEast] = corners[(index + 1) % corners.length];
    return east * nextNorth - nextEast * north;
  });
  return areas.reduce((sum, area) => sum + area, 0) > 0;
}

export class Surroundings {
  constructor(scene) {
    this.scene = scene;
    this.group = new Group();
    scene.add(this.group);
    /** What is named on the screen: place and text. */
    this.names = [];
  }

  /** Draws everything again: it changes rarely. */
  build(description, colours) {
    this.clear();
    for (const vehicle of description.vehicles) {
      this.mission(vehicle, colours);
      if (vehicle.fence) this.fence(vehicle.fence, colours);
      const home = new Mesh(new RingGeometry(0.5, 0.7, 32), new MeshBasicMaterial({ color: colours.good, side: DoubleSide }));
      home.rotation.x = -Math.PI / 2;
      home.position.copy(place(vehicle.home_m)).setY(-vehicle.home_m[2] + 0.03);
      this.group.add(home);
    }
    for (const obstacle of description.obstacles) this.obstacle(obstacle, colours);
    /** The surface of ground that has heights. */
    this.ground = description.ground ? surface(description.ground, colours) : null;
    if (this.ground) this.group.add(this.ground);
  }

  clear() {
    this.group.traverse((part) => {
      part.geometry?.dispose();
      part.material?.dispose();
    });
    this.group.clear();
    this.names = [];
  }

  mission({ id, mission, home_m }, colours) {
    if (mission.length === 0) return;
    const places = mission.map(({ position_m }) => place(position_m));
    const line = new Line(
      new BufferGeometry().setFromPoints([home_m, ...mission.flatMap(({ through_m, position_m }) => [...through_m, position_m])].map((ned) => place(ned))),
      new LineDashedMaterial({ color: colours.mission, dashSize: 0.8, gapSize: 0.5 }));
    line.computeLineDistances();
    this.group.add(line);
    mission.forEach(({ item }, index) => {
      const ball = new Mesh(new SphereGeometry(0.25, 16, 12), new MeshBasicMaterial({ color: colours.mission }));
      ball.position.copy(places[index]);
      this.group.add(ball);
      this.names.push({ position: places[index], text: String(item), vehicle: id });
    });
  }

  fence({ home_m: [north, east, down], radius_m, height_m, zones }, colours) {
    const top = height_m > 0 ? height_m - down : WALL - down;
    if (radius_m > 0) this.wall(circle([north, east], radius_m), top, colours.fence, 0.07, true);
    for (const { inclusion, corners_m } of zones) this.wall(corners_m, top, colours.fence, inclusion ? 0.07 : 0.25, inclusion);
    if (radius_m === 0 && height_m > 0 && zones.length === 0) this.wall(circle([north, east], 50), top, colours.fence, 0.03, true);
  }

  /**
   * A wall around corners, from the ground to a height. It is seen from one side, within what it keeps in and outside of what it keeps
   * out: a camera on the other side looks through it.
   */
  wall(corners, height, colour, opacity, keepsIn) {
    const ends = [...corners, corners[0]].map(([north, east]) => [place([north, east, 0]), place([north, east, -height])]);
    const geometry = new BufferGeometry().setFromPoints(ends.flat());
    const index = [];
    for (let side = 0; side < corners.length; side += 1) {
      const low = 2 * side;
      index.push(low, low + 1, low + 2, low + 1, low + 3, low + 2);
    }
    geometry.setIndex(index);
    const material = new MeshBasicMaterial({ color: colour, transparent: true, opacity, side: facesIn(corners) === keepsIn ? FrontSide : BackSide, depthWrite: false });
    const edge = () => new LineBasicMaterial({ color: colour });
    this.group.add(new Mesh(geometry, material));
    this.group.add(new Line(new BufferGeometry().setFromPoints(ends.map(([low]) => low.clone().setY(0.05))), edge()));
    this.group.add(new Line(new BufferGeometry().setFromPoints(ends.map(([, high]) => high)), edge()));
  }

  obstacle({ name, corners_m, heights_m: [bottom, top] }, colours) {
    // The ground plan lies in x and y, is extruded along z, and then raised to stand.
    const plan = new Shape(corners_m.map(([north, east]) => ({ x: east, y: north })));
    const geometry = new ExtrudeGeometry(plan, { depth: top - bottom, bevelEnabled: false });
    geometry.rotateX(-Math.PI / 2);
    const solid = new Mesh(geometry, new MeshLambertMaterial({ color: colours.soft, transparent: true, opacity: 0.85 }));
    solid.position.y = bottom;
    const edges = new LineSegments(new EdgesGeometry(geometry), new LineBasicMaterial({ color: colours.ink }));
    edges.position.y = bottom;
    this.group.add(solid, edges);
    const middle = corners_m.reduce((sum, [north, east]) => sum.add(new Vector3(east, 0, -north)), new Vector3());
    this.names.push({ position: middle.divideScalar(corners_m.length).setY(top), text: name });
  }
}
