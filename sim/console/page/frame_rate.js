// Frames a second while the view moves, and whether the machine is too slow for fine pixels.
const LONGEST_GAP_MS = 200;  // a longer one is a pause, not a slow frame
const WINDOW_MS = 500;
const SLOW = 30;   // frames a second
const QUICK = 50;  // the gap between the two keeps the picture from changing back and forth

export class FrameRate {
  constructor() {
    this.lastMs = -Infinity;
    this.frames = 0;
    this.elapsedMs = 0;
    this.perSecond = 0;  // of the last movement
    this.isSlow = false;
  }

  count(nowMs) {
    const gap = nowMs - this.lastMs;
    this.lastMs = nowMs;
    if (gap > LONGEST_GAP_MS) {
      this.frames = 0;
      this.elapsedMs = 0;
      return;
    }
    this.frames += 1;
    this.elapsedMs += gap;
    if (this.elapsedMs < WINDOW_MS) return;
    this.perSecond = (1000 * this.frames) / this.elapsedMs;
    this.isSlow = this.perSecond < (this.isSlow ? QUICK : SLOW);
    this.frames = 0;
    this.elapsedMs = 0;
  }
}
