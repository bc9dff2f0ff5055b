// What the machine draws with, and how many pixels it can draw in time.

/** Renderers without a graphics processor: each pixel costs time of the processor. */
const SOFTWARE = /swiftshader|llvmpipe|softpipe|software|basic render/i;
/** Pixels that such a renderer draws in time. */
const SOFTWARE_PIXELS = 700_000;
const FINEST = 2;
const COARSEST = 0.5;
const STEP = 0.75;
/** Mean wait for a drawing above which drawing is too slow, ms: thirty pictures per second. */
const SLOW_MS = 34;
/** Time over which the mean is taken, and for which it must be well before finer pixels are tried again, ms. */
const WINDOW_MS = 2000;
const PROBATION_MS = 15_000;

/** Whether there is WebGL, and whether it is a program. */
export function graphics() {
  const gl = document.createElement("canvas").getContext("webgl2");
  if (!gl) return { works: false, isSoftware: true };
  const names = gl.getExtension("WEBGL_debug_renderer_info");
  const name = String(gl.getParameter(names ? names.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
  gl.getExtension("WEBGL_lose_context")?.loseContext();
  return { works: true, isSoftware: SOFTWARE.test(name) };
}

/** Chooses device pixels per pixel of the page: as fine as the screen is, unless drawing takes too long. */
export class Fineness {
  constructor(isSoftware) {
    this.isSoftware = isSoftware;
    this.share = 1;
    this.probation = PROBATION_MS;
    this.begin(0);
  }

  begin(now) {
    Object.assign(this, { since: now, waited: 0, count: 0 });
  }

  /** Device pixels per pixel, for a view of a size. */
  ratio(width, height) {
    const finest = Math.min(window.devicePixelRatio, FINEST);
    const affordable = this.isSoftware ? Math.sqrt(SOFTWARE_PIXELS / (width * height)) : FINEST;
    return Math.max(Math.min(finest, affordable) * this.share, Math.min(finest, COARSEST));
  }

  /** Takes in how long a drawing was waited for, ms. Whether the ratio has changed. */
  take(waited, now) {
    // A page in the background draws nothing.
    if (waited > WINDOW_MS) {
      this.begin(now);
      return false;
    }
    this.waited += waited;
    this.count += 1;
    if (now - this.since < WINDOW_MS) return false;
    const mean = this.waited / this.count;
    this.begin(now);
    if (mean > SLOW_MS && this.share > COARSEST * STEP) {
      // What has failed once is tried again later.
      if (this.raised) this.probation *= 2;
      Object.assign(this, { share: this.share * STEP, raised: false, well: now });
      return true;
    }
    if (mean > SLOW_MS) this.well = now;
    if (this.share === 1 || now - (this.well ?? now) < this.probation) return false;
    Object.assign(this, { share: Math.min(1, this.share / STEP), raised: true, well: now });
    return true;
  }
}
