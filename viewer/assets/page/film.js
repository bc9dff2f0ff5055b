// Records that the program has flown again, in the form of viewer/src/film.rs.

import { decode } from "./frame.js";

const MAGIC = "LMPCFILM";
const HEADER = 12;

function ascii(buffer, count) {
  return String.fromCharCode(...new Uint8Array(buffer, 0, Math.min(count, buffer.byteLength)));
}

/** Whether a file is a film, whatever its name. */
export function isFilm(buffer) {
  return ascii(buffer, MAGIC.length) === MAGIC;
}

/** Has the program that serves the page fly a record again. Resolves with the film; throws with what is wrong. */
export async function replayed(record, token) {
  const answer = await fetch("/film", { method: "POST", headers: { authorization: `Bearer ${token ?? ""}` }, body: record });
  if (!answer.ok) throw new Error(await answer.text());
  return answer.arrayBuffer();
}

/** Times, s, states of all vehicles, and what was said of them. */
export function readFilm(buffer) {
  const length = new DataView(buffer).getUint32(MAGIC.length, true);
  const { scene, news, texts } = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, HEADER, length)));
  const [times, states] = [[], new Map()];
  for (let at = HEADER + length; at < buffer.byteLength;) {
    const frame = decode(buffer, at);
    at = frame.end;
    times.push(frame.time);
    for (const state of frame.vehicles) {
      if (!states.has(state.id)) states.set(state.id, []);
      states.get(state.id).push(state);
    }
  }
  return { times, states, scene, news, texts };
}
