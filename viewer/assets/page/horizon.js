// The artificial horizon with heading.

import { angles } from "./frame.js";
import { Rarely } from "./rarely.js";

const PIXELS_PER_RAD = 190;
const DEGREE = Math.PI / 180;
/** Turns that nobody sees, rad. */
const UNSEEN = 0.002;
/** A screen reader is not told more often, ms. */
const TOLD_MS = 1000;

export class Horizon {
  constructor(canvas) {
    this.canvas = canvas;
    this.context = canvas.getContext("2d");
    this.label = new Rarely(TOLD_MS, () => this.tell());
    this.recolour();
  }

  /** Reads the colours of the style sheet. */
  recolour() {
    const style = getComputedStyle(document.documentElement);
    const colour = (name) => style.getPropertyValue(name).trim();
    this.colours = { sky: colour("--horizon-sky"), ground: colour("--horizon-ground"), front: colour("--front") };
    this.shown = null;
  }

  /** Draws an attitude. */
  draw(quaternion) {
    const { context, canvas } = this;
    const [roll, pitch, yaw] = angles(quaternion);
    if (this.shown?.every((angle, axis) => Math.abs(angle - [roll, pitch, yaw][axis]) < UNSEEN)) return;
    this.shown = [roll, pitch, yaw];
    const size = canvas.width;
    context.save();
    context.clearRect(0, 0, size, size);
    context.translate(size / 2, size / 2);
    context.save();
    context.rotate(-roll);
    this.background(size, pitch * PIXELS_PER_RAD);
    this.ladder(pitch);
    context.restore();
    this.wings();
    this.heading(size, yaw);
    context.restore();
    this.label.ask();
  }

  /** Says the attitude in words. */
  tell() {
    const [roll, pitch, yaw] = this.shown.map((angle) => Math.round(angle / DEGREE) + 0);
    this.canvas.setAttribute("aria-label", `Attitude: roll ${roll}°, pitch ${pitch}°, heading ${(yaw + 360) % 360}°`);
  }

  background(size, offset) {
    const { context, colours } = this;
    context.fillStyle = colours.sky;
    context.fillRect(-size, -2 * size + offset, 2 * size, 2 * size);
    context.fillStyle = colours.ground;
    context.fillRect(-size, offset, 2 * size, 2 * size);
    context.strokeStyle = "#ffffff";
    context.lineWidth = 2;
    this.line(-size, offset, size, offset);
  }

  ladder(pitch) {
    const { context } = this;
    context.fillStyle = "#ffffff";
    context.font = "16px system-ui, sans-serif";
    context.textBaseline = "middle";
    for (let degrees = -60; degrees <= 60; degrees += 10) {
      const y = (pitch - degrees * DEGREE) * PIXELS_PER_RAD;
      if (degrees === 0 || Math.abs(y) > 95) continue;
      const half = degrees % 20 === 0 ? 40 : 22;
      this.line(-half, y, half, y);
      if (half === 40) context.fillText(String(Math.abs(degrees)), half + 6, y);
    }
  }

  wings() {
    const { context, colours } = this;
    context.strokeStyle = colours.front;
    context.lineWidth = 5;
    this.line(-75, 0, -25, 0);
    this.line(25, 0, 75, 0);
    this.line(0, -4, 0, 4);
  }

  heading(size, yaw) {
    const { context } = this;
    const text = `${String((Math.round(yaw / DEGREE) + 360) % 360).padStart(3, "0")}°`;
    context.fillStyle = "rgba(0, 0, 0, 0.6)";
    context.fillRect(-34, size / 2 - 50, 68, 28);
    context.fillStyle = "#ffffff";
    context.font = "20px system-ui, sans-serif";
    context.textAlign = "center";
    context.fillText(text, 0, size / 2 - 35);
    context.textAlign = "start";
  }

  line(fromX, fromY, toX, toY) {
    this.context.beginPath();
    this.context.moveTo(fromX, fromY);
    this.context.lineTo(toX, toY);
    this.context.stroke();
  }
}
