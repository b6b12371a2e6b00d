// What is beside and over the 3-D view: layers, colours of the points, place of the camera, and a few words.
import { scaleGradient, sceneColours } from '/colours.js';
import { RESIDUAL_LIMIT_M } from '/point_cloud.js';
import { element, press, setText } from '/dom.js';

const layers = [
  { name: 'points', label: 'Points', colour: scaleGradient('90deg'), title: 'Returns of the sensor' },
  { name: 'truth', label: 'Truth', colour: sceneColours.truth, title: 'Target at the true attitude and range' },
  { name: 'network', label: 'Network', colour: sceneColours.network, title: "Target at the network's attitude, placed at the pose" },
  { name: 'second', label: 'Second hypothesis', colour: sceneColours.second, isOff: true,
    title: 'Target at the second most likely attitude, placed at the pose' },
  { name: 'pose', label: 'Pose', colour: sceneColours.pose, title: 'Target at the registered pose' },
  { name: 'axes', label: 'Axes', colour: null, title: 'Axes x, y, z of the target' },
];

export class ViewControls {
  /** `view`: null where the browser cannot draw in three dimensions. */
  constructor(view) {
    this.view = view;
    this.isByResidual = false;
    this.cloud = view ? view.cloud : null;
    this.legend = document.getElementById('point-legend');
    this.note = document.getElementById('view-note');
    this.figures = document.getElementById('view-figures');
    this.meshNote = '';
    this.k = -1;
    const bar = document.getElementById('layer-bar');
    for (const layer of layers) bar.append(this.makeLayer(layer));
    this.listen();
  }

  makeLayer(layer) {
    const box = element('input', { type: 'checkbox', checked: !layer.isOff });
    box.dataset.testid = `layer-${layer.name}`;
    box.addEventListener('change', () => this.view && this.view.setLayer(layer.name, box.checked));
    const label = element('label', { title: layer.title }, box);
    if (layer.colour) {
      const swatch = element('span', { className: 'swatch' });
      swatch.style.background = layer.colour;
      label.append(swatch);
    }
    label.append(layer.label);
    return label;
  }

  listen() {
    const colouring = document.getElementById('colouring');
    const views = document.getElementById('views');
    press(colouring, 'colouring', 'range');
    press(views, 'view', 'reset');
    if (!this.view) return;
    this.view.onViewChange = (name) => press(views, 'view', name);
    this.view.onStill = () => this.showFigures();
    views.addEventListener('click', (event) => {
      const name = event.target.dataset.view;
      if (name) this.view.setView(name);
    });
    colouring.addEventListener('click', (event) => {
      const name = event.target.dataset.colouring;
      if (name) this.colourBy(name);
    });
  }

  colourBy(name) {
    press(document.getElementById('colouring'), 'colouring', name);
    this.isByResidual = name === 'residual';
    this.view.setColouring(this.isByResidual);
    this.showLegend();
  }

  show(step) {
    this.showNotes(step);
    if (!this.view) return;
    this.showLegend();
    this.k = step.detail ? step.detail.step : step.k;
    this.showFigures();
  }

  showFigures() {
    if (this.k < 0) return;
    const rate = this.view.rate.perSecond;
    const speed = rate > 0 ? `, ${Math.round(rate)} frames/s` : '';
    setText(this.figures, `Step ${this.k}: ${this.cloud.count.toLocaleString('en')} points${speed}`);
  }

  showNotes(step) {
    const notes = [step.notes.frame, step.notes.detail, this.meshNote];
    if (this.isByResidual && !(step.detail && step.detail.pose)) notes.push('no pose to compare the points with');
    setText(this.note, notes.filter(Boolean).map(sentence).join(' '));
  }

  showLegend() {
    const isEmpty = this.cloud.count === 0;
    const key = this.isByResidual ? 'residual' : `${isEmpty} ${this.cloud.nearest} ${this.cloud.farthest}`;
    if (key === this.legendKey) return;
    this.legendKey = key;
    this.legend.replaceChildren(...(this.isByResidual ? residualLegend() : isEmpty ? [] : this.rangeLegend()));
  }

  rangeLegend() {
    const bar = element('span', { className: 'bar' });
    bar.style.background = scaleGradient('90deg');
    return [`Range ${this.cloud.nearest.toFixed(2)} m`, bar, `${this.cloud.farthest.toFixed(2)} m`];
  }
}

function residualLegend() {
  const limit = `${RESIDUAL_LIMIT_M} m`;
  const entries = [[sceneColours.nearer, `${limit} nearer`], [sceneColours.agrees, 'agrees'],
                   [sceneColours.farther, `${limit} farther`], [sceneColours.noSurface, 'no surface there']];
  const parts = [];
  for (const [colour, text] of entries) {
    const swatch = element('span', { className: 'swatch' });
    swatch.style.background = colour;
    parts.push(swatch, text);
  }
  return parts;
}

function sentence(text) {
  const whole = text.trim();
  return whole.charAt(0).toUpperCase() + whole.slice(1) + (/[.!?]$/.test(whole) ? '' : '.');
}
