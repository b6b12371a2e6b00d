// The timeline: a slider over all steps with marks of the events, and the buttons that move along it.
import { COMMAND, ERROR, INFO, WARNING } from '/step_store.js';
import { element, figure, setText } from '/dom.js';
import { speeds } from '/playback.js';
import { themeColour } from '/colours.js';

const THUMB_PX = 12;  // as wide as in the style sheet
const LEAST_UPDATE_MS = 250;
const BAND_PX = 4;

// From the least to the most important: the later cover the earlier.
const markKinds = [
  { severity: INFO, colour: 'accent', height: 5 }, { severity: COMMAND, colour: 'second', height: 9 },
  { severity: WARNING, colour: 'warn', height: 12 }, { severity: ERROR, colour: 'alarm', height: 17 },
];

export class Timeline {
  constructor(store, playback) {
    this.store = store;
    this.playback = playback;
    this.timer = 0;
    for (const name of ['slider', 'marks', 'play', 'speed', 'live', 'clock', 'track']) this[name] = document.getElementById(name);
    this.pen = this.marks.getContext('2d');
    for (const speed of speeds)
      this.speed.append(element('option', { value: speed, textContent: speed === Infinity ? 'max' : `${speed}x` }));
    this.explainMarks();
    this.listen();
    new ResizeObserver(() => this.schedule()).observe(this.track);
  }

  listen() {
    const { playback } = this;
    this.slider.addEventListener('input', () => playback.select(Number(this.slider.value)));
    this.play.addEventListener('click', () => playback.toggle());
    this.live.addEventListener('click', () => playback.follow());
    this.speed.addEventListener('change', () => playback.setSpeed(Number(this.speed.value)));
    document.getElementById('step-back').addEventListener('click', () => playback.select(playback.selected - 1));
    document.getElementById('step-forward').addEventListener('click', () => playback.select(playback.selected + 1));
  }

  explainMarks() {
    const legend = document.getElementById('mark-legend');
    legend.append('Marks by height: ');
    for (const [name, severity] of [['error', ERROR], ['warning', WARNING], ['command', COMMAND], ['info', INFO]])
      legend.append(element('span', { className: `severity-${severity}`, textContent: name }), ' ');
    legend.append(' Band: ', element('span', { className: 'mark-verified', textContent: 'verified' }), ' ',
      element('span', { className: 'mark-valid', textContent: 'valid' }));
  }

  show() {
    const { playback } = this;
    this.slider.max = Math.max(0, playback.steps - 1);
    this.slider.value = Math.max(0, playback.selected);
    this.speed.value = playback.speed;
    const isMoving = playback.isPlaying || playback.isFollowing;
    setText(this.play, isMoving ? 'Pause' : 'Play');
    this.showLive();
    this.showClock();
  }

  showLive() {
    const { playback } = this;
    const behind = playback.stepsBehind;
    this.live.disabled = !playback.isBus;
    this.live.setAttribute('aria-pressed', playback.isFollowing);
    if (!playback.isBus) setText(this.live, 'Live: a recording');
    else if (playback.isFollowing) setText(this.live, '● Live');
    else setText(this.live, `Live: ${behind} ${behind === 1 ? 'step' : 'steps'} behind`);
  }

  showClock() {
    const { selected, steps } = this.playback;
    if (steps === 0) {
      setText(this.clock, 'No steps yet');
      return;
    }
    const value = (field, digits) => figure(this.store.value(field, selected), digits);
    setText(this.clock, `${value('t_s', 1)} s   Step ${this.store.ownStep(selected)} of ${this.store.ownStep(steps - 1)}   Sequence ${value('sequence', 0)}, frame ${value('frame', 0)}`);
  }

  /** Draws the marks anew, at most four times a second. */
  schedule() {
    if (this.timer === 0) this.timer = setTimeout(() => this.draw(), LEAST_UPDATE_MS);
  }

  draw() {
    this.timer = 0;
    const ratio = window.devicePixelRatio;
    this.width = this.marks.clientWidth;
    this.height = this.marks.clientHeight;
    this.marks.width = Math.round(this.width * ratio);
    this.marks.height = Math.round(this.height * ratio);
    this.pen.scale(ratio, ratio);
    this.drawBand();
    for (const kind of markKinds) this.drawMarks(kind);
  }

  placeOf(k) {
    return THUMB_PX / 2 + (k / Math.max(1, this.store.steps - 1)) * (this.width - THUMB_PX);
  }

  drawMarks({ severity, colour, height }) {
    this.pen.fillStyle = themeColour(colour);
    const bottom = this.height - BAND_PX - 1;
    let last = -1;
    for (const event of this.store.events) {
      if (event.severity !== severity) continue;
      const x = Math.round(this.placeOf(event.k));
      if (x === last) continue;
      last = x;
      this.pen.fillRect(x - 1, bottom - height, 2, height);
    }
  }

  // A band below the marks: where the pose is verified, and where at least the attitude is valid.
  drawBand() {
    const verified = this.store.column('verified');
    const valid = this.store.column('valid');
    if (!verified || !valid) return;
    const colours = [themeColour('line'), themeColour('warn'), themeColour('ok')];
    let begin = 0;
    const stateOf = (k) => (verified[k] === 1 ? 2 : valid[k] === 1 ? 1 : 0);
    for (let k = 1; k <= this.store.steps; ++k) {
      if (k < this.store.steps && stateOf(k) === stateOf(begin)) continue;
      const state = stateOf(begin);
      const height = state === 2 ? BAND_PX : BAND_PX / 2;
      const left = this.placeOf(begin - 0.5);
      this.pen.fillStyle = colours[state];
      this.pen.fillRect(left, this.height - height, Math.max(1, this.placeOf(k - 0.5) - left), height);
      begin = k;
    }
  }
}
