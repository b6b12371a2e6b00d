// The range image of the sensor and the depth image as the network sees it, each with its scale.
import { scaleGradient, scaleTable } from '/colours.js';
import { element, figure, setText } from '/dom.js';

class ScaledImage {
  /** `kind`: {title, unit, digits, scale, none}: a raw value times `scale` is in the unit, `none`: no return. */
  constructor(figureElement, kind) {
    this.kind = kind;
    this.size = 0;
    this.values = null;
    this.caption = element('figcaption', { textContent: kind.title });
    this.canvas = element('canvas', { className: 'image' });
    this.pen = this.canvas.getContext('2d');
    this.high = element('span');
    this.low = element('span');
    this.reading = element('div', { className: 'reading quiet' });
    const scale = element('div', { className: 'scale' });
    scale.style.background = scaleGradient('0deg');
    const limits = element('div', { className: 'limits' }, this.high,
      element('span', { className: 'quiet', textContent: kind.explanation }), this.low);
    figureElement.append(this.caption, this.canvas, scale, limits, this.reading);
    this.canvas.addEventListener('pointermove', (event) => this.read(event));
    this.canvas.addEventListener('pointerleave', () => this.describe());
  }

  show(size, values, note) {
    this.values = values;
    this.note = note;
    if (size !== this.size) this.resize(size);
    if (values) this.paint();
    else this.clear();
    this.describe();
  }

  resize(size) {
    this.size = size;
    this.canvas.width = this.canvas.height = Math.max(1, size);
    this.pixels = this.pen.createImageData(Math.max(1, size), Math.max(1, size));
  }

  clear() {
    this.count = 0;
    this.pen.clearRect(0, 0, this.canvas.width, this.canvas.height);
    setText(this.high, '–');
    setText(this.low, '–');
  }

  paint() {
    const { values, kind } = this;
    let least = Infinity, most = -Infinity;
    this.count = 0;
    for (let i = 0; i < values.length; ++i) {
      const value = values[i];
      if (value === kind.none) continue;
      ++this.count;
      if (value < least) least = value;
      if (value > most) most = value;
    }
    this.fill(least, Math.max(1, most - least));
    this.pen.putImageData(this.pixels, 0, 0);
    setText(this.high, this.count ? this.inUnit(most) : '–');
    setText(this.low, this.count ? this.inUnit(least) : '–');
  }

  fill(least, span) {
    const { values, kind } = this;
    const data = this.pixels.data;
    for (let i = 0; i < values.length; ++i) {
      const value = values[i];
      const isReturn = value !== kind.none;
      const entry = isReturn ? 3 * Math.round((255 * (value - least)) / span) : 0;
      data[4 * i] = scaleTable[entry];
      data[4 * i + 1] = scaleTable[entry + 1];
      data[4 * i + 2] = scaleTable[entry + 2];
      data[4 * i + 3] = isReturn ? 255 : 0;
    }
  }

  inUnit(value) {
    return `${figure(value * this.kind.scale, this.kind.digits)} ${this.kind.unit}`;
  }

  describe() {
    const text = this.values ? `${this.size} × ${this.size}, ${this.count.toLocaleString('en')} returns` : this.note || 'No image';
    setText(this.reading, text);
    this.reading.title = text;
  }

  read(event) {
    if (!this.values) return;
    const box = this.canvas.getBoundingClientRect();
    const column = Math.min(this.size - 1, Math.max(0, Math.floor(((event.clientX - box.left) / box.width) * this.size)));
    const row = Math.min(this.size - 1, Math.max(0, Math.floor(((event.clientY - box.top) / box.height) * this.size)));
    const value = this.values[row * this.size + column];
    setText(this.reading, `Row ${row}, column ${column}: ${value === this.kind.none ? 'no return' : this.inUnit(value)}`);
  }
}

export class DepthView {
  constructor() {
    this.range = new ScaledImage(document.getElementById('range-image'),
      { title: 'Range image of the sensor', explanation: 'range along the ray', unit: 'm', digits: 2, scale: 1 / 128, none: 0 });
    this.depth = new ScaledImage(document.getElementById('depth-image'),
      { title: 'Depth as the network sees it', explanation: 'from the centroid, in target radii', unit: 'radii', digits: 2,
        scale: 1 / 4096, none: -32768 });
  }

  show(step) {
    const { frame, depth, notes } = step;
    this.range.show(frame ? frame.rays : this.range.size, frame ? frame.ranges : null, notes.frame);
    this.depth.show(depth ? depth.size : this.depth.size, depth ? depth.depths : null, notes.depth);
  }
}
