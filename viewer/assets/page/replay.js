// Plays a recorded flight.

import { readCsv } from "./csv.js";
import { isFilm, readFilm } from "./film.js";
import { readUlog } from "./ulog.js";

/** Whether a file is a record, which only the program can fly again. */
export function isRecord(name, buffer) {
  return /\.lmpc$/i.test(name) && !isFilm(buffer);
}

/** Reads a file by its name: .ulg or .csv. A record is read if the program has flown it again. Throws with what is wrong. */
export function readRecording(name, buffer) {
  if (isFilm(buffer)) return readFilm(buffer);
  if (/\.ulg$/i.test(name)) return readUlog(buffer);
  if (/\.csv$/i.test(name)) return readCsv(new TextDecoder().decode(buffer));
  if (isRecord(name, buffer)) throw new Error(`A browser cannot replay a record (.lmpc); run lmpc-sitl --view-record ${name}`);
  throw new Error("Only .ulg, .csv and .lmpc files can be opened.");
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

const EMPTY = { vehicles: [], obstacles: [] };

export class Recording {
  /** `scene` is what stands still; `news` is what is said of vehicles, each from a time on; `texts` are lines for the pilot. */
  constructor(name, { times, states, scene = EMPTY, news = [], texts = [] }) {
    if (times.length === 0) throw new Error("The file has no rows. Open a file with a flight in it.");
    Object.assign(this, { name, times, states, scene, news, texts });
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

  /** Goes on by the wall clock, ms. Whether there is something else to see since the last call. */
  advance(now) {
    const elapsed = this.moved === null ? 0 : Math.min(now - this.moved, 250) / 1000;
    this.moved = now;
    if (!this.paused) {
      this.time = Math.min(this.time + elapsed * this.factor, this.end);
      if (this.time >= this.end) this.paused = true;
    }
    const state = JSON.stringify([this.time, this.paused, this.factor]);
    const differs = state !== this.seen || this.sought;
    this.seen = state;
    return differs;
  }

  /** The vehicles now, in the form of the stream. */
  frame() {
    const index = indexAt(this.times, this.time);
    const vehicles = [...this.states].map(([id, states]) => ({ ...states[index], id }));
    return { time: this.times[index], speed: this.paused ? 0 : this.factor, pace: NaN, vehicles };
  }

  /** What is said of vehicles at a time, s. */
  newsAt(time) {
    const latest = new Map();
    for (const each of this.news) if (each.time_s <= time) latest.set(each.id, each);
    return [...latest.values()];
  }

  /** The lines for the pilot up to now. */
  textsNow() {
    return this.texts.filter(({ time_s: time }) => time <= this.time);
  }

  /** Everything up to now, for a history that begins anew: times, and states of each vehicle. */
  *past(id, seconds) {
    const end = indexAt(this.times, this.time);
    const states = this.states.get(id) ?? [];
    for (let index = indexAt(this.times, this.time - seconds); index <= end; index += 1) yield [this.times[index], states[index]];
  }
}
