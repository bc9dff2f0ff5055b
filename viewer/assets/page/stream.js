// The connection to the program: frames, scene and news come, orders go.

import { decode } from "./frame.js";

const FIRST_PAUSE_MS = 500;
const LONGEST_PAUSE_MS = 5000;
/** Code with which the program closes: try again later. */
const TOO_MANY = 1013;

/** The token of the address, which goes nowhere but here. */
export function token() {
  return new URLSearchParams(location.hash.slice(1)).get("token");
}

export class Stream {
  /** `on` has functions: frame, scene, news, state, and controls, which gets whether orders are taken; null while nobody knows. */
  constructor(on) {
    this.on = on;
    this.next = 1;
    this.waiting = new Map();
    this.pause = FIRST_PAUSE_MS;
    this.open();
  }

  open() {
    this.on.state("connecting");
    const socket = new WebSocket(`ws://${location.host}/stream`);
    this.socket = socket;
    socket.binaryType = "arraybuffer";
    socket.onopen = () => {
      this.pause = FIRST_PAUSE_MS;
      this.on.state("live");
      // Without a token, too: where many watch, the program waits for this word.
      socket.send(JSON.stringify({ token: token() ?? "" }));
    };
    socket.onmessage = ({ data }) => (typeof data === "string" ? this.read(JSON.parse(data)) : this.on.frame(decode(data)));
    socket.onclose = ({ code }) => {
      this.on.state("lost", code === TOO_MANY ? "too many browsers are watching this flight; trying again" : undefined);
      this.on.controls(null);
      for (const answer of this.waiting.values()) answer("the connection was lost; try again");
      this.waiting.clear();
      setTimeout(() => this.open(), this.pause);
      this.pause = Math.min(2 * this.pause, LONGEST_PAUSE_MS);
    };
  }

  read(message) {
    if ("controls" in message) this.on.controls(message.controls);
    if ("scene" in message) this.on.scene(message.scene);
    if ("news" in message) this.on.news(message.news);
    if ("answer" in message) {
      const answer = this.waiting.get(message.answer);
      this.waiting.delete(message.answer);
      answer?.(message.refused);
    }
  }

  /** Asks a vehicle for something. Resolves with why it is refused, or null. */
  ask(vehicle, action, parameters = {}) {
    if (this.socket.readyState !== WebSocket.OPEN) return Promise.resolve("not connected; wait for the connection, or reload the page");
    if (vehicle === null) return Promise.resolve("there is no vehicle yet");
    const order = this.next;
    this.next += 1;
    this.socket.send(JSON.stringify({ order, vehicle, please: { action, ...parameters } }));
    return new Promise((resolve) => this.waiting.set(order, resolve));
  }
}
