// Draws when something has changed, and not more often than the eye sees.

/** Least time between two drawings, ms: a little below that of 60 per second, because displays are not exact. */
const LEAST_MS = 15;

export class Redraw {
  /** `draw(now, waited)` gets how long the drawing was waited for, ms, and returns whether it goes on by itself. */
  constructor(draw) {
    this.draw = draw;
    this.asked = null;
    this.drawn = -Infinity;
    this.run = this.run.bind(this);
  }

  /** Something has changed. */
  ask() {
    if (this.asked !== null) return;
    this.asked = performance.now();
    requestAnimationFrame(this.run);
  }

  run() {
    const now = performance.now();
    if (now - this.drawn < LEAST_MS) {
      requestAnimationFrame(this.run);
      return;
    }
    const waited = now - this.asked;
    this.asked = null;
    this.drawn = now;
    if (this.draw(now, waited)) this.ask();
  }
}
