// Plays a recorded flight.

import { readCsv } from "./csv.js";
import { readUlog } from "./ulog.js";

/** Reads a file by its name: .ulg or .csv. Throws with what is wrong. */
export function readRecording(name, buffer) {
  if (/\.ulg$/i.test(name)) return readUlog(buffer);
  if (/\.csv$/i.test(name)) return readCsv(new TextDecoder().decode(buffer));
  throw new Error("Only .ulg and .csv files can be opened.");
}

/** The place of the last of some times that is not after a time. */
function indexAt(times, time) {
  let [low, high] = [0, times.length - 1];
  while (low < high) {
    const middle = Math.ceil((low + high) / 2);
    if (times[middle] <= time) low = middle;
    else high = middle - 1;
  }
  return low;
}

export class Recording {
  constructor(name, { times, states }) {
    if (times.length === 0) throw new Error("The file has no rows. Open a file with a flight in it.");
    Object.assign(this, { name, times, states });
    this.time = times[0];
    this.factor = 1;
    this.paused = false;
    this.moved = null;
  }

  get start() {
    return this.times[0];
  }

  get end() {
    return this.times[this.times.length - 1];
  }

  togglePause() {
    this.paused = !this.paused;
    // From the end it begins again.
    if (!this.paused && this.time >= this.end) this.seek(this.start);
  }

  setSpeed(factor) {
    this.factor = factor > 0 ? factor : 100;
  }

  step(seconds) {
    this.paused = true;
    this.time = Math.min(this.time + seconds, this.end);
  }

  seek(time) {
    this.time = Math.min(Math.max(time, this.start), this.end);
    this.sought = true;
  }

  /** Goes on by the wall clock, ms. */
  advance(now) {
    const elapsed = this.moved === null ? 0 : Math.min(now - this.moved, 250) / 1000;
    this.moved = now;
    if (this.paused) return;
    this.time = Math.min(this.time + elapsed * this.factor, this.end);
    if (this.time >= this.end) this.paused = true;
  }

  /** The vehicles now, in the form of the stream. */
  frame() {
    const index = indexAt(this.times, this.time);
    const vehicles = [...this.states].map(([id, states]) => ({ ...states[index], id }));
    return { time: this.times[index], speed: this.paused ? 0 : this.factor, pace: NaN, vehicles };
  }

  /** Everything up to now, for a history that begins anew: times, and states of each vehicle. */
  *past(id, seconds) {
    const end = indexAt(this.times, this.time);
    const states = this.states.get(id) ?? [];
    for (let index = indexAt(this.times, this.time - seconds); index <= end; index += 1) yield [this.times[index], states[index]];
  }
}
